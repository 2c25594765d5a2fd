#include "scene/gazebo_scene.h"

#include "model/built_in_models.h"
#include "model/jointed_model.h"
#include "model/sdf_world.h"
#include "scene/bodies.h"
#include "scene/label_rules.h"

#include <spawnfield/error.h>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

void tell_some(const fs::path& file, const Names& names, const std::string& what, Scene& scene)
{
    if (!names.empty())
        scene.notices.push_back(file.string() + ": " + std::to_string(names.size()) + " " + what + ": " +
                                first_of(names, 5));
}

void tell_guessed(const fs::path& file, const ModelPaths& paths, Scene& scene)
{
    Names guessed;
    for (const fs::path& folder : paths.guessed()) guessed.push_back(folder.string());
    tell_some(file, guessed,
              guessed.size() == 1 ? "folder of models was found above the file (--model-path names others)"
                                  : "folders of models were found above the file (--model-path names others)",
              scene);
}

void tell_built_in(const fs::path& file, const ModelPaths& paths, Scene& scene)
{
    for (const std::string& uri : paths.built_in())
        if (built_in_model(uri) == "ground_plane")
            scene.notices.push_back(file.string() + ": " + uri +
                                    " is not on disk; the built-in ground plane stands for it");
}

}  // namespace

Scene read_sdf_scene(const fs::path& file, const SceneOptions& options)
{
    ModelPaths paths(options.model_paths, file);
    SdfWorld world = read_sdf_world(file, paths, options.allow_missing);
    if (world.model_count == 0) {
        std::string list;
        for (const std::string& text : world.missing) list += "\n  " + text;
        throw FileError(
            file.string(),
            list.empty()
                ? "has no models, so nothing to stand on; what is spawned into it at run time has to be in the file"
                : "has no models but those that are missing, so nothing to stand on:" + list);
    }
    Scene scene;
    scene.name = world.name.empty() || world.name == "default" ? file.stem().string() : world.name;
    scene.notices = std::move(world.notices);
    if (!world.missing.empty())  // a model of nothing but missing ones: the list of those says enough
        std::erase_if(scene.notices, [](const std::string& text) {
            return text.find("A model must have at least one link") != std::string::npos;
        });
    append_bodies(scene, file, std::move(world.bodies), paths, options, std::move(world.missing));
    tell_some(file, world.bare_models,
              world.bare_models.size() == 1 ? "model has no collision and is not there for a robot"
                                            : "models have no collision and are not there for a robot",
              scene);
    const auto tell_count = [&](const char* element, std::size_t count, const char* what) {
        if (count > 0) scene.notices.push_back(file.string() + ": <" + element + ">: " + std::to_string(count) + what);
    };
    tell_count("collision", world.hollow, " without a shape left out");
    tell_count("collision", world.untouchable,
               " left out, as by <collide_bitmask> or <collide_without_contact> nothing touches them");
    tell_count("actor", world.actor_count, " left out, as they move");
    tell_count("road", world.road_count, " left out, as they are only seen");
    tell_guessed(file, paths, scene);
    tell_built_in(file, paths, scene);
    return scene;
}

Scene read_urdf_scene(const fs::path& file, const SceneOptions& options)
{
    ModelPaths paths(options.model_paths, file);
    JointedModel model = read_urdf_model(file, {});
    Scene scene;
    scene.name = model.name;
    scene.notices = std::move(model.notices);
    append_bodies(scene, file, std::move(model.bodies), paths, options, {});
    tell_guessed(file, paths, scene);
    return scene;
}

}  // namespace spawnfield

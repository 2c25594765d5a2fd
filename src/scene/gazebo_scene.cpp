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

void add_list_notice(const fs::path& file, const Names& names, const std::string& what, Scene& scene)
{
    if (!names.empty())
        scene.notices.push_back(file.string() + ": " + std::to_string(names.size()) + " " + what + ": " +
                                first_of(names, 5));
}

void add_guessed_notice(const fs::path& file, const ModelPaths& paths, Scene& scene)
{
    Names guessed;
    for (const fs::path& folder : paths.guessed()) guessed.push_back(folder.string());
    add_list_notice(file, guessed,
                    guessed.size() == 1 ? "folder of models was found above the file (add others with --model-path)"
                                        : "folders of models were found above the file (add others with --model-path)",
                    scene);
}

void add_built_in_notices(const fs::path& file, const ModelPaths& paths, Scene& scene)
{
    for (const std::string& uri : paths.built_in())
        if (built_in_model(uri) == "ground_plane")
            scene.notices.push_back(file.string() + ": " + uri +
                                    " is not on disk; the built-in ground plane replaces it");
}

}  // namespace

Scene read_sdf_scene(const fs::path& file, const SceneOptions& options)
{
    ModelPaths paths(options.model_paths, file);
    SdfWorld world = read_sdf_world(file, paths, options.allow_missing);
    if (world.model_count == 0) {
        std::string list;
        for (const std::string& text : world.missing) list += "\n  " + text;
        throw FileError(file.string(),
                        list.empty() ? "has no models, so robots cannot stand anywhere; models that are spawned at run "
                                       "time must be in the file, too"
                                     : "has only models that are missing, so robots cannot stand anywhere:" + list);
    }
    Scene scene;
    scene.name = world.name.empty() || world.name == "default" ? file.stem().string() : world.name;
    scene.notices = std::move(world.notices);
    if (!world.missing.empty())  // a model may be empty because of missing ones; their list is enough
        std::erase_if(scene.notices, [](const std::string& text) {
            return text.find("A model must have at least one link") != std::string::npos;
        });
    append_bodies(scene, file, std::move(world.bodies), paths, options, std::move(world.missing));
    add_list_notice(file, world.bare_models,
                    world.bare_models.size() == 1 ? "model has no collision, so robots pass through it"
                                                  : "models have no collision, so robots pass through them",
                    scene);
    const auto add_count_notice = [&](const char* element, std::size_t count, const char* what) {
        if (count > 0) scene.notices.push_back(file.string() + ": <" + element + ">: " + std::to_string(count) + what);
    };
    add_count_notice("collision", world.hollow, " ignored, because they have no shape");
    add_count_notice("collision", world.untouchable,
                     " ignored, because nothing touches them (<collide_bitmask> or <collide_without_contact>)");
    add_count_notice("actor", world.actor_count, " ignored, because they move");
    add_count_notice("road", world.road_count, " ignored, because they are only visual");
    add_guessed_notice(file, paths, scene);
    add_built_in_notices(file, paths, scene);
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
    add_guessed_notice(file, paths, scene);
    return scene;
}

}  // namespace spawnfield

#include "scene/bare_scene.h"

#include "base/input_file.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/heightmap.h"
#include "scene/label_rules.h"
#include "scene/nav2_map.h"
#include "scene/octomap_part.h"
#include "scene/pieces.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

bool is_elevation_model(const fs::path& file, const std::string& extension, const SceneOptions& options)
{
    if (!options.heightmap.empty() || extension == ".asc" || extension == ".tif" || extension == ".tiff" ||
        extension == ".png")
        return true;
    if (extension == ".raw" &&
        read_file(file).find('\0') != std::string::npos)  // a text file is a mesh that assimp reads
        throw FileError(
            file.string(),
            "has no header; give its layout with --heightmap 'raw: {type: float32, rows: R, cols: C}, cell: M'");
    return false;
}

Scene read_elevation_model(const fs::path& file, const SceneOptions& options)
{
    if (options.up != 0 || options.scale != 1.0)
        throw ArgumentError("load_scene", "up and scale are for a mesh; " + file.string() +
                                              " is an elevation model, in metres and z up");
    Scene scene;
    scene.name = file.stem().string();
    const Label label = label_by_name(scene.name, options.labels, Label::Terrain);
    const std::uint32_t part = add_part(scene, scene.name, "heightmap", label);
    if (label != Label::Ignore) {
        const Heightmap found = read_heightmap(file, parse_heightmap_options(options.heightmap));
        append_heightmap(scene, part, found, {}, false);
        place_scene(scene, found, {}, file.string());
    }
    note_unused_rules(file, options.labels, {scene.name}, scene);
    return scene;
}

bool is_octomap(const std::string& extension) { return extension == ".bt" || extension == ".ot"; }

Scene read_octomap_scene(const fs::path& file, Scene scene, Label fallback, const SceneOptions& options)
{
    if (options.up != 0 || options.scale != 1.0)
        throw ArgumentError("load_scene",
                            "up and scale are for a mesh; " + file.string() + " is an OctoMap, in metres and z up");
    const Label label = label_by_name(scene.name, options.labels, fallback);
    const std::uint32_t part = add_part(scene, scene.name, "octomap", label);
    const bool has_rule = std::any_of(options.labels.begin(), options.labels.end(),
                                      [&](const LabelRule& rule) { return matches(rule.pattern, scene.name); });
    if (label != Label::Ignore)
        append_octomap(scene, part, file, {}, options.unknown.value_or(Unknown::Free),
                       has_rule ? std::nullopt : options.auto_slope);
    note_unused_rules(file, options.labels, {scene.name}, scene);
    return scene;
}

Scene read_mesh_scene(const fs::path& file, Scene scene, Label fallback, const SceneOptions& options)
{
    MeshOptions mesh;
    mesh.scale = Vec3::Constant(options.scale);
    mesh.up = options.up;
    mesh.rules = face_rules(options.labels);
    mesh.auto_slope = options.auto_slope;
    const std::uint32_t part = add_part(scene, scene.name, "mesh", fallback);
    note_unused_rules(file, options.labels,
                      names_of(append_mesh(scene, part, read_mesh(file, mesh_formats(options.any_mesh)), mesh)), scene);
    return scene;
}

}  // namespace

Scene read_nav2_scene(const fs::path& file, const SceneOptions& options)
{
    if (options.up != 0 || options.scale != 1.0 || !options.heightmap.empty())
        throw ArgumentError("load_scene", "up and scale are for a mesh, --heightmap for an elevation model; " +
                                              file.string() + " is a 2D map");
    if (options.auto_slope)
        throw ArgumentError("load_scene", "auto_slope is for meshes, OctoMaps and worlds; " + file.string() +
                                              " is a 2D map, whose floor is terrain and whose walls are obstacles");
    if (!(options.wall_height >= 0) || !std::isfinite(options.wall_height))
        throw ArgumentError("load_scene", "wall_height", options.wall_height, "> 0 m");
    constexpr double default_height = 2;
    const Nav2Map map = read_nav2_map(file);
    if (std::find(map.cells.begin(), map.cells.end(), Nav2Map::Cell::Free) == map.cells.end())
        throw FileError(file.string(), "has no free cell (" + std::to_string(map.cols) + " x " +
                                           std::to_string(map.rows) + "); are negate and the thresholds right?");
    Scene scene;
    scene.name = file.stem().string();
    scene.notices = map.notices;
    if (options.wall_height == 0)
        scene.notices.push_back(file.string() + ": walls are " + number(default_height) +
                                " m high (--wall-height sets it)");
    append_nav2_map(scene, map, label_by_name("floor", options.labels, Label::Terrain),
                    label_by_name("walls", options.labels, Label::Obstacle),
                    options.wall_height > 0 ? options.wall_height : default_height);
    note_unused_rules(file, options.labels, {"floor", "walls"}, scene);
    return scene;
}

Scene read_bare_scene(const fs::path& file, const SceneOptions& options)
{
    const std::string extension = lower_case(file.extension().string());
    if (is_elevation_model(file, extension, options)) {
        if (options.auto_slope)
            throw ArgumentError("load_scene", "auto_slope is for meshes, OctoMaps and worlds; " + file.string() +
                                                  " is an elevation model: all of it is terrain");
        return read_elevation_model(file, options);
    }
    Scene scene;
    scene.name = file.stem().string();
    const bool is_unlabelled = options.labels.empty() && !options.auto_slope;
    const Label fallback = is_unlabelled ? Label::Terrain : Label::Obstacle;
    scene = is_octomap(extension) ? read_octomap_scene(file, std::move(scene), fallback, options)
                                  : read_mesh_scene(file, std::move(scene), fallback, options);
    scene.is_unlabelled = is_unlabelled;
    if (is_unlabelled)
        scene.notices.insert(scene.notices.begin(),
                             file.string() +
                                 ": no label is given, so everything is terrain, also walls and furniture. " +
                                 labelling_advice(scene));
    return scene;
}

}  // namespace spawnfield

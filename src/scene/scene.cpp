#include "base/foreign_file.h"
#include "base/number.h"
#include "base/text.h"
#include "model/sdf_world.h"
#include "scene/bare_scene.h"
#include "scene/elements.h"
#include "scene/gazebo_scene.h"
#include "scene/nav2_map.h"
#include "scene/plausibility.h"
#include "scene/scene_yaml.h"
#include "scene/stray_parts.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/scene.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {

namespace fs = std::filesystem;

Bounds Scene::bounds() const
{
    Bounds all;
    for (const Vec3& vertex : vertices) all.extend(vertex);
    for (const Primitive& primitive : primitives) {
        const Bounds box = bounds_of(primitive.shape);
        all.extend(box.min);
        all.extend(box.max);
    }
    return all;
}

bool Scene::has_terrain() const
{
    const auto is_terrain = [](const Primitive& primitive) { return primitive.label == Label::Terrain; };
    return std::find(triangle_labels.begin(), triangle_labels.end(), Label::Terrain) != triangle_labels.end() ||
           std::any_of(primitives.begin(), primitives.end(), is_terrain);
}

LabelCounts Scene::count_labels() const
{
    LabelCounts counts{};
    for (const Label label : triangle_labels) ++counts[std::size_t(label)].triangles;
    for (const Primitive& primitive : primitives) ++counts[std::size_t(primitive.label)].primitives;
    return counts;
}

namespace {

/// Limit of coordinates, as large as those of UTM. There, doubles have a resolution of 1e-9 m, which is enough for
/// touch_margin.
constexpr double farthest = 1e7;  // m

/// Returns whether the box lies within the limit. False also for NaN.
bool is_near(const Bounds& box)
{
    return (box.min.array().abs() <= farthest).all() && (box.max.array().abs() <= farthest).all();
}

/// Returns the first notices, which may explain why there is no geometry.
std::string first_reasons(const Scene& scene)
{
    std::string out;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, scene.notices.size()); ++i) out += "; " + scene.notices[i];
    return out;
}

void check_extent(const Scene& scene, const std::string& file)
{
    for (std::uint32_t e = 0; e < element_count(scene); ++e) {
        const Bounds box = element_bounds(scene, e);
        if (is_near(box)) continue;
        throw FileError(file, "part \"" + scene.parts[element_part(scene, e)].name + "\" reaches from " +
                                  to_string(box, 3) + ", needs to lie within " + number(farthest) +
                                  " m of 0, 0, 0; check its units, its position and its scale");
    }
}

/// Adds a notice about parts far away from all others. `strict`: throws FileError.
void check_stray_parts(Scene& scene, const std::string& file, bool strict)
{
    const std::vector<StrayPart> stray = stray_parts(scene);
    if (stray.empty()) return;
    if (strict) throw FileError(file, words_for(stray) + "; --strict does not allow this");
    scene.notices.push_back(file + ": " + words_for(stray));
}

}  // namespace

fs::path scene_file_of(const fs::path& scene) { return model_file_of(scene); }

Scene load_scene(const fs::path& scene_path, const SceneOptions& options)
{
    if (!(options.scale > 0) || !std::isfinite(options.scale))
        throw ArgumentError("load_scene", "scale", options.scale, "> 0 m per unit");
    if (!options.bounds.is_empty() && !is_near(options.bounds))
        throw ArgumentError("load_scene", "bounds are " + to_string(options.bounds, 3) + ", need to lie within " +
                                              number(farthest) + " m of 0, 0, 0");
    if (options.auto_slope && !(*options.auto_slope > 0 && *options.auto_slope < std::numbers::pi / 2))
        throw ArgumentError("load_scene", "auto_slope", *options.auto_slope, "> 0 and < pi/2 rad");
    const fs::path file = scene_file_of(scene_path);
    require_file(file);
    refuse_foreign_scene(file);
    const std::string extension = lower_case(file.extension().string());
    const bool is_yaml = extension == ".yaml" || extension == ".yml", nav2 = is_yaml && is_nav2_map(file),
               yaml = is_yaml && !nav2;
    if (!nav2 && options.wall_height != 0)
        throw ArgumentError("load_scene",
                            "wall_height is for a 2D map; " + file.string() + " is another kind of scene");
    const bool sdf = extension == ".sdf" || extension == ".world", urdf = extension == ".urdf";
    const bool gazebo = sdf || urdf;
    if ((yaml || gazebo) && (options.up != 0 || options.scale != 1.0))
        throw ArgumentError("load_scene", "up and scale are for a bare mesh; " +
                                              (gazebo ? "Gazebo uses a world as it is"
                                                      : "give them in " + file.string() + " (keys up, scale)"));
    if ((yaml || gazebo) && !options.heightmap.empty())
        throw ArgumentError("load_scene",
                            "--heightmap is for an elevation model by itself" +
                                (yaml ? "; give the keys in " + file.string() + " (heightmap)" : std::string()));
    Scene scene = nav2   ? read_nav2_scene(file, options)
                  : yaml ? read_scene_yaml(file, options)
                  : sdf  ? read_sdf_scene(file, options)
                  : urdf ? read_urdf_scene(file, options)
                         : read_bare_scene(file, options);
    const auto is_mesh_part = [](const Part& part) { return part.kind == "mesh"; };
    const auto is_octomap_part = [](const Part& part) { return part.kind == "octomap"; };
    if (options.unknown && std::none_of(scene.parts.begin(), scene.parts.end(), is_octomap_part))
        scene.notices.push_back(file.string() + ": has no OctoMap, so --unknown has no effect");
    if (element_count(scene) == 0)
        throw FileError(file.string(), "has no geometry: all parts are ignored" +
                                           std::string(gazebo ? ", missing or without collision" : "") +
                                           first_reasons(scene));
    check_extent(scene, file.string());
    check_stray_parts(scene, file.string(), options.strict);
    const Remedies remedies = yaml     ? Remedies{"scale of its part:", "up of its part"}
                              : gazebo ? Remedies{"<scale> of its mesh:",
                                                  "Gazebo uses the axes of the mesh file, so the <pose> of its model"}
                                       : Remedies{"--scale", "--up y or z"};
    if (std::none_of(scene.parts.begin(), scene.parts.end(), is_mesh_part))
        return scene;  // the user can scale and rotate only meshes
    for (std::string& doubt : doubts_about(scene, file.string(), remedies)) scene.notices.push_back(std::move(doubt));
    return scene;
}

}  // namespace spawnfield

#include "base/checksum.h"
#include "free_space/changed_bounds.h"
#include "geometry/changed_geometry.h"
#include "geometry/geometry_impl.h"
#include "geometry/part_globs.h"
#include "map/changed_terrain.h"
#include "map/map_change.h"
#include "scene/elements.h"

#include <spawnfield/changes.h>
#include <spawnfield/error.h>
#include <spawnfield/scene_parts.h>

#include <algorithm>
#include <unordered_set>

namespace spawnfield {
namespace {

/// Returns the changed map. `change` describes it in words; all else that its hash depends on is in `content`.
Map changed_map(const Map& map, ChangedGeometry changed, const std::string& change, std::string_view content,
                int threads)
{
    Map out = map;
    out.geometry = changed.geometry;
    out.solid_bounds = changed_bounds(map.solid_bounds, out.geometry, map.bounds, changed.boxes);
    out.folder.clear();
    out.files.reset();
    out.changes.push_back(change);
    out.hash = checksum({map.hash, change, content});
    out.change = std::make_shared<const MapChange>(MapChange{map, std::move(changed.boxes)});
    if (changed.changes_terrain) {
        out.floors.reset();
        out.layers = changed_layers(read_terrain(map), out.geometry, out.change->boxes, out.z_limits, threads);
    }
    return out;
}

}  // namespace

Map without_parts(const Map& map, const std::vector<std::string>& globs, int threads)
{
    std::vector<bool> is_removed(map.geometry.parts().size());
    std::string change = "without";
    for (const std::string& glob : globs) {
        const std::vector<std::size_t> found = parts_that_match(map.geometry, glob);
        if (found.empty()) throw ArgumentError("without_parts", no_part_matches(map.geometry, glob));
        for (const std::size_t part : found) is_removed[part] = true;
        change += " " + glob;
    }
    if (globs.empty()) return map;
    return changed_map(map, changed_geometry(map.geometry, is_removed, {}, threads), change, "", threads);
}

Map with_parts(const Map& map, const Scene& extra, int threads)
{
    std::unordered_set<std::string> names;
    for (std::size_t part = 0; part < map.geometry.parts().size(); ++part)
        if (!map.geometry.is_removed(part)) names.insert(map.geometry.parts()[part].name);
    for (const Part& part : extra.parts)
        if (!names.insert(part.name).second)
            throw ArgumentError("with_parts", "part \"" + part.name +
                                                  "\" exists in the map already; give it another name, or remove the "
                                                  "old one first (--without)");
    ChangedGeometry changed = changed_geometry(map.geometry, std::vector<bool>(map.geometry.parts().size()), extra,
                                               threads);
    const std::string_view content = changed.geometry.impl().forests.back()->tiles.bytes();
    return changed_map(map, std::move(changed), "with " + extra.name + " (" + checksum(content) + ")", content,
                       threads);
}

Scene robot_as_obstacle(const Robot& robot, const Pose& scene_from_robot, const std::string& name)
{
    Scene scene;
    scene.name = name;
    std::unordered_set<std::string> used;
    for (std::size_t p = 0; p < robot.parts.size(); ++p) {
        const RobotPart& part = robot.parts[p];
        const std::string full = name + "::" + (part.name.empty() ? std::to_string(p) : part.name);
        std::string unique = full;
        for (int count = 2; !used.insert(unique).second; ++count) unique = full + " (" + std::to_string(count) + ")";
        if (part.shape.kind != ShapeKind::Hull) {
            add_shape(scene, unique, Label::Obstacle,
                      {part.shape.kind, part.shape.size, scene_from_robot * part.shape.pose});
            continue;
        }
        std::vector<Vec3> vertices;
        for (const Vec3& vertex : part.hull_vertices)
            vertices.push_back(scene_from_robot.rotation * vertex + scene_from_robot.position);
        std::vector<Triangle> faces;
        for (const auto& [a, b, c] : part.hull_faces)
            faces.push_back({std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)});
        add_mesh(scene, unique, Label::Obstacle, vertices, faces);
    }
    return scene;
}

std::vector<std::string> parts_off_map(const Scene& extra, const Map& map)
{
    std::vector<Bounds> boxes(extra.parts.size());
    for (std::uint32_t element = 0; element < element_count(extra); ++element) {
        const Bounds box = element_bounds(extra, element);
        boxes[element_part(extra, element)].extend(box.min);
        boxes[element_part(extra, element)].extend(box.max);
    }
    std::vector<std::string> out;
    for (std::size_t part = 0; part < boxes.size(); ++part)
        if (!boxes[part].is_empty() && !boxes[part].meets(map.bounds, 2)) out.push_back(extra.parts[part].name);
    return out;
}

}  // namespace spawnfield

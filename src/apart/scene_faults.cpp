#include "apart/scene_fields.h"

#include <algorithm>

namespace spawnfield {
namespace {

bool is_inside(const Scene& scene, const Piece& piece)
{
    return piece.part < scene.parts.size() &&
           std::uint64_t(piece.first_triangle) + piece.triangle_count <= scene.triangles.size();
}

template <class Index>
bool are_below(const std::vector<std::array<Index, 3>>& triangles, std::size_t count)
{
    return std::all_of(triangles.begin(), triangles.end(), [&](const std::array<Index, 3>& triangle) {
        return std::all_of(triangle.begin(), triangle.end(), [&](Index corner) { return std::size_t(corner) < count; });
    });
}

bool are_finite(const std::vector<Vec3>& points)
{
    return std::all_of(points.begin(), points.end(), [](const Vec3& point) { return point.allFinite(); });
}

}  // namespace

std::string fault_of(const Scene& scene)
{
    const std::size_t triangles = scene.triangles.size();
    const auto has_part = [&](const auto& element) { return element.part < scene.parts.size(); };
    if (scene.triangle_labels.size() != triangles || scene.triangle_pieces.size() != triangles ||
        scene.triangle_groups.size() > triangles)
        return "arrays of triangles differ in length";
    const auto has_ignored_label = [](const Primitive& primitive) { return primitive.label == Label::Ignore; };
    if (std::find(scene.triangle_labels.begin(), scene.triangle_labels.end(), Label::Ignore) !=
            scene.triangle_labels.end() ||
        std::any_of(scene.primitives.begin(), scene.primitives.end(), has_ignored_label))
        return "an element has the label `ignore`, so it should have been left out";
    if (!are_below(scene.triangles, scene.vertices.size())) return "a triangle has a vertex that does not exist";
    if (!are_finite(scene.vertices)) return "a vertex is not finite";
    if (!std::all_of(scene.pieces.begin(), scene.pieces.end(),
                     [&](const Piece& piece) { return is_inside(scene, piece); }))
        return "a piece has a triangle or a part that does not exist";
    if (std::any_of(scene.triangle_pieces.begin(), scene.triangle_pieces.end(),
                    [&](std::uint32_t piece) { return piece >= scene.pieces.size(); }))
        return "a triangle has a piece that does not exist";
    if (!std::all_of(scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& primitive) {
            return has_part(primitive) && primitive.shape.kind != ShapeKind::Hull && has_extent(primitive.shape);
        }))
        return "a primitive has no extent, or a part that does not exist";
    if (!std::all_of(scene.face_groups.begin(), scene.face_groups.end(), has_part))
        return "a group of faces has a part that does not exist";
    if (std::any_of(scene.triangle_groups.begin(), scene.triangle_groups.end(),
                    [&](std::uint32_t group) { return group > scene.face_groups.size(); }))
        return "a triangle has a group of faces that does not exist";
    return "";
}

std::string fault_of(const Robot& robot)
{
    if (robot.parts.empty()) return "a robot has no part";
    for (const RobotPart& part : robot.parts) {
        const bool is_hull = part.shape.kind == ShapeKind::Hull;
        if (is_hull ? part.hull_vertices.empty() : !has_extent(part.shape)) return "a part of a robot has no extent";
        if (!are_finite(part.hull_vertices) || !are_below(part.hull_faces, part.hull_vertices.size()))
            return "a part of a robot has a vertex that does not exist or is not finite";
    }
    return are_finite(robot.contacts) ? "" : "a contact of a robot is not finite";
}

}  // namespace spawnfield

#include "base/number.h"
#include "base/shape_fault.h"
#include "mesh/point_numbers.h"
#include "scene/mesh.h"
#include "scene/pieces.h"

#include <spawnfield/error.h>
#include <spawnfield/scene_parts.h>

namespace spawnfield {
namespace {

constexpr double farthest_part = 1e7;  // m, as for scenes from files

[[noreturn]] void refuse(const char* function, const std::string& name, const std::string& what)
{
    throw ArgumentError(function, "part \"" + name + "\": " + what);
}

bool is_within_reach(const Vec3& point) { return (point.array().abs() <= farthest_part).all(); }

}  // namespace

void add_mesh(Scene& scene, const std::string& name, Label label, const std::vector<Vec3>& vertices,
              const std::vector<Triangle>& triangles, Solid solid)
{
    FileMesh mesh;
    mesh.materials = {""};
    FileMesh::Node& node = mesh.nodes.emplace_back();
    node.name = name;
    PointNumbers<double> numbers;
    std::vector<std::uint32_t> welded;
    for (const Vec3& vertex : vertices) {
        if (!is_within_reach(vertex))
            refuse("add_mesh", name,
                   "a vertex is (" + number(vertex.x()) + ", " + number(vertex.y()) + ", " + number(vertex.z()) +
                       "), needs coordinates within 1e7 m of 0");
        const auto [index, is_new] = numbers.add(vertex.x(), vertex.y(), vertex.z());
        if (is_new) node.vertices.push_back(vertex);
        welded.push_back(index);
    }
    for (const Triangle& triangle : triangles) {
        Triangle corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            if (triangle[k] >= vertices.size())
                refuse("add_mesh", name,
                       "a triangle has vertex " + std::to_string(triangle[k]) + ", needs less than " +
                           std::to_string(vertices.size()));
            corners[k] = welded[triangle[k]];
        }
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
        node.triangles.push_back(corners);
        node.materials.push_back(0);
    }
    MeshOptions options;
    options.solid = solid;
    append_mesh(scene, add_part(scene, name, "mesh", label), mesh, options);
}

void add_shape(Scene& scene, const std::string& name, Label label, const Shape& shape)
{
    if (shape.kind == ShapeKind::Hull) refuse("add_shape", name, "is a hull, needs another shape or add_mesh");
    if (!has_extent(shape)) refuse("add_shape", name, shape_fault(shape));
    const Bounds bounds = bounds_of(shape);
    if (!is_within_reach(bounds.min) || !is_within_reach(bounds.max))
        refuse("add_shape", name, "reaches from " + to_string(bounds) + ", needs to lie within 1e7 m of 0, 0, 0");
    const std::uint32_t part = add_part(scene, name, to_string(shape.kind), label);
    scene.primitives.push_back({shape, part, label});
    ++scene.parts[part].solid_pieces;
}

}  // namespace spawnfield

#include "scene/shape_slope.h"

#include <cmath>

namespace spawnfield {

std::optional<Label> label_by_slope(const Shape& shape, double max_slope)
{
    constexpr double upright = 1e-6;  // rad; at this angle a top rises by touch_margin over 1 m
    const Mat3& axes = shape.pose.rotation;
    if (shape.kind == ShapeKind::Cylinder)
        return std::abs(axes(2, 2)) > std::cos(max_slope) ? Label::Terrain : Label::Obstacle;
    if (shape.kind != ShapeKind::Box) return Label::Obstacle;
    for (int axis = 0; axis < 3; ++axis)
        if (std::hypot(axes(0, axis), axes(1, axis)) <= upright) return Label::Terrain;
    return {};
}

FileMesh box_mesh(const Vec3& size)
{
    FileMesh mesh;
    mesh.materials.emplace_back();
    FileMesh::Node& node = mesh.nodes.emplace_back();
    node.name = "box";
    for (int corner = 0; corner < 8; ++corner)
        node.vertices.push_back(
            Vec3((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5, (corner & 4) != 0 ? 0.5 : -0.5)
                .cwiseProduct(size));
    // Counterclockwise from outside: -x, +x, -y, +y, -z, +z.
    node.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    node.materials.assign(node.triangles.size(), 0);
    return mesh;
}

}  // namespace spawnfield

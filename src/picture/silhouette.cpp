#include "picture/silhouette.h"

#include "free_space/footprint.h"

#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

constexpr int circle_corners = 64;

/// Adds the corners of a polygon that contains a circle, as seen in the view. `a` and `b` are perpendicular radii of
/// the circle.
void add_circle(const ViewAxes& axes, const Vec3& centre, const Vec3& a, const Vec3& b, Polygon2& out)
{
    const double outer = 1 / std::cos(std::numbers::pi / circle_corners);
    for (int k = 0; k < circle_corners; ++k) {
        const double angle = 2 * std::numbers::pi * k / circle_corners;
        const Vec3 point = centre + outer * (std::cos(angle) * a + std::sin(angle) * b);
        out.emplace_back(axes.u.dot(point), axes.v.dot(point));
    }
}

}  // namespace

Polygon2 silhouette(const RobotPart& part, const ViewAxes& axes)
{
    const Pose& pose = part.shape.pose;
    const Vec3& size = part.shape.size;
    const Vec3 half_axis = size[1] / 2 * pose.rotation.col(2);
    Polygon2 out;
    switch (part.shape.kind) {
    case ShapeKind::Hull:
        for (const Vec3& vertex : part.hull_vertices) out.emplace_back(axes.u.dot(vertex), axes.v.dot(vertex));
        break;
    case ShapeKind::Box:
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 side(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
            const Vec3 point = pose.rotation * size.cwiseProduct(side) + pose.position;
            out.emplace_back(axes.u.dot(point), axes.v.dot(point));
        }
        break;
    case ShapeKind::Sphere: add_circle(axes, pose.position, size[0] * axes.u, size[0] * axes.v, out); break;
    case ShapeKind::Cylinder:
        for (const double end : {-1.0, 1.0})
            add_circle(axes, pose.position + end * half_axis, size[0] * pose.rotation.col(0),
                       size[0] * pose.rotation.col(1), out);
        break;
    case ShapeKind::Capsule:
        for (const double end : {-1.0, 1.0})
            add_circle(axes, pose.position + end * half_axis, size[0] * axes.u, size[0] * axes.v, out);
        break;
    }
    return convex_hull(std::move(out));
}

}  // namespace spawnfield

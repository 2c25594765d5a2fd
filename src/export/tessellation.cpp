#include "export/tessellation.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

void tessellate_box(const Shape& box, const VisitTriangle& visit)
{
    const auto corner = [&](int bits) -> Vec3 {
        const Vec3 sign(bits & 1 ? 0.5 : -0.5, bits & 2 ? 0.5 : -0.5, bits & 4 ? 0.5 : -0.5);
        return box.pose.rotation * box.size.cwiseProduct(sign) + box.pose.position;
    };
    static constexpr int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& face : faces) {
        visit(corner(face[0]), corner(face[1]), corner(face[2]));
        visit(corner(face[0]), corner(face[2]), corner(face[3]));
    }
}

/// Radius and height of a point of an outline, m.
struct OutlinePoint {
    double radius, z;
};

/// Turns an outline about z. It must go from a pole below to a pole above, which have radius 0.
void turn(const std::vector<OutlinePoint>& outline, const Pose& pose, int sides, const VisitTriangle& visit)
{
    const auto point = [&](std::size_t ring, int side) -> Vec3 {
        const double angle = 2 * std::numbers::pi * (side % sides) / sides;
        const auto& [radius, z] = outline[ring];
        return pose.rotation * Vec3(radius * std::cos(angle), radius * std::sin(angle), z) + pose.position;
    };
    for (std::size_t ring = 0; ring + 1 < outline.size(); ++ring)
        for (int side = 0; side < sides; ++side) {
            const Vec3 a = point(ring, side), b = point(ring, side + 1), c = point(ring + 1, side + 1),
                       d = point(ring + 1, side);
            if (outline[ring].radius > 0) visit(a, b, c);
            if (outline[ring + 1].radius > 0) visit(a, c, d);
        }
}

/// Returns the outline of a ball that is cut into two halves, which are `length` apart.
std::vector<OutlinePoint> capsule_outline(double radius, double length, int sides)
{
    const int rings = sides / 2, equator = rings / 2;
    std::vector<OutlinePoint> out{{0, -radius - length / 2}};
    for (int ring = 1; ring < rings; ++ring) {
        const double angle = std::numbers::pi * (ring - equator) / rings;
        const double r = radius * std::cos(angle), z = radius * std::sin(angle);
        if (ring <= equator) out.push_back({r, z - length / 2});
        if (ring > equator || (ring == equator && length > 0)) out.push_back({r, z + length / 2});
    }
    out.push_back({0, radius + length / 2});
    return out;
}

}  // namespace

void tessellate(const Shape& shape, int sides, const VisitTriangle& visit)
{
    const double radius = shape.size.x(), length = shape.size.y();
    switch (shape.kind) {
    case ShapeKind::Box: return tessellate_box(shape, visit);
    case ShapeKind::Sphere: return turn(capsule_outline(radius, 0, sides), shape.pose, sides, visit);
    case ShapeKind::Capsule: return turn(capsule_outline(radius, length, sides), shape.pose, sides, visit);
    case ShapeKind::Cylinder:
        return turn({{0, -length / 2}, {radius, -length / 2}, {radius, length / 2}, {0, length / 2}}, shape.pose, sides,
                    visit);
    case ShapeKind::Hull: break;
    }
}

void tessellate(const RobotPart& part, int sides, const VisitTriangle& visit)
{
    if (part.shape.kind != ShapeKind::Hull) return tessellate(part.shape, sides, visit);
    const auto corner = [&](int index) -> const Vec3& { return part.hull_vertices[std::size_t(index)]; };
    for (const auto& face : part.hull_faces) visit(corner(face[0]), corner(face[1]), corner(face[2]));
}

void tessellate_cone(const Vec3& base, const Vec3& tip, double radius, int sides, const VisitTriangle& visit)
{
    Pose pose;
    pose.position = base;
    pose.rotation.col(2) = (tip - base).normalized();
    pose.rotation.col(0) = pose.rotation.col(2).unitOrthogonal();
    pose.rotation.col(1) = pose.rotation.col(2).cross(pose.rotation.col(0));
    turn({{0, 0}, {radius, 0}, {0, (tip - base).norm()}}, pose, sides, visit);
}

}  // namespace spawnfield

#include <spawnfield/robot.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

struct Volume {
    double size;  ///< m3
    Vec3 centre;
};

/// Returns the volume of a part and its centroid, in the robot's frame.
Volume volume_of(const RobotPart& part)
{
    const Vec3& size = part.shape.size;
    constexpr double pi = std::numbers::pi;
    const double ball = 4 * pi / 3 * std::pow(size[0], 3), tube = pi * size[0] * size[0] * size[1];
    switch (part.shape.kind) {
    case ShapeKind::Box: return {size.prod(), part.shape.pose.position};
    case ShapeKind::Sphere: return {ball, part.shape.pose.position};
    case ShapeKind::Cylinder: return {tube, part.shape.pose.position};
    case ShapeKind::Capsule: return {tube + ball, part.shape.pose.position};
    case ShapeKind::Hull: break;
    }
    Volume out{0, Vec3::Zero()};
    const Vec3 middle = part.centre();
    for (const auto& face : part.hull_faces) {  // tetrahedra from a point inside to each face
        const auto corner = [&](std::size_t k) -> Vec3 { return part.hull_vertices[std::size_t(face[k])] - middle; };
        const double volume = corner(0).dot(corner(1).cross(corner(2))) / 6;
        out.size += volume;
        out.centre += volume * (corner(0) + corner(1) + corner(2)) / 4;
    }
    out.centre = out.centre / out.size + middle;
    return out;
}

}  // namespace

Vec3 mass_center_of(const Robot& robot)
{
    if (robot.mass_center) return *robot.mass_center;
    double volume = 0;
    Vec3 sum = Vec3::Zero();
    for (const RobotPart& part : robot.parts) {
        const Volume of_part = volume_of(part);
        volume += of_part.size;
        sum += of_part.size * of_part.centre;
    }
    return sum / volume;
}

}  // namespace spawnfield

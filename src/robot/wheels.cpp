#include "robot/wheels.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Returns whether a body that turns about an axis rolls on the ground: a sphere, or a cylinder about its own axis.
bool is_wheel(const CollisionBody& body, const Vec3& axis)
{
    constexpr double parallel = 0.99;  // cosine of the largest angle: files have rounded numbers
    constexpr double level = 0.2;      // sine of the largest camber
    const double length = axis.norm();
    if (!(std::abs(axis.z()) <= level * length)) return false;  // a sensor that turns about a vertical axis
    if (body.geometry.kind == CollisionGeometry::Kind::Sphere) return true;
    return body.geometry.kind == CollisionGeometry::Kind::Cylinder &&
           std::abs(body.pose.rotation.col(2).dot(axis)) >= parallel * length;
}

}  // namespace

std::optional<double> wheel_radius_of(const JointedModel& model)
{
    std::optional<double> out;
    for (const CollisionBody& body : model.bodies) {
        const auto axle = model.axles.find(body.names[1]);
        if (axle == model.axles.end() || !is_wheel(body, axle->second)) continue;
        const double radius = body.geometry.size[0];
        out = std::min(out.value_or(radius), radius);
    }
    return out;
}

}  // namespace spawnfield

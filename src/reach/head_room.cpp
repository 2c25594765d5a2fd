#include "reach/head_room.h"

#include "settle/convex.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

/// A ball around a point of the robot's z axis.
struct Ball {
    double centre = 0, radius = 0;  ///< m; z of the centre in the robot's frame

    /// Returns how much of a line through the origin lies in the ball, if it is at most this angle from the z axis, m.
    double chord(double max_tilt) const
    {
        const double distance = centre * std::sin(max_tilt), squared = radius * radius - distance * distance;
        return squared > 0 ? 2 * std::sqrt(squared) : 0;
    }
};

/// Returns the distance of a point of the z axis from the surface of a part around it, m; negative outside.
double depth_in(const Shape& shape, double z)
{
    const Vec3 local = shape.pose.rotation.transpose() * (Vec3(0, 0, z) - shape.pose.position), size = shape.size;
    const double aside = local.head<2>().norm();
    switch (shape.kind) {
    case ShapeKind::Box: return (size / 2 - local.cwiseAbs()).minCoeff();
    case ShapeKind::Sphere: return size.x() - local.norm();
    case ShapeKind::Cylinder: return std::min(size.x() - aside, size.y() / 2 - std::abs(local.z()));
    case ShapeKind::Capsule: {
        const double beyond = std::max(0.0, std::abs(local.z()) - size.y() / 2);
        return size.x() - std::hypot(aside, beyond);
    }
    case ShapeKind::Hull: break;
    }
    return -1;
}

double depth_in(const RobotPart& part, const Convex& body, double z)
{
    if (part.shape.kind != ShapeKind::Hull) return depth_in(part.shape, z);
    double out = body.planes.empty() ? -1 : std::numeric_limits<double>::infinity();
    for (const Convex::Plane& plane : body.planes) out = std::min(out, plane.offset - plane.normal.z() * z);
    return out;
}

/// Returns whether a part has no point below the ball on any line through the origin at most an angle from the z axis.
bool is_not_below(const Bounds& part, const Ball& ball, double max_tilt)
{
    const double lowest = std::max(0.0, ball.centre - ball.chord(max_tilt) / 2);
    if (part.min.z() >= lowest) return true;
    const double aside = part.min.cwiseMax(-part.max).cwiseMax(0).head<2>().norm();  // of its nearest point
    return aside > std::max(std::abs(part.min.z()), std::abs(part.max.z())) * std::tan(max_tilt);
}

}  // namespace

double least_head_room(const Robot& robot, double max_tilt)
{
    constexpr int heights = 32;  // at which the centre of the ball may be
    double out = 0;
    for (std::size_t p = 0; p < robot.parts.size(); ++p) {
        const RobotPart& part = robot.parts[p];
        const Convex body = convex_of(part);
        const Bounds box = body.bounds();
        for (int k = 1; k < heights; ++k) {
            Ball ball{.centre = box.min.z() + (box.max.z() - box.min.z()) * k / heights};
            ball.radius = depth_in(part, body, ball.centre);
            if (!(ball.radius > 0) || !(ball.centre >= 0) || !(ball.chord(max_tilt) > out)) continue;
            bool is_lowest = true;
            for (std::size_t q = 0; q < robot.parts.size() && is_lowest; ++q)
                is_lowest = q == p || is_not_below(convex_of(robot.parts[q]).bounds(), ball, max_tilt);
            if (is_lowest) out = ball.chord(max_tilt);
        }
    }
    return out;
}

}  // namespace spawnfield

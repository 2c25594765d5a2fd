#include "base/number.h"
#include "base/shape_fault.h"
#include "robot/hull.h"

#include <spawnfield/error.h>
#include <spawnfield/robot_parts.h>

#include <algorithm>
#include <stdexcept>

namespace spawnfield {

RobotPart shape_part(const Shape& shape, const std::string& name)
{
    if (shape.kind == ShapeKind::Hull) throw ArgumentError("shape_part", "shape is a hull; use hull_part");
    if (!has_extent(shape))
        throw ArgumentError("shape_part",
                            (name.empty() ? "the shape " : "part \"" + name + "\" ") + shape_fault(shape));
    RobotPart part;
    part.shape = shape;
    part.name = name;
    return part;
}

RobotPart hull_part(const std::vector<Vec3>& points, const std::string& name)
{
    if (!std::all_of(points.begin(), points.end(), [](const Vec3& point) { return point.allFinite(); }))
        throw ArgumentError("hull_part", "a coordinate of the points is not finite");
    try {
        RobotPart part = convex_hull(points);
        part.name = name;
        return part;
    } catch (const std::domain_error& error) {
        throw ArgumentError("hull_part", std::string("the hull of the points has no volume: ") + error.what());
    }
}

Robot make_robot(const std::string& name, std::vector<RobotPart> parts, std::vector<Vec3> contacts)
{
    if (parts.empty()) throw ArgumentError("make_robot", "parts is empty, needs at least one");
    Robot robot;
    robot.name = name;
    robot.parts = std::move(parts);
    robot.contacts = std::move(contacts);
    const Bounds box = robot.bounds();
    const double reach = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    if (!(reach <= farthest_robot_point))
        throw ArgumentError("make_robot", "reach from the origin", reach,
                            "at most " + number(farthest_robot_point) + " m");
    return robot;
}

}  // namespace spawnfield

#pragma once

#include <spawnfield/export.h>
#include <spawnfield/robot.h>

/// Robots made in code.
namespace spawnfield {

/// Returns a part of a robot, in the robot's frame; a name is for messages. Throws ArgumentError for a hull and for
/// sizes that are not > 0.
SPAWNFIELD_API RobotPart shape_part(const Shape& shape, const std::string& name = {});

/// Returns the convex hull of points in the robot's frame, m. Throws ArgumentError for points that are not finite or
/// span no volume.
SPAWNFIELD_API RobotPart hull_part(const std::vector<Vec3>& points, const std::string& name = {});

/// Returns a robot of these parts, which touches the ground at `contacts` (robot frame; none: see
/// JudgeOptions::max_slope). Throws ArgumentError without a part, and for a robot that reaches more than 1000 m from
/// its origin.
SPAWNFIELD_API Robot make_robot(const std::string& name, std::vector<RobotPart> parts, std::vector<Vec3> contacts = {});

}  // namespace spawnfield

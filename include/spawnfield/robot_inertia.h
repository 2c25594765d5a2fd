#pragma once

#include <spawnfield/export.h>
#include <spawnfield/simulators.h>

#include <optional>
#include <span>
#include <string>

namespace spawnfield {

/// The mass and the inertia of a robot as one rigid body.
struct RobotInertia {
    double mass = 0;                 ///< kg, > 0
    Vec3 centre = Vec3::Zero();      ///< of mass, in the robot's frame, m
    Mat3 tensor = Mat3::Identity();  ///< about the centre of mass, in the robot's axes, kg m2
};

/// Returns the sum over all links of a URDF or SDF robot that have an <inertial>, at the positions of its joints.
/// Returns nothing for other robots, for files without a mass, and if no rigid body can have this inertia (two
/// principal moments together are not larger than the third one). Throws what load_robot() throws.
SPAWNFIELD_API std::optional<RobotInertia> robot_inertia(const std::string& robot, const RobotOptions& options = {});

/// Returns the model of mujoco_bodies() with an <inertial> for each robot whose kind has one. `inertias` has an entry
/// for each of `kinds`, or none.
SPAWNFIELD_API std::string mujoco_bodies(std::span<const RobotStart> robots, std::span<const Robot> kinds,
                                         std::span<const std::size_t> kind_of,
                                         std::span<const std::optional<RobotInertia>> inertias);

}  // namespace spawnfield

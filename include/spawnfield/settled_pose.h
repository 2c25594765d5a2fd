#pragma once

#include <spawnfield/collision.h>
#include <spawnfield/column.h>
#include <spawnfield/export.h>

#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace spawnfield {

/// What a robot at rest must comply with (see docs/standing.md).
struct StandLimits {
    double lift = 0.02;  ///< m, >= 0; the robot must be free when it is raised by this. Spawns are raised by it
    double max_slope = std::numbers::pi / 6;  ///< rad, > 0; a robot that tilts more is `steep`
    /// rad, > 0, < pi/2; a robot that tilts more while it settles is `unstable`: it tips over
    double max_tilt = std::numbers::pi / 4;
    /// m, >= 0; a robot with a smaller SettledPose::margin is `unstable`. No value: auto_min_stability(); the options
    /// of a Judge always have a value.
    std::optional<double> min_stability = {};
    /// Coefficient of friction between robot and ground, >= 0. If the robot needs more not to slide, it is `unstable`.
    double friction = 0.8;
    /// m, > 0; if given, the level robot must be able to fall freely from this height above its settled pose.
    std::optional<double> drop = {};
};

/// How robots stand in a query.
enum class Stance : std::uint8_t {
    Level,   ///< upright, at an offset above the ground
    Settled  ///< let down onto the ground, where they come to rest
};

/// A place where a robot at rest touches the ground.
struct RestContact {
    Vec3 point;            ///< m, in the scene's frame
    Vec3 normal;           ///< from the ground to the robot, of length 1
    std::size_t part;      ///< of the robot
    std::uint32_t ground;  ///< part of the scene
    Label label;           ///< of what it touches
};

/// The pose at which a robot comes to rest when it is let down at a place, with its verdict.
struct SettledPose {
    Verdict verdict = Verdict::Outside;
    std::optional<Ground> ground;     ///< the layer on which it was let down, or what is there instead
    std::optional<CollisionHit> hit;  ///< Collision, OffTerrain, Obstructed: what it meets, if it is known
    /// Whether the robot was let down, so that all that follows is known. Otherwise, it has no room, or the place
    /// itself cannot be used, and `position` is the place that was given.
    bool has_pose = false;
    Vec3 position = Vec3::Zero();         ///< of its origin, m. If it falls, where it would have to balance
    double roll = 0, pitch = 0, yaw = 0;  ///< rad, as in URDF's rpy
    double tilt = 0;                      ///< angle between the robot's z axis and the vertical, rad
    /// Distance of the projected centre of mass from the nearest edge of the support polygon, m; negative: outside.
    double margin = 0;
    /// Smallest turn about an edge of its support polygon with which the robot tips over, rad; negative: it falls.
    double tip_over = 0;
    /// Smallest vertical distance of the ground from the parts of the robot that do not touch it, m; 0 if all do.
    double belly = 0;
    /// How far it can be raised straight up until it meets something, m. Lengths above StandLimits::lift and drop may
    /// be too large, or infinite.
    double headroom = std::numeric_limits<double>::infinity();
    /// Only with StandLimits::drop: height above its rest from which the level robot falls onto it, m; as headroom.
    double free_fall = std::numeric_limits<double>::infinity();
    bool falls = false;                 ///< Unstable: it falls, at whatever tilt
    bool off_rules = false;             ///< Unreachable: it only does not comply with PlaceRules
    bool slides = false;                ///< Unstable: it needs more friction than StandLimits::friction
    std::vector<RestContact> contacts;  ///< the corners of the support polygon are among them
    bool exact_check = false;           ///< whether an exact collision check was made

    /// Returns the pose raised by `lift`, in which the robot touches nothing.
    Pose lifted(double lift) const { return {position + lift * Vec3::UnitZ(), rotation_from_rpy(roll, pitch, yaw)}; }
};

}  // namespace spawnfield

#pragma once

#include <spawnfield/export.h>
#include <spawnfield/types.h>

#include <Eigen/Geometry>

#include <vector>

/// Converts poses to the frames of simulators. One table, which rule_of() returns, has all these conversions.
namespace spawnfield {

/// Rotations about the fixed axes x, y, z, as in ROS, URDF and SDF: R = Rz(yaw) Ry(pitch) Rx(roll). rad.
struct Rpy {
    double roll = 0, pitch = 0, yaw = 0;
};

SPAWNFIELD_API Mat3 rotation_from(const Rpy& rpy);

/// Returns angles with pitch in [-pi/2, pi/2] and the others in [-pi, pi]. rotation_from() gives the same rotation for
/// them, to 1e-15. This also holds if the nose points straight up or down. There yaw and roll turn about the same line:
/// yaw is then arbitrary (it comes from rounding), and roll completes the rotation.
SPAWNFIELD_API Rpy rpy_from(const Mat3& rotation);

/// Returns the quaternion with w >= 0 of the two that describe the rotation. It is computed from the half angles.
SPAWNFIELD_API Eigen::Quaterniond quaternion_from(const Rpy& rpy);

/// The frames in which files are written. Each is described by the directions of its axes for a robot at yaw 0.
enum class Frame {
    Ros,     ///< REP-103, our own frame: right-handed, x forward, y left, z up. ROS, Gazebo (SDF), MuJoCo, Isaac Lab
    Carla,   ///< left-handed, x forward, y right, z up, m
    Unreal,  ///< the axes of Carla, but in centimetres
    /// Left-handed, x right, y up, z forward, m. Unity's ROS-TCP-Connector and URDF-Importer convert ROS's frame in
    /// this way.
    Unity,
    /// The same for a robot. But the world was written by one of Unity's glTF, FBX or OBJ exporters (they negate x),
    /// and it was baked with y up.
    UnityGltf,
    Gltf,  ///< right-handed, x forward, y up, z right, m: for a scene that is written to a glTF file
};

struct FrameRule {
    Frame frame;
    /// Target from REP-103 for points of the world, before scaling by the unit. Orthogonal; the determinant is -1 for
    /// left-handed frames.
    Mat3 world_axes;
    Mat3 body_axes;  ///< target from REP-103 for points of the robot's body
    double unit;     ///< number of the target's units of length in one metre
};

SPAWNFIELD_API const FrameRule& rule_of(Frame frame);

/// Returns the position of a point of the world in the target's frame and unit.
SPAWNFIELD_API Vec3 point_in(Frame frame, const Vec3& point);

/// Returns the robot's rotation in the target's frame. For a vector v of the body, both rotations give the same
/// direction in the world: world_axes (R v) = rotation_in(R) (body_axes v). The determinant is always 1.
SPAWNFIELD_API Mat3 rotation_in(Frame frame, const Mat3& rotation);

/// Returns the quaternion with w >= 0 of the two that describe the rotation in the target's frame.
SPAWNFIELD_API Eigen::Quaterniond quaternion_in(Frame frame, const Rpy& rpy);

/// The inverse functions of point_in() and rotation_in().
SPAWNFIELD_API Vec3 point_from(Frame frame, const Vec3& point);
SPAWNFIELD_API Mat3 rotation_out_of(Frame frame, const Mat3& rotation);

/// Angles of Unreal and CARLA, in degrees: yaw turns x towards y (clockwise seen from above), pitch raises the nose,
/// and roll lowers the right side. Roll has the same sign as ours; pitch and yaw have the opposite sign.
struct Rotator {
    double roll = 0, pitch = 0, yaw = 0;
};

SPAWNFIELD_API Rotator rotator_from(const Rpy& rpy);
SPAWNFIELD_API Rpy rpy_from(const Rotator& rotator);

}  // namespace spawnfield

#pragma once

#include <spawnfield/export.h>
#include <spawnfield/types.h>

#include <Eigen/Geometry>

#include <vector>

/// How poses look in the frames of simulators: the one table of conversions.
namespace spawnfield {

/// Fixed axes x, y, z: R = Rz(yaw) Ry(pitch) Rx(roll), as ROS, URDF and SDF have it. rad.
struct Rpy {
    double roll = 0, pitch = 0, yaw = 0;
};

SPAWNFIELD_API Mat3 rotation_from(const Rpy& rpy);

/// Pitch is in [-pi/2, pi/2], the others in [-pi, pi]. rotation_from() of it gives the rotation back to 1e-15, with the
/// nose straight up or down too, where yaw and roll turn about the same line: yaw is what rounding leaves of it, roll
/// the rest.
SPAWNFIELD_API Rpy rpy_from(const Mat3& rotation);

/// Of the two quaternions of a rotation the one with w >= 0; exact sines and cosines of the half angles.
SPAWNFIELD_API Eigen::Quaterniond quaternion_from(const Rpy& rpy);

/// The frames that files are written in. Each is described by where its axes point for a robot that stands at yaw 0.
enum class Frame {
    Ros,        ///< REP-103, as inside: right-handed, x forward, y left, z up. ROS, Gazebo (SDF), MuJoCo, Isaac Lab
    Carla,      ///< left-handed, x forward, y right, z up, m
    Unreal,     ///< as Carla, but in centimetres
    Unity,      ///< left-handed, x right, y up, z forward, m: as Unity's ROS-TCP-Connector and URDF-Importer turn ROS's
                ///< frame
    UnityGltf,  ///< the same for a robot, but the world is one that Unity's glTF, FBX or OBJ exporters wrote (x
                ///< negated) and that was baked as y up
    Gltf,       ///< right-handed, x forward, y up, z right, m: for a scene that is written into a glTF file
};

struct FrameRule {
    Frame frame;
    Mat3 world_axes;  ///< target from REP-103 for points of the world, before the unit; orthogonal, of determinant -1
                      ///< where left-handed
    Mat3 body_axes;   ///< target from REP-103 for points of the robot's body
    double unit;      ///< the target's units of length in one metre
};

SPAWNFIELD_API const FrameRule& rule_of(Frame frame);

/// Where the world's point is in the target's frame and unit.
SPAWNFIELD_API Vec3 point_in(Frame frame, const Vec3& point);

/// The robot's rotation in the target: what a body's vector v is turned to, R v, is in both the same arrow of the
/// world: world_axes (R v) = rotation_in(R) (body_axes v). Always proper, of determinant 1.
SPAWNFIELD_API Mat3 rotation_in(Frame frame, const Mat3& rotation);

/// Of the two quaternions of a rotation the one with w >= 0.
SPAWNFIELD_API Eigen::Quaterniond quaternion_in(Frame frame, const Rpy& rpy);

/// Back again.
SPAWNFIELD_API Vec3 point_from(Frame frame, const Vec3& point);
SPAWNFIELD_API Mat3 rotation_out_of(Frame frame, const Mat3& rotation);

/// Unreal's and CARLA's angles, in degrees: yaw turns x towards y (clockwise seen from above), pitch lifts the nose,
/// roll lowers the right side. So roll is ours, pitch and yaw are ours with the sign turned over.
struct Rotator {
    double roll = 0, pitch = 0, yaw = 0;
};

SPAWNFIELD_API Rotator rotator_from(const Rpy& rpy);
SPAWNFIELD_API Rpy rpy_from(const Rotator& rotator);

}  // namespace spawnfield

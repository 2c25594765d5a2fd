#include "base/rotation.h"

#include <spawnfield/frames.h>

#include <array>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// Returns the matrix whose rows are the target frame's axes x, y and z, in coordinates of our frame (forward, left,
/// up).
Mat3 axes(const Vec3& x, const Vec3& y, const Vec3& z)
{
    Mat3 out;
    out.row(0) = x;
    out.row(1) = y;
    out.row(2) = z;
    return out;
}

std::array<FrameRule, 6> make_rules()
{
    const Vec3 forward = Vec3::UnitX(), left = Vec3::UnitY(), up = Vec3::UnitZ();
    const Mat3 same = Mat3::Identity(), unreal = axes(forward, -left, up), unity = axes(-left, up, forward),
               gltf = axes(forward, up, -left);
    // Unity's exporters write a Unity point (x, y, z) to glTF as (-x, y, z). A bake with y up turns (x, y, z) into (x,
    // -z, y). Both together turn the Unity point (x, y, z) into (-x, -z, y).
    const Mat3 unity_gltf = axes(-forward, up, -left);
    return {{{Frame::Ros, same, same, 1},
             {Frame::Carla, unreal, unreal, 1},
             {Frame::Unreal, unreal, unreal, 100},
             {Frame::Unity, unity, unity, 1},
             {Frame::UnityGltf, unity_gltf, unity, 1},
             {Frame::Gltf, gltf, gltf, 1}}};
}

/// Returns the quaternion or its negative, the one with w >= 0. Its zeros have no sign.
Eigen::Quaterniond with_positive_w(Eigen::Quaterniond q)
{
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    q.coeffs().array() += 0.0;
    return q;
}

}  // namespace

Mat3 rotation_from(const Rpy& rpy) { return rotation_from_rpy(rpy.roll, rpy.pitch, rpy.yaw); }

Rpy rpy_from(const Mat3& rotation)
{
    Rpy rpy;
    rpy.yaw = yaw_of(rotation);
    rpy.pitch = std::atan2(-rotation(2, 0), std::hypot(rotation(0, 0), rotation(1, 0)));
    // Removes the yaw from the rotation; what remains is Ry(pitch) Rx(roll), and its middle row gives the roll. This
    // holds for any yaw, also where the yaw is arbitrary because the nose points straight up or down.
    const double c = std::cos(rpy.yaw), s = std::sin(rpy.yaw);
    rpy.roll = std::atan2(s * rotation(0, 2) - c * rotation(1, 2), c * rotation(1, 1) - s * rotation(0, 1));
    return {rpy.roll + 0.0, rpy.pitch + 0.0, rpy.yaw + 0.0};  // no negative zeros
}

Eigen::Quaterniond quaternion_from(const Rpy& rpy)
{
    const double cr = std::cos(rpy.roll / 2), sr = std::sin(rpy.roll / 2);
    const double cp = std::cos(rpy.pitch / 2), sp = std::sin(rpy.pitch / 2);
    const double cy = std::cos(rpy.yaw / 2), sy = std::sin(rpy.yaw / 2);
    return with_positive_w({cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                            cr * cp * sy - sr * sp * cy});
}

const FrameRule& rule_of(Frame frame)
{
    static const std::array<FrameRule, 6> rules = make_rules();
    return rules[std::size_t(frame)];
}

Vec3 point_in(Frame frame, const Vec3& point)
{
    const FrameRule& rule = rule_of(frame);
    const Vec3 turned = rule.world_axes * point * rule.unit;
    return turned.array() + 0.0;  // no negative zeros
}

Mat3 rotation_in(Frame frame, const Mat3& rotation)
{
    const FrameRule& rule = rule_of(frame);
    return rule.world_axes * rotation * rule.body_axes.transpose();
}

Eigen::Quaterniond quaternion_in(Frame frame, const Rpy& rpy)
{
    const FrameRule& rule = rule_of(frame);
    const Eigen::Quaterniond q = quaternion_from(rpy);
    // In a mirrored frame a rotation has the opposite sense, hence the determinant. `turn` is the difference between
    // the axes of the world and of the robots.
    const Vec3 axis = rule.body_axes.determinant() * (rule.body_axes * q.vec());
    const Mat3 turn = rule.world_axes * rule.body_axes.transpose();
    return with_positive_w(Eigen::Quaterniond(turn) * Eigen::Quaterniond(q.w(), axis.x(), axis.y(), axis.z()));
}

Vec3 point_from(Frame frame, const Vec3& point)
{
    const FrameRule& rule = rule_of(frame);
    return rule.world_axes.transpose() * point / rule.unit;
}

Mat3 rotation_out_of(Frame frame, const Mat3& rotation)
{
    const FrameRule& rule = rule_of(frame);
    return rule.world_axes.transpose() * rotation * rule.body_axes;
}

Rotator rotator_from(const Rpy& rpy)
{
    return {rpy.roll * degrees + 0.0, 0 - rpy.pitch * degrees, 0 - rpy.yaw * degrees};
}

Rpy rpy_from(const Rotator& rotator)
{
    return {rotator.roll / degrees, -rotator.pitch / degrees, -rotator.yaw / degrees};
}

}  // namespace spawnfield

#include "base/rotation.h"
#include "catch.h"
#include "worlds/random.h"

#include <spawnfield/frames.h>
#include <spawnfield/thesis.h>

#include <Eigen/LU>

#include <numbers>

using namespace spawnfield;

namespace {

constexpr double pi = std::numbers::pi;
const std::vector<Frame> all_frames = {Frame::Ros,   Frame::Carla,     Frame::Unreal,
                                       Frame::Unity, Frame::UnityGltf, Frame::Gltf};

Vec3 random_point(Random& random)
{
    return {random.between(-50, 50), random.between(-50, 50), random.between(-50, 50)};
}
Rpy random_rpy(Random& random)
{
    return {random.between(-pi, pi), random.between(-pi / 2, pi / 2), random.between(-pi, pi)};
}

/// Returns the axes forward, right and up of an Unreal rotator: FRotationMatrix, written again from its documentation.
Mat3 unreal_matrix(const Rotator& rotator)
{
    const double d = pi / 180, sp = std::sin(rotator.pitch * d), cp = std::cos(rotator.pitch * d),
                 sy = std::sin(rotator.yaw * d), cy = std::cos(rotator.yaw * d), sr = std::sin(rotator.roll * d),
                 cr = std::cos(rotator.roll * d);
    Mat3 out;
    out.col(0) = Vec3(cp * cy, cp * sy, sp);
    out.col(1) = Vec3(sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, -sr * cp);
    out.col(2) = Vec3(-(cr * sp * cy + sr * sy), cy * sr - cr * sp * sy, cr * cp);
    return out;
}

}  // namespace

TEST_CASE("a rotated arrow is the same arrow in every frame")
{
    Random random{3};
    for (const Frame frame : all_frames) {
        const FrameRule& rule = rule_of(frame);
        CHECK(rule.frame == frame);
        for (const Mat3& axes : {rule.world_axes, rule.body_axes}) {
            CHECK((axes * axes.transpose()).isApprox(Mat3::Identity(), 0));
            CHECK(axes.determinant() == (frame == Frame::Ros || frame == Frame::Gltf ? 1 : -1));
        }
        for (int i = 0; i < 200; ++i) {
            const Rpy rpy = random_rpy(random);
            const Mat3 r = rotation_from(rpy), turned = rotation_in(frame, r);
            const Vec3 v = random_point(random), p = random_point(random);
            CHECK(turned.determinant() == Approx(1).epsilon(1e-12));
            CHECK((turned * (rule.body_axes * v)).isApprox(rule.world_axes * (r * v), 1e-12));
            CHECK(point_in(frame, p + r * v)
                      .isApprox(point_in(frame, p) + rule.unit * (turned * (rule.body_axes * v)), 1e-12));
            CHECK(quaternion_in(frame, rpy).toRotationMatrix().isApprox(turned, 1e-12));
            CHECK(quaternion_in(frame, rpy).w() >= 0);
            CHECK(point_from(frame, point_in(frame, p)).isApprox(p, 1e-12));
            CHECK(rotation_out_of(frame, turned).isApprox(r, 1e-12));
        }
    }
}

TEST_CASE("the axes of each frame point as its makers document")
{
    const Vec3 ahead(10, 0, 0), to_the_left(0, 10, 0), above(0, 0, 10);
    CHECK(point_in(Frame::Ros, {1, 2, 3}) == Vec3(1, 2, 3));
    CHECK(point_in(Frame::Carla, {1, 2, 3}) == Vec3(1, -2, 3));
    CHECK(point_in(Frame::Unreal, {1, 2, 3}) == Vec3(100, -200, 300));
    CHECK(point_in(Frame::Unity, ahead) == Vec3(0, 0, 10));  // Unity: z forward, x right, y up
    CHECK(point_in(Frame::Unity, to_the_left) == Vec3(-10, 0, 0));
    CHECK(point_in(Frame::Unity, above) == Vec3(0, 10, 0));
    CHECK(point_in(Frame::Gltf, {1, 2, 3}) == Vec3(1, 3, -2));        // readers convert this back by (x, -z, y)
    CHECK(std::signbit(point_in(Frame::Unity, ahead).x()) == false);  // no -0

    const Vec3 unity(1, 2, 3), gltf(-unity.x(), unity.y(), unity.z()), baked(gltf.x(), -gltf.z(), gltf.y());
    CHECK(point_in(Frame::UnityGltf, baked) == unity);
}

TEST_CASE("robots keep their direction after a quarter turn to the left")
{
    const Rpy left{0, 0, pi / 2};
    const Eigen::Quaterniond unity = quaternion_in(
        Frame::Unity, left);  // about y; a positive angle turns z towards x there, so the sign changes
    CHECK(unity.vec().isApprox(Vec3(0, -std::sin(pi / 4), 0), 1e-15));
    CHECK((unity * Vec3::UnitZ()).isApprox(-Vec3::UnitX(), 1e-15));
    CHECK(rotator_from(left).yaw == -90);
    // ROS-TCP-Connector: (x, y, z, w) of FLU becomes (y, -z, -x, w).
    const Eigen::Quaterniond ros = quaternion_from({0.3, -0.4, 0.5}),
                             there = quaternion_in(Frame::Unity, {0.3, -0.4, 0.5});
    CHECK(there.coeffs().isApprox(Eigen::Vector4d(ros.y(), -ros.z(), -ros.x(), ros.w()), 1e-15));
    // In a world that Unity exported as glTF, Unity's forward axis z is baked as -y. So a robot that faces -y in
    // spawnfield faces z in Unity.
    CHECK((quaternion_in(Frame::UnityGltf, {0, 0, -pi / 2}) * Vec3::UnitZ()).isApprox(Vec3::UnitZ(), 1e-15));
}

TEST_CASE("Unreal's angles rotate its axes like the original rotation")
{
    Random random{5};
    for (int i = 0; i < 500; ++i) {
        const Rpy rpy = i == 0 ? Rpy{0, pi / 2, 0.3} : random_rpy(random);
        CHECK(unreal_matrix(rotator_from(rpy)).isApprox(rotation_in(Frame::Carla, rotation_from(rpy)), 1e-12));
        CHECK(rotation_from(rpy_from(rotator_from(rpy))).isApprox(rotation_from(rpy), 1e-14));
    }
    const Rotator nose_up = rotator_from({0, -0.5, 0}), right_down = rotator_from({0.5, 0, 0});
    CHECK((rotation_from({0, -0.5, 0}) * Vec3::UnitX()).z() > 0);  // the nose points up,
    CHECK(nose_up.pitch > 0);                                      // which is positive in Unreal
    CHECK((rotation_from({0.5, 0, 0}) * -Vec3::UnitY()).z() < 0);  // the right side points down,
    CHECK(right_down.roll > 0);                                    // which is positive in Unreal
    CHECK_FALSE(std::signbit(rotator_from({}).yaw));
    CHECK_FALSE(std::signbit(rotator_from({}).pitch));
}

TEST_CASE("angles are recovered from a rotation, also with the nose straight up")
{
    Random random{7};
    for (int i = 0; i < 2000; ++i) {
        Rpy rpy = random_rpy(random);
        if (i % 4 == 1) rpy.pitch = (i % 8 == 1 ? 1 : -1) * (pi / 2 - std::pow(10.0, -random.between(4, 18)));
        const Mat3 r = rotation_from(rpy), again = rotation_from(rpy_from(r));
        CHECK((r - again).cwiseAbs().maxCoeff() < 2e-15);
        CHECK((quaternion_from(rpy).toRotationMatrix() - r).cwiseAbs().maxCoeff() < 2e-15);
    }
    const Rpy level = rpy_from(rotation_from({0, 0, 1.25}));
    CHECK((level.roll == 0 && level.pitch == 0 && level.yaw == 1.25));
    CHECK_FALSE((std::signbit(level.roll) || std::signbit(level.pitch)));
    const Eigen::Quaterniond q = quaternion_from({0, 0, 6});
    CHECK(q.w() == -std::cos(3.0));  // of the two quaternions, the one with w >= 0
    CHECK(q.z() == -std::sin(3.0));
}

TEST_CASE("the Unity frame of the thesis is another one, and does not change")
{
    CHECK(unity_from({1, 2, 3}) == Vec3(1, 3, 2));
    CHECK(point_in(Frame::Unity, {1, 2, 3}) == Vec3(-2, 3, 1));
}

TEST_CASE("the z axis is turned to a direction without a rotation about the direction")
{
    for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(0, 0, 2), Vec3(1, 0, 0), Vec3(0.3, -0.4, 0.1), Vec3(0, 1, -7)}) {
        const Mat3 turn = rotation_from_z_to(direction);
        CHECK((turn.col(2) - direction.normalized()).norm() < 1e-13);
        CHECK((turn.transpose() * turn - Mat3::Identity()).norm() < 1e-13);
        const Vec3 axis = Vec3::UnitZ().cross(direction);  // the axis of the smallest rotation does not move
        CHECK((turn * axis - axis).norm() < 1e-13);
    }
    CHECK(rotation_from_z_to({0, 0, -3}) == Mat3(Vec3(1, -1, -1).asDiagonal()));
}

#pragma once

#include "catch.h"
#include "random_scene.h"
#include "settle/settle.h"

#include <spawnfield/column.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

#include <cmath>
#include <numbers>

/// Robots, grounds and checks for tests of how a robot comes to rest.
namespace rest_robots {

using namespace spawnfield;
using State = Rest::State;

constexpr double pi = std::numbers::pi, tolerance = 1e-6;  // m and rad

constexpr double rad(double degrees) { return degrees * pi / 180; }

constexpr double base = 0.512, track = 0.57, wheel = 0.165, wheel_width = 0.114;  // m, of a Husky

/// A box on four wheels, whose axles are parallel to y. The origin is in the middle between the wheels' lowest points.
inline Robot wheeled(double mass_x = 0)
{
    std::vector<RobotPart> parts{shape_part(box_shape({0.99, 0.67, 0.26}, {{0, 0, 0.26}}), "body")};
    for (const double x : {-base / 2, base / 2})
        for (const double y : {-track / 2, track / 2})
            parts.push_back(shape_part(
                cylinder_shape(wheel, wheel_width, {{x, y, wheel}, rotation_of_rpy(pi / 2, 0, 0)}), "wheel"));
    Robot out = make_robot("wheeled", std::move(parts));
    out.mass_center = Vec3(mass_x, 0, 0.24);
    return out;
}

/// A plate on four balls.
inline Robot on_balls(double radius)
{
    std::vector<RobotPart> parts{shape_part(box_shape({0.5, 0.4, 0.02}, {{0, 0, 2 * radius + 0.1}}))};
    for (const double x : {-base / 2, base / 2})
        for (const double y : {-track / 2, track / 2})
            parts.push_back(shape_part(sphere_shape(radius, {x, y, radius})));
    Robot out = make_robot("on_balls", std::move(parts));
    out.mass_center = Vec3(0, 0, 0.24);
    return out;
}

/// A plate on two capsules along x.
inline Robot on_skids()
{
    std::vector<RobotPart> parts{shape_part(box_shape({0.5, 0.4, 0.02}, {{0, 0, 0.3}}))};
    for (const double y : {-track / 2, track / 2})
        parts.push_back(shape_part(capsule_shape(0.05, 0.8, {{0, y, 0.05}, rotation_of_rpy(0, pi / 2, 0)})));
    return make_robot("on_skids", std::move(parts));
}

/// A box that stands on its origin.
inline Robot boxy(const Vec3& size)
{
    return make_robot("boxy", {shape_part(box_shape(size, {{0, 0, size.z() / 2}}))});
}

/// Returns a slope that rises towards +x, through the origin.
inline Scene slope(double angle)
{
    Scene scene;
    const Mat3 turned = rotation_of_rpy(0, -angle, 0);
    add_shape(scene, "slope", Label::Terrain, box_shape({12, 12, 0.5}, {turned * Vec3(0, 0, -0.25), turned}));
    return scene;
}

inline void add_block(Scene& scene, const Vec3& low, const Vec3& high)
{
    add_shape(scene, "block", Label::Terrain, box_shape(high - low, {(low + high) / 2}));
}

/// Lets the robot down onto the highest layer at a place.
inline Rest settled(const Scene& scene, const Robot& robot, double x = 0, double y = 0, double yaw = 0,
                    const Settler::Options& options = {})
{
    const Geometry geometry(scene);
    const Column column = column_at(geometry, x, y);
    REQUIRE(!column.layers.empty());
    return Settler(geometry, robot, options).settle(x, y, yaw, column.layers.front());
}

inline void check_pose(const Rest& rest, double z, double roll, double pitch)
{
    CHECK(rest.state == State::Standing);
    CHECK(std::abs(rest.z - z) <= tolerance);
    CHECK(std::abs(rest.roll - roll) <= tolerance);
    CHECK(std::abs(rest.pitch - pitch) <= tolerance);
}

/// Returns a scene at another place: its shapes and vertices.
inline Scene moved(Scene scene, const Pose& pose)
{
    for (Vec3& vertex : scene.vertices) vertex = pose.rotation * vertex + pose.position;
    for (Primitive& primitive : scene.primitives) primitive.shape.pose = pose * primitive.shape.pose;
    for (Piece& piece : scene.pieces) piece.bottom += pose.position.z();
    return scene;
}

}  // namespace rest_robots

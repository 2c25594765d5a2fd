#include "catch.h"
#include "random_scene.h"
#include "test_map.h"

#include "query/clearance.h"

#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

#include <cmath>

using namespace spawnfield;

// Tests of the horizontal distance of bodies, and of the clearance of robots.

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Convex box(const Vec3& size, const Vec3& at, const Mat3& rotation = Mat3::Identity())
{
    return convex_of(box_shape(size, {at, rotation}));
}

/// Returns the scene with its obstacles alone: collisions do not count water.
Geometry obstacles_of(const Scene& scene)
{
    Scene out = scene;
    for (Label& label : out.triangle_labels)
        if (label != Label::Obstacle) label = Label::Water;
    for (Primitive& primitive : out.primitives)
        if (primitive.label != Label::Obstacle) primitive.label = Label::Water;
    return Geometry(out);
}

}  // namespace

TEST_CASE("the horizontal distance of two bodies is that of closed forms")
{
    const Convex cube = box({1, 1, 1}, {0, 0, 0.5});
    CHECK(horizontal_distance(cube, box({1, 1, 1}, {3, 0.2, 0.8})) == Approx(2).margin(1e-8));
    CHECK(horizontal_distance(cube, box({1, 1, 1}, {4, 5, 0.8})) == Approx(5).margin(1e-8));  // corner to corner
    CHECK(horizontal_distance(cube, box({1, 1, 1}, {3, 0, 1.6})) == infinite);                // higher than the cube
    CHECK(horizontal_distance(cube, box({1, 1, 1}, {3, 0, 1.5})) == Approx(2).margin(1e-8));  // just not
    CHECK(horizontal_distance(cube, box({1, 1, 1}, {0.5, 0.2, 0.8})) == 0);
    CHECK(horizontal_distance(cube, convex_of(sphere_shape(0.5, {3, 0, 0.5}))) == Approx(2).margin(1e-8));
    // A ball that is higher than the cube meets its upper edge with its lower side.
    CHECK(horizontal_distance(cube, convex_of(sphere_shape(0.5, {3, 0, 1.3}))) ==
          Approx(2.5 - std::sqrt(0.25 - 0.09)).margin(1e-7));
    // Balls of other heights: at the shift, their centres are r + r apart.
    for (const double up : {0.0, 0.3, 0.7, 0.95}) {
        CAPTURE(up);
        CHECK(horizontal_distance(convex_of(sphere_shape(0.4, {0.1, 0.2, 0})),
                                  convex_of(sphere_shape(0.6, {0.1 + 3, 0.2 + 4, up}))) ==
              Approx(5 - std::sqrt(1 - up * up)).margin(1e-7));
    }
    // An upright cylinder and a slope of 45 degrees that rises away from it, through z = 0 at x = 2: its lower rim, at
    // z = 0.2, meets the slope at x = 2.2. The same slope the other way round hangs over it: the upper rim meets it.
    const Convex wheel = convex_of(cylinder_shape(0.5, 0.8, {{0, 0, 0.6}, Mat3::Identity()}));
    const Convex slope = convex_of(std::array{Vec3(-8, -40, -10), Vec3(-8, 40, -10), Vec3(22, 0, 20)});
    CHECK(horizontal_distance(wheel, slope) == Approx(2.2 - 0.5).margin(1e-7));
    const Convex overhang = convex_of(std::array{Vec3(16, -40, -10), Vec3(16, 40, -10), Vec3(-14, 0, 20)});
    CHECK(horizontal_distance(wheel, overhang) == Approx(5 - 0.5).margin(1e-7));
}

TEST_CASE("a robot that is shifted by its clearance touches an obstacle, and by less it does not")
{
    std::size_t measured = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        CAPTURE(seed);
        const TestMap map = map_of(random_scene(seed));
        const Robot robot = random_robot(seed);
        const Judge judge(map, robot);
        const ClearanceMeter meter(map.geometry, robot);
        const CollisionChecker checker(obstacles_of(map.scene), robot);
        const SpawnList list = sample(judge, {.count = 12, .random_yaw = true, .seed = seed});
        for (const Spawn& spawn : list.spawns) {
            const Pose pose{spawn.position, rotation_from_rpy(spawn.roll, spawn.pitch, spawn.yaw)};
            const double clearance = meter.clearance_at(pose);
            CAPTURE(clearance);
            const auto is_free = [&](double length, double direction) {
                const Vec3 shift(length * std::cos(direction), length * std::sin(direction), 0);
                return checker.is_free({pose.position + shift, pose.rotation});
            };
            bool is_met = false;
            for (int k = 0; k < 720; ++k) {
                const double direction = heading_of(k, 720);
                is_met |= !is_free(1.01 * clearance + 1e-3, direction);  // the best direction may be between two
                if (k % 20 == 0)
                    for (int part = 0; part < 8; ++part) CHECK(is_free(clearance * part / 8, direction));
                // FCL enlarges the robot by touch_margin, which counts many times over where faces are nearly level.
                CHECK((clearance < 1e-3 || is_free(clearance - 5e-4, direction)));
            }
            CHECK((is_met || clearance == ClearanceMeter::most));
            measured += clearance < ClearanceMeter::most && clearance > 0.01;
        }
    }
    CHECK(measured > 20);
}

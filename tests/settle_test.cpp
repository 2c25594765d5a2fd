#include "catch.h"
#include "random_scene.h"
#include "rest_robots.h"
#include "settle/minimax.h"
#include "settle/settle.h"
#include "settle/touch.h"
#include "shared_scenes.h"
#include "worlds/random.h"

#include <spawnfield/collision.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

using namespace spawnfield;
using namespace rest_robots;

// Tests of how a robot comes to rest on the ground.

namespace {

double highest_of(const std::vector<Touch>& touches)
{
    double out = -std::numeric_limits<double>::infinity();
    for (const Touch& touch : touches) out = std::max(out, touch.height);
    return out;
}

std::vector<Touch> touches_of(const Convex& body, const Convex& ground)
{
    std::vector<Touch> out;
    add_touches(body, ground, out);
    return out;
}

std::vector<Touch> touches_of(const Convex& body, const TouchFace& ground)
{
    PlacedBody placed{.body = body};
    place(placed, body, Mat3::Identity());
    std::vector<Touch> out;
    add_touches(placed, ground, out);
    return out;
}

}  // namespace

TEST_CASE("a robot rests as the closed form says")
{
    const auto scenes = shared_scenes();
    if (!scenes) return;
    const std::filesystem::path folder = scenes->parent_path() / "standing";
    const nlohmann::json cases = nlohmann::json::parse(std::ifstream(folder / "cases.json"));
    REQUIRE(cases.at("cases").size() >= 27);
    for (const nlohmann::json& expected : cases.at("cases")) {
        INFO(expected.at("name").get<std::string>());
        const auto value = [&](const char* key) { return expected.at(key).get<double>(); };
        const Robot robot = load_robot((folder / expected.at("robot").get<std::string>()).string());
        const Scene scene = load_scene(folder / expected.at("scene").get<std::string>());
        const Rest rest = settled(scene, robot, value("x"), value("y"), value("yaw"));
        CHECK(std::abs(rest.z - value("z")) <= tolerance);
        CHECK(std::abs(rest.roll - value("roll")) <= tolerance);
        CHECK(std::abs(rest.pitch - value("pitch")) <= tolerance);
        CHECK((rest.state == State::Standing) == expected.at("stable").get<bool>());
        if (!expected.at("margin").is_null()) CHECK(std::abs(rest.margin - value("margin")) <= tolerance);
    }
}

TEST_CASE("on a slope, every robot is parallel to it")
{
    for (const double angle : {0.0, 3.0, 12.0, 25.0, 40.0})
        for (const double yaw : {0.0, 20.0, 45.0, 90.0, 135.0, 180.0, -110.0}) {
            INFO(angle << " degrees, yaw " << yaw);
            const double a = rad(angle), c = rad(yaw);
            const double roll = std::asin(-std::sin(a) * std::sin(c)), pitch = std::atan(-std::tan(a) * std::cos(c));
            for (const Robot& robot : {wheeled(), on_balls(0.03), boxy({0.9, 0.6, 0.2}), on_skids()}) {
                INFO(robot.name);
                check_pose(settled(slope(a), robot, 0, 0, c), 0, roll, pitch);
                check_pose(settled(slope(a), robot, 1, -0.4, c), std::tan(a), roll, pitch);
            }
        }
}

TEST_CASE("the margin on level ground is the distance of the mass from the side of the support polygon")
{
    for (const double mass_x : {0.0, 0.1, -0.2}) {
        const Rest rest = settled(slope(0), wheeled(mass_x), 0, 0, 0.3);
        CHECK(std::abs(rest.margin - (base / 2 - std::abs(mass_x))) <= tolerance);
        CHECK(rest.tilt() <= tolerance);
    }
    const Rest box = settled(slope(0), boxy({0.9, 0.6, 0.2}));
    CHECK(std::abs(box.margin - 0.3) <= tolerance);
    CHECK(box.contacts.size() == 4);
}

TEST_CASE("wheels and balls over steps, crests and grooves rest as the closed form says")
{
    for (const double height : {0.02, 0.05, 0.1, 0.15}) {
        INFO("step of " << height << " m");
        Scene step;
        add_block(step, {-4, -4, -1}, {0, 4, 0});
        add_block(step, {0, -4, -1}, {4, 4, height});
        // The axles stay parallel to the line between the wheels' lowest points.
        const double pitch = -std::asin(height / base);
        check_pose(settled(step, wheeled()), height / 2 + wheel * (1 - std::cos(pitch)), 0, pitch);
        check_pose(settled(step, on_balls(0.03)), height / 2 + 0.03 * (1 - std::cos(pitch)), 0, pitch);
    }
    for (const double angle : {2.0, 5.0, 10.0, 14.0}) {
        INFO("ridge or groove of " << angle << " degrees");
        const double a = rad(angle), lift = wheel * (1 / std::cos(a) - 1);
        for (const double sign : {-1.0, 1.0}) {
            Scene scene;
            for (const double side : {-1.0, 1.0}) {
                const Mat3 turned = rotation_of_rpy(0, -sign * side * a, 0);
                const Vec3 along = turned * Vec3(side * 2, 0, -0.25);
                add_shape(scene, "side", Label::Terrain, box_shape({4, 8, 0.5}, {along, turned}));
            }
            check_pose(settled(scene, wheeled()), sign * base / 2 * std::tan(a) + lift, 0, 0);
            check_pose(settled(scene, wheeled(), 0, 0, pi), sign * base / 2 * std::tan(a) + lift, 0, 0);
        }
    }
}

TEST_CASE("wheels on a ball touch it with their inner rims")
{
    for (const double radius : {1.0, 2.0, 5.0}) {
        Scene scene;
        add_shape(scene, "ball", Label::Terrain, sphere_shape(radius, {0, 0, -radius}));
        const double inner = (track - wheel_width) / 2,
                     slice = std::sqrt(radius * radius - inner * inner);  // radius of the ball at the inner rim
        const double axle = std::sqrt((wheel + slice) * (wheel + slice) - base * base / 4);
        const Rest rest = settled(scene, wheeled());
        if (radius < 2)
            CHECK(rest.state == State::Standing);  // here the belly may carry it
        else
            check_pose(rest, axle - radius - wheel, 0, 0);
    }
    Scene scene;  // and four balls on a ball
    add_shape(scene, "ball", Label::Terrain, sphere_shape(3, {0, 0, -3}));
    const double aside = std::hypot(base / 2, track / 2);
    check_pose(settled(scene, on_balls(0.1)), std::sqrt(3.1 * 3.1 - aside * aside) - 3.1, 0, 0);
}

TEST_CASE("a robot that finds no hold falls, and one without room is blocked")
{
    Scene pole;
    add_block(pole, {-0.05, -0.05, -3}, {0.05, 0.05, 0});
    add_block(pole, {-6, -6, -4}, {6, 6, -3});
    CHECK(settled(pole, wheeled()).state == State::Standing);  // balances on its belly
    CHECK(settled(pole, wheeled(0.06)).state == State::Falling);
    CHECK(settled(pole, wheeled(0.06)).margin < 0);

    Scene lone_pole;  // with nothing below the robot when it has tipped
    add_block(lone_pole, {-0.05, -0.05, -3}, {0.05, 0.05, 0});
    const Rest tipped = settled(lone_pole, wheeled(0.06));
    CHECK(tipped.state == State::Falling);
    CHECK(std::isfinite(tipped.z));

    Scene low_ceiling = slope(0);
    add_block(low_ceiling, {-6, -6, 0.3}, {6, 6, 0.4});
    const Geometry geometry(low_ceiling);
    const Settler settler(geometry, wheeled(), {.max_height = 0.2});
    CHECK(settler.settle(0, 0, 0, 0).state == State::Blocked);
    CHECK(settler.settle(0, 0, 0, 0.4).state == State::Standing);

    CHECK(settled(slope(rad(44)), boxy({1, 1, 0.1})).state == State::Standing);
    CHECK(settled(slope(rad(46)), boxy({1, 1, 0.1})).state == State::Falling);    // the largest tilt is 45 degrees
    CHECK(settled(slope(rad(35)), boxy({0.2, 0.2, 1})).state == State::Falling);  // its mass is not above its base
}

TEST_CASE("if the mass is exactly above a diagonal, the documented rule decides")
{
    Scene scene;  // a block below the front left wheel
    add_block(scene, {-4, -4, -1}, {4, 4, 0});
    add_block(scene, {0.05, 0.05, 0}, {2, 2, 0.08});
    Robot robot = on_balls(0.01);
    const Rest rest = settled(scene, robot);
    CHECK(rest.state == State::Standing);
    const Rest again = settled(scene, robot);
    CHECK(again.roll == rest.roll);
    CHECK(again.pitch == rest.pitch);
    robot.mass_center = Vec3(-1e-3, 0, 0.24);  // the rule: as if the mass were farther back and to the right
    const Rest back = settled(scene, robot);
    CHECK(std::abs(back.pitch - rest.pitch) <= 1e-5);
    CHECK(std::abs(back.roll - rest.roll) <= 1e-5);
}

TEST_CASE("turning and shifting the scene and the robot together changes only the frame")
{
    int compared = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const Scene scene = random_scene(seed);
        const Robot robot = seed % 2 ? wheeled() : random_robot(seed);
        const double turn = 0.4;
        const Pose shift{{3, -2, 1}, rotation_of_rpy(0, 0, turn)};
        const Geometry geometry(scene), shifted(moved(scene, shift));
        for (const Pose& pose : random_poses(scene, seed, 12)) {
            const double x = pose.position.x(), y = pose.position.y(), yaw = 0.7;
            const Column column = column_at(geometry, x, y);
            if (column.layers.empty()) continue;
            const Rest rest = Settler(geometry, robot, {}).settle(x, y, yaw, column.layers.front());
            const Vec3 place = shift.rotation * Vec3(x, y, column.layers.front()) + shift.position;
            const Rest other = Settler(shifted, robot, {}).settle(place.x(), place.y(), yaw + turn, place.z());
            if (rest.state != State::Standing || rest.margin < 1e-3) continue;
            INFO("seed " << seed << " at " << x << ", " << y);
            ++compared;
            CHECK(other.state == rest.state);
            CHECK(std::abs(other.z - rest.z - 1) <= 1e-9);
            CHECK(std::abs(other.roll - rest.roll) <= 1e-9);
            CHECK(std::abs(other.pitch - rest.pitch) <= 1e-9);
            CHECK(std::abs(other.margin - rest.margin) <= 1e-6);
        }
    }
    CHECK(compared >= 50);
}

TEST_CASE("a robot at rest touches the ground: FCL finds a collision just below it, and none just above it")
{
    int standing = 0;
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
        const Scene scene = random_scene(seed);
        const Robot robot = seed % 3 ? random_robot(seed) : wheeled();
        const Geometry geometry(scene);
        const Settler settler(geometry, robot, {});
        const CollisionChecker checker(geometry, robot);
        for (const Pose& pose : random_poses(scene, seed, 20)) {
            const double x = pose.position.x(), y = pose.position.y(), yaw = pose.position.z();
            for (const double layer : column_at(geometry, x, y).layers) {
                const Rest rest = settler.settle(x, y, yaw, layer);
                if (rest.state != State::Standing) continue;
                INFO("seed " << seed << " at " << x << ", " << y << ", " << yaw << ", layer " << layer);
                ++standing;
                const Mat3 rotation = rotation_from_rpy(rest.roll, rest.pitch, yaw);
                CHECK(!checker.is_free({{x, y, rest.z - 1e-5}, rotation}));
                const auto hit = checker.find_hit({{x, y, rest.z + 1e-5}, rotation});
                if (hit) {  // only inside something that is filled: no surface is near
                    Scene surfaces = scene;
                    for (Piece& piece : surfaces.pieces) piece.solid = false;
                    CHECK(CollisionChecker(Geometry(surfaces), robot).is_free({{x, y, rest.z + 1e-5}, rotation}));
                }
            }
        }
    }
    CHECK(standing >= 200);
}

TEST_CASE("the touches of round bodies and polyhedra agree with a general method")
{
    Random random(7);
    const auto anywhere = [&](double reach) {
        return Vec3(random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach));
    };
    const auto turned = [&] {
        return rotation_of_rpy(random.between(-3, 3), random.between(-1.5, 1.5), random.between(-3, 3));
    };
    int met = 0, triangles = 0;
    for (int k = 0; k < 4000; ++k) {
        const auto some_body = [&](int kind) {
            const Pose pose{anywhere(1), turned()};
            switch (kind) {
            case 0: return convex_of(box_shape({random.between(0.1, 1), random.between(0.1, 1), 0.5}, pose));
            case 1: return convex_of(sphere_shape(random.between(0.1, 0.8), pose.position));
            case 2: return convex_of(cylinder_shape(random.between(0.1, 0.8), random.between(0.1, 1), pose));
            case 3: return convex_of(capsule_shape(random.between(0.1, 0.8), random.between(0.1, 1), pose));
            default: return convex_of(std::array<Vec3, 3>{anywhere(1), anywhere(1), anywhere(1)});
            }
        };
        const int first = k % 4, second = k / 4 % 5;
        const Convex body = some_body(first), ground = some_body(second);
        const auto general = highest_touch(body, ground);
        const double highest = highest_of(touches_of(body, ground));
        INFO("pair " << k << " of kinds " << first << " and " << second);
        if (!general) {
            // Only a touch of a wall is left out by one of them.
            continue;
        }
        ++met;
        // On a steep surface, a small distance to the side is a large one in height.
        CHECK(std::abs(highest - general->height) <= 1e-9 * general->normal.norm());
        if (second != 4) continue;
        const auto triangle = touch_face_of({ground.points[0], ground.points[1], ground.points[2]});
        if (!triangle) continue;
        ++triangles;
        CHECK(std::abs(highest_of(touches_of(body, *triangle)) - general->height) <= 1e-9 * general->normal.norm());
    }
    CHECK(met >= 1000);
    CHECK(triangles >= 200);
}

TEST_CASE("the predicted height of a touch after a small turn is that of the turned body")
{
    Random random(11);
    std::array<int, 4> seen{};
    for (int k = 0; k < 3000; ++k) {
        const auto between = [&](double reach) { return random.between(-reach, reach); };
        const Pose pose{{between(0.3), between(0.3), 0}, rotation_of_rpy(between(0.5), between(0.5), between(3))};
        const Convex own = k % 2 ? convex_of(box_shape({0.8, 0.5, 0.3}, pose))
                                 : convex_of(cylinder_shape(0.4, 0.2, pose));
        const auto triangle = touch_face_of({Vec3(between(1), between(1), 0),
                                             Vec3(between(1), between(1), between(0.4)),
                                             Vec3(between(1), between(1), 0)});
        if (!triangle) continue;
        const Mat3 rotation = rotation_of_rpy(between(1e-4), between(1e-4), 0);
        const std::vector<Touch> before = touches_of(own, *triangle),
                                 after = touches_of(moved(own, {Vec3::Zero(), rotation}), *triangle);
        for (const Touch& touch : before) {
            const auto height = height_after(touch, own, rotation, *triangle);
            CHECK(height.has_value() == (touch.kind != Touch::Kind::Other));
            const auto is_same = [&](const Touch& other) {
                return other.kind == touch.kind && other.body == touch.body && other.ground == touch.ground;
            };
            const auto same = std::find_if(after.begin(), after.end(), is_same);
            if (!height || same == after.end()) continue;  // the features may not meet any more
            ++seen[std::size_t(touch.kind)];
            CHECK(std::abs(*height - same->height) <= 1e-9 * touch.normal.norm());
        }
    }
    for (const int count : seen) CHECK(count >= 100);
}

TEST_CASE("the upper end of a body on a vertical line is as high as its lower end upside down")
{
    Random random(5);
    int met = 0;
    for (int k = 0; k < 1000; ++k) {
        const Pose pose{{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)},
                        rotation_of_rpy(random.between(-3, 3), random.between(-1.5, 1.5), 0)};
        const Convex body = k % 3 == 0   ? convex_of(box_shape({0.8, 0.5, 0.6}, pose))
                            : k % 3 == 1 ? convex_of(cylinder_shape(0.4, 0.7, pose))
                                         : convex_of(capsule_shape(0.3, 0.7, pose));
        const double x = random.between(-1, 1), y = random.between(-1, 1);
        const auto lower = touches_of(upside_down(body), convex_of(Vec3(x, y, 0)));
        const auto upper = upper_end(body, x, y);
        CHECK(upper.has_value() == !lower.empty());
        if (!upper || lower.empty()) continue;
        ++met;
        CHECK(std::abs(*upper - highest_of(lower)) <= 1e-9);
    }
    CHECK(met >= 100);
}

TEST_CASE("a robot comes to rest on flat ground beside walls, edges and other ground as on ground that is nearly flat")
{
    const auto scene_of = [](double tilt) {
        Scene out;
        const auto add = [&](double x0, double y0, double x1, double y1, double z) {
            add_mesh(out, "plate", Label::Terrain, {{x0, y0, z}, {x1, y0, z}, {x1, y1, z + tilt}, {x0, y1, z}},
                     {{0, 1, 2}, {0, 2, 3}}, Solid::No);
        };
        add(-3, -3, 3, 3, 0);         // the floor
        add(-3, -3, -1.5, -1, 0.05);  // a platform, whose edge carries some robots
        add(-3, 1, -1, 3, -0.3);      // ground below it
        add(1, -3, 3, -1, 1.2);       // a ceiling that is high enough, and one that is not
        add(1, 1, 3, 3, 0.52);
        return out;
    };
    const Robot robot = wheeled();
    const Geometry flat(scene_of(0)), nearly(scene_of(1e-11));
    const Settler::Options options{.headroom = 0.3};
    const Settler on_flat(flat, robot, options), on_nearly(nearly, robot, options);
    Random random(2);
    int level = 0, alike = 0;
    for (int k = 0; k < 2000; ++k) {
        const double x = random.between(-3.2, 3.2), y = random.between(-3.2, 3.2), yaw = random.between(-pi, pi);
        for (const double layer : column_at(flat, x, y).layers) {
            const Rest rest = on_flat.settle(x, y, yaw, layer), other = on_nearly.settle(x, y, yaw, layer);
            INFO("at " << x << ", " << y << ", yaw " << yaw << ", layer " << layer);
            if (rest.state != State::Standing || rest.roll != 0 || rest.pitch != 0) continue;
            ++level;
            CHECK(other.state == State::Standing);
            CHECK(std::abs(rest.z - other.z) <= 1e-6);
            CHECK(std::abs(rest.roll - other.roll) <= 1e-6);
            CHECK(std::abs(rest.pitch - other.pitch) <= 1e-6);
            CHECK(std::abs(rest.belly - other.belly) <= 1e-6);
            CHECK((rest.headroom >= 0.3) == (other.headroom >= 0.3));
            // A wheel may also be less than 1 mm above an edge of the nearly flat ground.
            if (rest.contacts.size() != other.contacts.size()) continue;
            ++alike;
            CHECK(std::abs(rest.margin - other.margin) <= 1e-6);
            CHECK(std::abs(rest.tip_over - other.tip_over) <= 1e-5);
        }
    }
    CHECK(level >= 500);
    CHECK(alike >= 300);
}

TEST_CASE("the lowest point of the highest plane is at least as low as any other point")
{
    Random random(3);
    for (int k = 0; k < 500; ++k) {
        std::vector<MinimaxPlane> rows;
        const int count = 1 + k % 40;
        for (int i = 0; i < count; ++i)
            rows.push_back({random.between(-1, 1), {random.between(-1, 1), random.between(-1, 1)}});
        const auto height = [&](const Vec2& at) {
            double out = -std::numeric_limits<double>::infinity();
            for (const MinimaxPlane& row : rows) out = std::max(out, row.height + row.gradient.dot(at));
            return out;
        };
        const Minimax lowest = lowest_of_highest(rows, 2);
        CHECK(lowest.at.lpNorm<Eigen::Infinity>() <= 2 + 1e-12);
        CHECK(std::abs(height(lowest.at) - lowest.value) <= 1e-12);
        for (int i = 0; i < 200; ++i)
            CHECK(height({random.between(-2, 2), random.between(-2, 2)}) >= lowest.value - 1e-12);
    }
}

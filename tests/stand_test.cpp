#include "catch.h"
#include "settle/friction.h"
#include "shared_scenes.h"
#include "test_map.h"

#include <spawnfield/bake.h>
#include <spawnfield/error.h>
#include <spawnfield/headings.h>
#include <spawnfield/poses.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>

using namespace spawnfield;

// Tests of the verdicts on robots that are let down.

namespace {

double rad(double degrees) { return degrees * std::numbers::pi / 180; }

constexpr double half_base = 0.25, half_track = 0.2, clearance = 0.1;  // m

/// A box on four balls, with its origin in the middle of its lowest plane, or `origin` above it. It is 0.3 m high.
Robot on_balls(double origin = 0)
{
    std::vector<RobotPart> parts{shape_part(box_shape({0.7, 0.5, 0.2}, {{0, 0, clearance + 0.1 - origin}}), "body")};
    for (const double x : {-half_base, half_base})
        for (const double y : {-half_track, half_track})
            parts.push_back(shape_part(sphere_shape(0.04, {x, y, 0.04 - origin}), "foot"));
    Robot out = make_robot("on_balls", std::move(parts));
    out.mass_center = Vec3(0, 0, 0.15 - origin);
    return out;
}

Robot boxy(const Vec3& size) { return make_robot("boxy", {shape_part(box_shape(size, {{0, 0, size.z() / 2}}))}); }

void add_block(Scene& scene, const Vec3& low, const Vec3& high, Label label = Label::Terrain,
               const std::string& name = "block")
{
    add_shape(scene, name, label, box_shape(high - low, {(low + high) / 2}));
}

Scene floor_scene()
{
    Scene scene;
    add_block(scene, {-5, -5, -1}, {5, 5, 0}, Label::Terrain, "floor");
    return scene;
}

/// Returns a slope that rises towards +x, through the origin.
Scene slope(double angle)
{
    Scene scene;
    const Mat3 turned = rotation_of_rpy(0, -angle, 0);
    add_shape(scene, "slope", Label::Terrain, box_shape({12, 12, 0.5}, {turned * Vec3(0, 0, -0.25), turned}));
    return scene;
}

struct Settled {
    SettledPose pose;
    std::string reason;
};

/// Lets a robot down at a place; z is where it looks for its ground.
Settled settle(const Scene& scene, const Robot& robot, const Vec3& place = {0, 0, 0.5}, const StandLimits& limits = {},
               const Bounds& bounds = {})
{
    const Judge judge(map_of(scene, 0.1, bounds), robot, {.stand = limits});
    const SettledPose pose = judge.settle(place, 0);
    return {pose, judge.describe(pose)};
}

}  // namespace

TEST_CASE("the robot on a floor is valid, and every quantity is that of the closed form")
{
    const Settled rest = settle(floor_scene(), on_balls(0.05));
    CHECK(rest.pose.verdict == Verdict::Valid);
    CHECK(rest.reason == "valid");
    CHECK(std::abs(rest.pose.position.z() - 0.05) <= 1e-9);
    CHECK(rest.pose.tilt <= 1e-9);
    CHECK(std::abs(rest.pose.margin - half_track) <= 1e-9);
    CHECK(std::abs(rest.pose.tip_over - std::atan2(half_track, 0.15)) <= 1e-9);
    CHECK(std::abs(rest.pose.belly - clearance) <= 1e-9);
    CHECK(rest.pose.contacts.size() == 4);
    for (const RestContact& contact : rest.pose.contacts) {
        CHECK(std::abs(std::abs(contact.point.x()) - half_base) <= 1e-9);
        CHECK(std::abs(std::abs(contact.point.y()) - half_track) <= 1e-9);
        CHECK(std::abs(contact.point.z()) <= 1e-9);
        CHECK(contact.normal.isApprox(Vec3::UnitZ(), 1e-9));
    }
    CHECK(settle(floor_scene(), boxy({1, 1, 1})).pose.belly == 0);
}

TEST_CASE("tilted robots tip over at the angle that is left")
{
    // A box of 0.6 x 0.4 x 0.5 m with its mass in the middle, on a slope along x.
    for (const double angle : {0.0, 10.0, 25.0}) {
        const Settled rest = settle(slope(rad(angle)), boxy({0.6, 0.8, 0.5}), {0, 0, 1});
        INFO(angle << " degrees");
        CHECK(std::abs(rest.pose.tip_over - (std::atan2(0.3, 0.25) - rad(angle))) <= 1e-6);
        CHECK(std::abs(rest.pose.tilt - rad(angle)) <= 1e-6);
    }
}

TEST_CASE("the limits of slope and tilt are inclusive, and a robot beyond the largest tilt tips over")
{
    const Robot low = boxy({1, 1, 0.1});
    CHECK(settle(slope(rad(29)), low).pose.verdict == Verdict::Valid);
    CHECK(settle(slope(rad(30)), low).pose.verdict == Verdict::Valid);
    const Settled steep = settle(slope(rad(31)), low);
    CHECK(steep.pose.verdict == Verdict::Steep);
    CHECK(steep.reason == "steep: it tilts by 31 degrees, the limit is 30 degrees");
    CHECK(settle(slope(rad(31)), low, {0, 0, 0.5}, {.max_slope = rad(35)}).pose.verdict == Verdict::Valid);
    const Settled tipped = settle(slope(rad(46)), low);
    CHECK(tipped.pose.verdict == Verdict::Unstable);
    CHECK_THAT(tipped.reason, Contains("unstable: it tips over: it finds no rest within 45 degrees (--max-tilt)"));
    CHECK(settle(slope(rad(46)), low, {0, 0, 0.5}, {.max_tilt = rad(50)}).pose.verdict == Verdict::Steep);
}

TEST_CASE("a robot that falls has the negative margin and tip-over angle of the pose in which it would balance")
{
    Robot robot = on_balls();
    robot.mass_center = Vec3(half_base + 0.1, 0, 0.15);
    const Settled rest = settle(floor_scene(), robot, {0, 0, 0.5}, {.max_tilt = rad(10)});
    CHECK(rest.pose.verdict == Verdict::Unstable);
    CHECK(rest.pose.falls);
    CHECK(std::abs(rest.pose.margin + 0.1) <= 1e-9);
    CHECK(std::abs(rest.pose.tip_over - std::atan2(-0.1, 0.15)) <= 1e-9);
    CHECK(rest.reason ==
          "unstable: it tips over: it finds no rest within 10 degrees (--max-tilt); where it would have to balance, "
          "its margin is -0.1 m");
}

TEST_CASE("a robot whose mass is too near to the edge of its support is unstable")
{
    Robot robot = on_balls();
    robot.mass_center = Vec3(half_base - 0.001, 0, 0.15);
    CHECK(std::abs(auto_min_stability(robot) - 0.0014) <= 1e-12);  // the robot is 0.7 m long
    const Settled near_edge = settle(floor_scene(), robot);
    CHECK(near_edge.pose.verdict == Verdict::Unstable);
    CHECK(near_edge.reason == "unstable: its margin is 0.001 m, the limit is 0.0014 m");
    CHECK(std::abs(near_edge.pose.margin - 0.001) <= 1e-9);
    const auto with_limit = [&](double limit) {
        return settle(floor_scene(), robot, {0, 0, 0.5}, {.min_stability = limit}).pose.verdict;
    };
    CHECK(with_limit(0.0009) == Verdict::Valid);
    CHECK(with_limit(0) == Verdict::Valid);
    robot.mass_center = Vec3(half_base - 0.005, 0, 0.15);
    CHECK(settle(floor_scene(), robot).pose.verdict == Verdict::Valid);
    CHECK(with_limit(0.0051) == Verdict::Unstable);
}

TEST_CASE("a foot that hangs counts if the robot rocks onto it with little motion")
{
    // Three feet carry the robot, with the mass almost above the line between two of them. The fourth foot hangs.
    const auto over_hole = [](double depth) {
        Scene scene;
        add_block(scene, {-5, -5, -2}, {5, 5, -depth});
        add_block(scene, {-5, -5, -depth}, {0.1, 5, 0});
        add_block(scene, {0.1, -5, -depth}, {5, 0, 0});
        Robot robot = on_balls();
        robot.mass_center = Vec3(-0.002, -0.002, 0.15);
        return settle(scene, robot, {-0.01, -0.01, 0.5}, {.min_stability = 0.01});
    };
    const Settled shallow = over_hole(0.01);
    CHECK(shallow.pose.verdict == Verdict::Valid);
    CHECK(shallow.pose.tilt <= 1e-9);  // the pose is the first one, with the mass above three feet
    CHECK(shallow.pose.margin > 0.15);
    CHECK(shallow.pose.contacts.size() == 4);
    const Settled deep = over_hole(0.2);
    CHECK(deep.pose.verdict == Verdict::Unstable);
    const double to_diagonal = 0.002 * (half_base + half_track) / std::hypot(half_base, half_track);
    CHECK(std::abs(deep.pose.margin - to_diagonal) <= 1e-9);
    CHECK(deep.pose.contacts.size() == 3);
}

/// A box between two wheels with the radius 0.1 m, with a ball as a third foot if its place is given, and with the
/// mass at (mass_x, mass_z) from the middle of the axle.
Robot on_two_wheels(double mass_x, double mass_z, const std::optional<Vec3>& ball = {})
{
    std::vector<RobotPart> parts{shape_part(box_shape({0.2, 0.2, 0.02}, {{0, 0, 0.1}}), "body")};
    for (const double y : {-0.2, 0.2})
        parts.push_back(shape_part(cylinder_shape(0.1, 0.05, {{0, y, 0.1}, rotation_of_rpy(rad(90), 0, 0)}), "wheel"));
    if (ball) parts.push_back(shape_part(sphere_shape(0.02, *ball + Vec3(0, 0, 0.1)), "ball"));
    Robot out = make_robot("two_wheels", std::move(parts));
    out.mass_center = Vec3(mass_x, 0, 0.1 + mass_z);
    return out;
}

TEST_CASE("a robot rests on a line if its mass is below the axle of its wheels, but falls if it is above")
{
    const auto on_slope = [](double mass_z, double min_stability) {
        return settle(slope(rad(10)), on_two_wheels(0, mass_z), {0, 0, 1}, {.min_stability = min_stability});
    };
    // The wheels touch the slope at an angle of 10 degrees to the vertical. The mass, 0.04 m below the axle, hangs
    // above that line if the robot has turned by asin(0.1 sin(10 degrees) / 0.04).
    const Settled rest = on_slope(-0.04, 0.001);
    CHECK(rest.pose.verdict == Verdict::Valid);
    CHECK(std::abs(std::abs(rest.pose.pitch) - std::asin(0.1 * std::sin(rad(10)) / 0.04)) <= 1e-4);
    CHECK(std::abs(rest.pose.margin - 0.001) <= 1e-9);
    CHECK(rest.pose.tip_over <= 1e-3);
    CHECK(on_slope(0.02, 0.001).pose.verdict == Verdict::Unstable);
    // With its mass moved by m, it turns to asin((0.1 sin(10 degrees) +- m) / 0.04): by up to 8.4 or 17.4 degrees.
    CHECK(on_slope(-0.04, 0.005).pose.verdict == Verdict::Valid);
    CHECK(on_slope(-0.04, 0.01).pose.verdict == Verdict::Unstable);
}

TEST_CASE("a robot on two wheels on a slope is valid if a third foot is near the ground on one side")
{
    // The ball touches the slope if the robot turns by `gap` more than to the line of its wheels. With its mass moved
    // by 1 mm, it turns by 1.6 degrees without the ball.
    const double turned = std::asin(0.1 * std::sin(rad(10)) / 0.04);
    for (const double gap : {0.3, 1.0, 1.5, 2.5})
        for (const double side : {-1.0, 1.0}) {  // the slope rises towards +x, or the mirror image
            INFO(gap << " degrees, side " << side);
            const Mat3 on_slope = rotation_of_rpy(0, -side * rad(10), 0);
            const Mat3 touching = rotation_of_rpy(0, -side * (turned + rad(gap)), 0);
            const Vec3 ball = touching.transpose() * (on_slope * Vec3(-side * 0.3, 0, 0.02 - 0.1));
            const Settled rest = settle(slope(side * rad(10)), on_two_wheels(0, -0.04, ball), {0, 0, 1},
                                        {.min_stability = 0.001});
            CHECK(rest.pose.verdict == Verdict::Valid);
            CHECK(std::abs(rest.pose.pitch + side * turned) <= 1e-4);
            CHECK(std::abs(rest.pose.margin - 0.001) <= 1e-6);
            const bool reaches = gap < 1.6;
            CHECK(std::any_of(rest.pose.contacts.begin(), rest.pose.contacts.end(),
                              [](const RestContact& contact) { return contact.part == 3; }) == reaches);
        }
}

TEST_CASE("a robot on three feet with its mass near the line of two wheels is valid if it would only roll on them")
{
    // The mass is 0.5 mm from the axle, on the side of the ball. Moved by 1 mm, it is on the other side. Below the
    // axle, it is above the line of the wheels again when the robot has turned by asin(0.5 / 40); above it, never.
    for (const double side : {-1.0, 1.0}) {
        INFO("side " << side);
        const auto on_floor = [&](double mass_z, double min_stability) {
            return settle(floor_scene(), on_two_wheels(side * 0.0005, mass_z, Vec3(side * 0.3, 0, -0.08)), {0, 0, 0.5},
                          {.min_stability = min_stability});
        };
        const Settled rolls = on_floor(-0.04, 0.001);
        CHECK(rolls.pose.verdict == Verdict::Valid);
        CHECK(rolls.pose.tilt <= 1e-9);
        CHECK(std::abs(rolls.pose.margin - 0.001) <= 1e-6);
        const Settled tips = on_floor(0.02, 0.001);
        CHECK(tips.pose.verdict == Verdict::Unstable);
        CHECK(std::abs(tips.pose.margin - 0.0005) <= 1e-6);
        // Moved by 7.6 mm, it would turn by asin(7.1 / 40) = 10.2 degrees, which is too far.
        CHECK(on_floor(-0.04, 0.007).pose.verdict == Verdict::Valid);
        CHECK(on_floor(-0.04, 0.0076).pose.verdict == Verdict::Unstable);
    }
}

TEST_CASE("a robot that needs more friction than it has slides, and the reason says how much it needs")
{
    const Robot low = boxy({1, 1, 0.1});
    for (const double angle : {0.0, 10.0, 20.0, 29.0}) {
        INFO(angle << " degrees");
        const double needed = std::tan(rad(angle));
        CHECK(settle(slope(rad(angle)), low, {0, 0, 0.5}, {.friction = 1.03 * needed}).pose.verdict == Verdict::Valid);
        if (angle == 0) continue;
        const Settled slides = settle(slope(rad(angle)), low, {0, 0, 0.5}, {.friction = 0.99 * needed});
        CHECK(slides.pose.verdict == Verdict::Unstable);
        CHECK(slides.pose.slides);
        const std::string says = "unstable: it slides: it needs a coefficient of friction of about ";
        REQUIRE(slides.reason.starts_with(says));
        const double said = std::stod(slides.reason.substr(says.size()));
        CHECK(said >= needed);
        CHECK(said <= 1.04 * needed + 0.01);
    }
}

TEST_CASE("forces balance if they can: walls that face each other hold without friction, one wall never does")
{
    const auto contact = [](const Vec3& point, const Vec3& normal) {
        return RestContact{point, normal.normalized(), 0, 0, Label::Terrain};
    };
    const Vec3 mass(0, 0, 0.3);
    std::vector<RestContact> groove, wall;
    for (const double y : {-0.2, 0.2})
        for (const double side : {-1.0, 1.0}) {
            groove.push_back(contact({0.1 * side, y, 0}, {-side, 0, 1}));
            wall.push_back(contact({0.1 * side, y, 0}, {1, 0, 0.5}));
        }
    CHECK(is_held(groove, mass, 0.01));
    CHECK_FALSE(is_held(groove, mass + Vec3(0.35, 0, 0), 0.01));  // the moment of the walls is too small
    CHECK_FALSE(is_held(wall, mass, 1.9));                        // of slope 2
    CHECK(is_held(wall, mass, 2.1));
    CHECK(std::abs(friction_needed(wall, mass, 0.8) / 2 - 1) <= 0.035);
    CHECK(std::isinf(friction_needed(std::span(wall).first(1), mass, 0.8)));
}

TEST_CASE("a robot without room collides, and the reason names what is in the way")
{
    Scene scene = floor_scene();
    add_block(scene, {-1, -1, 0.25}, {1, 1, 3}, Label::Obstacle, "ceiling");
    const Settled low = settle(scene, on_balls(), {0, 0, 0.1});
    CHECK(low.pose.verdict == Verdict::Collision);
    CHECK(!low.pose.has_pose);
    CHECK(low.reason == "collision: it has no room to settle, because of ceiling");

    Scene in_hall = floor_scene();
    add_block(in_hall, {-3, -3, 0}, {3, 3, 3}, Label::Obstacle, "hall");
    const Settled inside = settle(in_hall, boxy({0.2, 0.2, 0.2}), {0, 0, 0.1});
    CHECK(inside.pose.verdict == Verdict::Collision);
    CHECK(inside.pose.hit);

    Scene wall = floor_scene();
    add_block(wall, {0.2, -1, 0}, {0.3, 1, 2}, Label::Obstacle, "wall");
    CHECK(settle(wall, on_balls()).reason == "collision: it has no room to settle, because of wall");
    CHECK(settle(wall, on_balls(), {-0.2, 0, 0.5}).pose.verdict == Verdict::Valid);
}

TEST_CASE("a robot that comes to rest on an obstacle is off terrain")
{
    Scene scene = floor_scene();
    add_block(scene, {0.1, -1, 0}, {2, 1, 0.05}, Label::Obstacle, "mat");
    const Settled rest = settle(scene, on_balls());
    CHECK(rest.pose.verdict == Verdict::OffTerrain);
    CHECK(rest.reason == "off_terrain: it comes to rest on mat");
    CHECK(settle(scene, on_balls(), {1, 0, 0.5}).pose.verdict == Verdict::OffTerrain);  // the ground is the obstacle
    CHECK(settle(scene, on_balls(), {-0.6, 0, 0.5}).pose.verdict == Verdict::Valid);
}

TEST_CASE("a place that cannot be used has the verdict of a pose there")
{
    Scene scene = floor_scene();
    add_shape(scene, "lake", Label::Water, box_shape({1, 1, 0.2}, {{3, 3, 0}}));
    CHECK(settle(scene, on_balls(), {3, 3, 0.5}).pose.verdict == Verdict::Submerged);
    CHECK(settle(scene, on_balls(), {0, 0, 1.5}).pose.verdict == Verdict::Aerial);
    CHECK(settle(scene, on_balls(), {0, 0, -3}).pose.verdict == Verdict::Aerial);
    CHECK(settle(scene, on_balls(), {9, 0, 0.5}).pose.verdict == Verdict::Outside);
    CHECK(settle(scene, on_balls(), {9, 0, 0.5}).reason == "outside the map's bounds");
}

TEST_CASE("a robot under a beam cannot be raised, and below a fence it cannot fall from above")
{
    const auto below = [](double height, const StandLimits& limits) {  // of the beam above the robot
        Scene scene = floor_scene();
        add_block(scene, {-2, -0.05, 0.3 + height}, {2, 0.05, 0.4 + height}, Label::Obstacle, "beam");
        return settle(scene, on_balls(), {0, 0, 0.1}, limits);
    };
    CHECK(below(0.021, {}).pose.verdict == Verdict::Valid);
    const Settled wedged = below(0.019, {});
    CHECK(wedged.pose.verdict == Verdict::Obstructed);
    CHECK(wedged.reason == "obstructed by beam: it can be raised by 0.019 m, --lift is 0.02 m");
    CHECK(below(0.019, {.lift = 0.01}).pose.verdict == Verdict::Valid);
    CHECK(below(0.019, {.lift = 0}).pose.verdict == Verdict::Valid);
    CHECK(below(0.2, {}).pose.verdict == Verdict::Valid);
    CHECK(below(0.2, {.drop = 0.19}).pose.verdict == Verdict::Valid);
    CHECK(below(0.2, {.drop = 0.21}).pose.verdict == Verdict::Obstructed);
    CHECK(below(0.2, {.drop = 0.21}).reason == "obstructed: it can fall from 0.2 m above its rest, --drop is 0.21 m");

    // A thin sheet that the robot would pass through on its way up, without touching it at the end.
    Scene scene = floor_scene();
    add_block(scene, {0.05, -2, 0.0105}, {2, 2, 0.0106}, Label::Obstacle, "sheet");
    CHECK(settle(scene, boxy({0.3, 0.3, 0.01}), {0, 0, 0.005}).pose.verdict == Verdict::Obstructed);
}

TEST_CASE("a settled pose belongs to one layer of its column")
{
    Scene scene = floor_scene();  // a thin slab above the floor
    add_block(scene, {-2, -2, 0.04}, {2, 2, 0.05}, Label::Terrain, "slab");
    CHECK(settle(scene, on_balls(0.05), {0, 0, 0.06}).pose.verdict == Verdict::Valid);
    const Settled lower = settle(scene, on_balls(0.05), {0, 0, 0.03});
    CHECK(lower.pose.verdict == Verdict::Collision);
    CHECK(lower.reason == "collision: its pose belongs to a higher layer");
}

TEST_CASE("the cases in closed form are valid if their robot is stable")
{
    const auto scenes = shared_scenes();
    if (!scenes) return;
    const std::filesystem::path folder = scenes->parent_path() / "standing";
    const nlohmann::json cases = nlohmann::json::parse(std::ifstream(folder / "cases.json"));
    for (const nlohmann::json& expected : cases.at("cases")) {
        INFO(expected.at("name").get<std::string>());
        const Robot robot = load_robot((folder / expected.at("robot").get<std::string>()).string());
        const Scene scene = load_scene(folder / expected.at("scene").get<std::string>());
        const Judge judge(map_of(scene), robot);
        const auto value = [&](const char* key) { return expected.at(key).get<double>(); };
        const SettledPose pose = judge.settle({value("x"), value("y"), value("z") + 0.5}, value("yaw"));
        CHECK(pose.verdict == (expected.at("stable").get<bool>() ? Verdict::Valid : Verdict::Unstable));
    }
}

TEST_CASE("each valid settled pose is valid as it is written, and none of another verdict is hidden")
{
    VerdictCounts counts;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const Scene scene = random_scene(seed);
        const Robot robot = seed % 3 ? random_robot(seed) : on_balls(0.1);
        const Judge judge(map_of(scene), robot, {.stand = {.max_slope = rad(40)}});
        std::vector<Pose> poses = random_poses(scene, seed, 40);
        const std::vector<SettledPose> settled = judge.settle(poses);
        REQUIRE(settled.size() == poses.size());
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const SettledPose& pose = settled[i];
            INFO("seed " << seed << ", pose " << i);
            ++counts[pose.verdict];
            const bool has_rest = pose.has_pose && pose.contacts.size() >= 2;  // two: it rolls on a line
            if (pose.verdict != Verdict::Valid) continue;
            REQUIRE(has_rest);
            CHECK(pose.tilt <= rad(40) + 1e-9);
            CHECK(pose.margin >= *judge.options().stand.min_stability - 1e-9);
            CHECK(judge.is_valid(pose.lifted(0.02)));
            CHECK(judge.check(pose.lifted(-1e-5)).verdict != Verdict::Valid);
            // A second settling on the same ground is the same, and the order of poses does not matter.
            const SettledPose again = judge.settle(poses[i].position, pose.yaw);
            CHECK(again.position == pose.position);
            CHECK(again.roll == pose.roll);
            CHECK(again.pitch == pose.pitch);
            CHECK(again.margin == pose.margin);
        }
    }
    for (const Verdict verdict : {Verdict::Valid, Verdict::Steep, Verdict::Unstable, Verdict::Collision,
                                  Verdict::OffTerrain, Verdict::Submerged, Verdict::Aerial, Verdict::Outside})
        CHECK(counts[verdict] > 0);
}

TEST_CASE("settled poses are the same for any number of threads")
{
    const Scene scene = random_scene(5);
    const Judge judge(map_of(scene), on_balls(0.1));
    const std::vector<Pose> poses = random_poses(scene, 5, 600);
    const std::vector<SettledPose> one = judge.settle(poses, {.threads = 1});
    for (const int threads : {2, 8}) {
        const std::vector<SettledPose> many = judge.settle(poses, {.threads = threads});
        for (std::size_t i = 0; i < poses.size(); ++i) {
            CHECK(many[i].verdict == one[i].verdict);
            CHECK(many[i].position == one[i].position);
            CHECK(many[i].contacts.size() == one[i].contacts.size());
        }
    }
}

TEST_CASE("a wider wheel base never makes a stable robot unstable on a plane")
{
    for (const double angle : {0.0, 15.0, 29.0})
        for (const double heading : {0.0, 0.5, 1.2}) {
            bool was_valid = false;
            for (const double wide : {0.1, 0.2, 0.35, 0.6, 1.0}) {
                const Judge judge(map_of(slope(rad(angle))), boxy({wide, wide, 0.4}));
                const bool is_valid = judge.settle({0, 0, 1}, heading).verdict == Verdict::Valid;
                CHECK((is_valid || !was_valid));
                was_valid = is_valid;
            }
            CHECK(was_valid);
        }
}

TEST_CASE("limits of settled poses that are out of range are refused")
{
    const auto make = [](const JudgeOptions& options) { Judge(map_of(floor_scene()), on_balls(), options); };
    CHECK_THROWS_WITH(make({.stand = {.lift = -1}}), "Judge: stand.lift is -1, needs >= 0 m");
    CHECK_THROWS_WITH(make({.stand = {.max_slope = 2}}), "Judge: stand.max_slope is 2, needs > 0 and < pi/2 rad");
    CHECK_THROWS_WITH(make({.stand = {.max_tilt = 0}}), "Judge: stand.max_tilt is 0, needs > 0 and < pi/2 rad");
    CHECK_THROWS_WITH(make({.stand = {.min_stability = -1}}), "Judge: stand.min_stability is -1, needs >= 0 m");
    CHECK_THROWS_WITH(make({.stand = {.drop = 0.0}}), "Judge: stand.drop is 0, needs > 0 m");
}

TEST_CASE(
    "settled samples are settled poses, raised by the lift, valid as written, and the same at any number of threads")
{
    std::size_t tilted = 0;
    for (const std::uint64_t seed : {1u, 2u, 4u, 5u, 7u, 8u, 9u, 10u}) {
        INFO("seed " << seed);
        const Judge judge(map_of(random_scene(seed)), seed < 6 ? random_robot(seed) : on_balls(0.1),
                          {.stand = {.lift = 0.03}});
        SampleOptions options{.count = 20,
                              .min_distance = 0.3,
                              .random_yaw = true,
                              .seed = seed,
                              .stance = Stance::Settled,
                              .threads = 1};
        const SpawnList list = sample(judge, options);
        CHECK(list.counts[Verdict::Valid] == list.spawns.size());
        for (const Spawn& spawn : list.spawns) {
            tilted += spawn.roll != 0 || spawn.pitch != 0;
            const Pose written{spawn.position, rotation_from_rpy(spawn.roll, spawn.pitch, spawn.yaw)};
            CHECK(judge.is_valid(written));
            if (seed < 6) continue;  // the origin of a random robot may be below its ground
            const SettledPose again = judge.settle(spawn.position, spawn.yaw);
            CHECK(again.verdict == Verdict::Valid);
            CHECK((again.lifted(0.03).position - spawn.position).norm() <= 1e-9);
            CHECK(std::abs(again.roll - spawn.roll) <= 1e-9);
        }
        for (std::size_t i = 0; i < list.spawns.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                CHECK((list.spawns[i].position - list.spawns[k].position).norm() >= 0.3);
        for (const int threads : {2, 8}) {
            options.threads = threads;
            const SpawnList other = sample(judge, options);
            REQUIRE(other.spawns.size() == list.spawns.size());
            for (std::size_t i = 0; i < list.spawns.size(); ++i) {
                CHECK(other.spawns[i].position == list.spawns[i].position);
                CHECK(other.spawns[i].roll == list.spawns[i].roll);
                CHECK(other.spawns[i].pitch == list.spawns[i].pitch);
            }
            CHECK(other.counts == list.counts);
        }
    }
    CHECK(tilted > 30);
}

TEST_CASE("samples are settled unless they are asked to be level, and only level ones may have an offset")
{
    Scene scene;
    add_block(scene, {-2, -2, -1}, {2, 2, 0}, Label::Terrain, "floor");
    const Judge judge(map_of(scene), on_balls());
    CHECK(SampleOptions{}.stance == Stance::Settled);
    CHECK(RasterOptions{}.stance == Stance::Level);
    const SpawnList list = sample(judge, {.count = 3});
    REQUIRE(list.spawns.size() == 3);
    for (const Spawn& spawn : list.spawns) {
        const SettledPose pose = judge.settle(spawn.position, spawn.yaw);
        CHECK(std::abs(pose.lifted(0.02).position.z() - spawn.position.z()) <= 1e-9);
    }
    CHECK_THROWS_AS(sample(judge, {.offset = 0.3}), ArgumentError);
    CHECK_THROWS_WITH(
        sample(judge, {.offset = 0.3}),
        "sample: offset is 0.3, but stance is Settled: settled robots stand on the ground, and only level "
        "ones have an offset; give stance Level, or no offset");
    for (const Spawn& spawn : sample(judge, {.count = 3, .stance = Stance::Level, .offset = 0.3}).spawns)
        CHECK(spawn.position.z() == 0.3);
}

TEST_CASE("sampling of settled poses ends when nothing fits, without a proof")
{
    Scene scene;
    add_block(scene, {-1, -1, -1}, {1, 1, 0}, Label::Obstacle, "table");
    add_block(scene, {-1, -1, -3}, {1, 1, -2}, Label::Terrain, "floor");
    const Judge judge(map_of(scene), on_balls());
    const SpawnList list = sample(judge, {.count = 5, .min_distance = 5, .stance = Stance::Settled});
    CHECK(list.spawns.size() == 1);
    CHECK(!list.is_full);
    CHECK(std::isnan(list.undecided_area));
}

TEST_CASE("a settled raster has the settled pose of every layer, raised by the lift, with any number of threads")
{
    std::size_t tilted = 0, without_pose = 0;
    for (const std::uint64_t seed : {1u, 9u}) {
        INFO("seed " << seed);
        const Judge judge(map_of(random_scene(seed)), seed < 6 ? random_robot(seed) : on_balls(0.1),
                          {.stand = {.lift = 0.03}});
        RasterOptions options{.step = 0.9, .stance = Stance::Settled, .yaw = 0.4, .threads = 1};
        const RasterResult settled = raster(judge, options);
        const RasterResult level = raster(judge, {.step = 0.9, .offset = settled.offset});
        REQUIRE(settled.poses.size() == level.poses.size());
        REQUIRE(settled.rests.size() == settled.poses.size());
        CHECK(settled.counts.total() == settled.poses.size());
        for (std::size_t i = 0; i < settled.poses.size(); ++i) {
            const RasterPose &pose = settled.poses[i], &layer = level.poses[i];
            const RasterRest& rest = settled.rests[i];
            const SettledPose one = judge.settle({layer.x, layer.y, layer.z - level.offset}, 0.4);
            REQUIRE(std::pair(pose.x, pose.y) == std::pair(layer.x, layer.y));
            CHECK(pose.layer == layer.layer);
            CHECK(pose.verdict == one.verdict);
            CHECK(rest.has_pose() == one.has_pose);
            CHECK(std::abs(rest.layer_height - (layer.z - level.offset)) <= 1e-12);
            without_pose += !one.has_pose;
            if (!one.has_pose) {
                CHECK(pose.z == layer.z);
                continue;
            }
            tilted += one.tilt > 0.01;
            CHECK(std::abs(pose.z - one.lifted(0.03).position.z()) <= 1e-9);
            CHECK(std::abs(rest.roll - one.roll) + std::abs(rest.pitch - one.pitch) <= 1e-9);
            CHECK(std::abs(rest.tilt - one.tilt) + std::abs(rest.margin - one.margin) <= 1e-9);
            CHECK(std::abs(rest.tip_over - one.tip_over) + std::abs(rest.belly - one.belly) <= 1e-9);
        }
        for (const int threads : {2, 8}) {
            options.threads = threads;
            CHECK(csv_of(raster(judge, options)) == csv_of(settled));
        }
    }
    CHECK(tilted > 100);
    CHECK(without_pose > 100);
}

TEST_CASE("a settled raster at several headings merges the rasters at each of them")
{
    const Judge judge(map_of(random_scene(9)), on_balls(0.1));
    RasterOptions options{.step = 1.2, .stance = Stance::Settled};
    const HeadingRaster all = raster_at_headings(judge, options, 4);
    CHECK(all.raster.rests.empty());
    std::vector<int> valid(all.raster.poses.size());
    for (int k = 0; k < 4; ++k) {
        options.yaw = 2 * std::numbers::pi * k / 4;
        const RasterResult one = raster(judge, options);
        REQUIRE(one.poses.size() == valid.size());
        for (std::size_t i = 0; i < valid.size(); ++i) valid[i] += one.poses[i].verdict == Verdict::Valid;
    }
    std::size_t at_some = 0;
    for (std::size_t i = 0; i < valid.size(); ++i) {
        CHECK(int(all.valid_headings[i]) == valid[i]);
        CHECK((all.raster.poses[i].verdict == Verdict::Valid) == (valid[i] > 0));
        at_some += valid[i] > 0 && valid[i] < 4;
    }
    CHECK(at_some > 0);
}

TEST_CASE("a settled raster on a slope has the tilt of the slope, and its rows are valid poses")
{
    const Judge judge(map_of(slope(rad(12)), 0.1, {{-2, -2, -3}, {2, 2, 3}}), on_balls());
    const RasterResult result = raster(judge, {.step = 1, .stance = Stance::Settled, .yaw = 0});
    REQUIRE(result.poses.size() == 25);
    CHECK(result.counts[Verdict::Valid] == 25);
    for (std::size_t i = 0; i < result.poses.size(); ++i) {
        const RasterPose& pose = result.poses[i];
        CHECK(std::abs(result.rests[i].pitch + rad(12)) <= 1e-9);
        CHECK(std::abs(result.rests[i].roll) <= 1e-9);
        CHECK(judge.is_valid({{pose.x, pose.y, pose.z}, rotation_from_rpy(0, result.rests[i].pitch, 0)}));
    }
    const std::string text = csv_of(result);
    CHECK(text.substr(0, text.find('\n')) == "x,y,z,roll,pitch,yaw,layer,verdict,tilt,margin,tip_over,belly,ground");
    CHECK(std::count(text.begin(), text.end(), '\n') == 26);
}

TEST_CASE("a settled raster needs two dimensions and the scene's own geometry")
{
    const Judge judge(map_of(floor_scene()), on_balls());
    CHECK_THROWS_WITH(raster(judge, {.dims = 3, .stance = Stance::Settled}),
                      "raster: settled poses need dims 2: the robot is let down onto the layers of a column");
    CHECK_THROWS_WITH(
        raster(judge, {.stance = Stance::Settled, .offset = 0.2}),
        "raster: offset is 0.2, but stance is Settled: settled robots stand on the ground, and only level "
        "ones have an offset; give stance Level, or no offset");
    const Judge voxels(make_map(floor_scene(), {}), on_balls(), {.obstacles = Obstacles::Voxels});
    CHECK_THROWS_AS(raster(voxels, {.stance = Stance::Settled}), ArgumentError);
}

TEST_CASE("a larger limit of the tilt changes no pose that is reached with a smaller one")
{
    std::size_t compared = 0, tilted = 0;
    for (const std::uint64_t seed : {2u, 5u, 8u, 9u}) {
        INFO("seed " << seed);
        const auto rests = [&](double max_tilt) {
            const Judge judge(map_of(random_scene(seed)), on_balls(0.1), {.stand = {.max_tilt = rad(max_tilt)}});
            return raster(judge, {.step = 0.8, .stance = Stance::Settled, .yaw = 0.3}).rests;
        };
        const std::vector<RasterRest> low = rests(20), high = rests(60);
        REQUIRE(low.size() == high.size());
        for (std::size_t i = 0; i < low.size(); ++i) {
            if (!low[i].has_pose() || low[i].margin < 0.01) continue;  // otherwise, it may only balance there
            ++compared;
            tilted += low[i].tilt > 0.1;
            CHECK(std::abs(low[i].roll - high[i].roll) + std::abs(low[i].pitch - high[i].pitch) <= 1e-9);
        }
    }
    CHECK(compared > 100);
    CHECK(tilted > 5);
}

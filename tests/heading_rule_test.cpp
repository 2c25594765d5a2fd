#include "arena.h"
#include "test_map.h"

#include "base/polygon2.h"
#include "query/clearance.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

#include <algorithm>
#include <bit>
#include <cmath>

using namespace spawnfield;

// Tests of rules for the heading of robots at rest.

namespace {

using Kind = HeadingRule::Kind;

constexpr double pi = std::numbers::pi;

/// A long box, so that its heading matters beside walls. Its origin is in the middle of its lowest plane.
Robot long_box()
{
    Robot out = make_robot("long", {shape_part(box_shape({0.9, 0.3, 0.3}, {{0, 0, 0.15}}))});
    out.mass_center = Vec3(0.1, 0, 0.15);
    return out;
}

/// Returns a plane through the origin that rises in the direction `uphill` (rad).
Scene slope(double angle, double uphill)
{
    Scene scene;
    const Mat3 turned = rotation_of_rpy(0, 0, uphill) * rotation_of_rpy(0, -angle, 0);
    add_shape(scene, "slope", Label::Terrain, box_shape({14, 14, 0.5}, {turned * Vec3(0, 0, -0.25), turned}));
    return scene;
}

/// Adds a box that is turned about the z axis of the scene by `turn`, as all of the scene.
void add_turned(Scene& scene, Label label, const Vec3& size, const Vec3& at, double turn)
{
    const Mat3 turned = rotation_from_rpy(0, 0, turn);
    add_shape(scene, "part " + std::to_string(scene.parts.size()), label, box_shape(size, {turned * at, turned}));
}

/// Returns the yaw of the long box at a place of a scene, and its verdict.
RasterRest rest_at(const Map& map, const Vec2& place, const HeadingRule& rule)
{
    const Judge judge(map, long_box());
    const Bounds bounds{{place.x(), place.y(), -9}, {place.x(), place.y(), 9}};
    const RasterResult result = raster(
        judge,
        {.step = 1, .bounds = bounds, .stance = Stance::Settled, .heading = rule, .layers = {LayerChoice::Kind::Top}});
    REQUIRE(result.poses.size() == 1);
    REQUIRE(result.poses[0].verdict == Verdict::Valid);
    return result.rests[0];
}

const Bounds wide_bounds{{-30, -30, -9}, {30, 30, 9}};

/// Returns how many steps of half its length a robot can make from a pose with its yaw, as docs/standing.md defines it.
int steps_from(const Judge& judge, const SettledPose& start, int direction)
{
    const Bounds box = judge.robot().bounds();
    const double step = (box.max.x() - box.min.x()) / 2, rise = step * std::tan(judge.options().stand.max_slope) + 1e-9;
    double ground = start.ground->height;
    for (int steps = 0; steps < 40; ++steps) {
        const double way = direction * (steps + 1) * step;
        Vec3 at = start.position + way * Vec3(std::cos(start.yaw), std::sin(start.yaw), 0);
        const auto below = ground_below(column_at(judge.map().geometry, at.x(), at.y()), ground + rise);
        if (!below || below->height < ground - rise) return steps;
        at.z() = ground = below->height;
        if (judge.settle(at, start.yaw).verdict != Verdict::Valid) return steps;
    }
    return 40;
}

bool is_same_angle(double a, double b) { return std::abs(std::remainder(a - b, 2 * pi)) <= 1e-9; }

}  // namespace

TEST_CASE("a raster with several headings finds those that are valid one by one, and chooses by its rule")
{
    constexpr int count = 6;
    const Judge judge(map_of(random_scene(9)), long_box());
    RasterOptions options{.step = 0.8, .stance = Stance::Settled};
    std::vector<RasterResult> single;
    for (int k = 0; k < count; ++k) {
        options.yaw = heading_of(k, count);
        single.push_back(raster(judge, options));
    }
    std::size_t at_some = 0;
    for (const Kind kind : {Kind::Any, Kind::All, Kind::Best}) {
        CAPTURE(int(kind));
        options.heading = HeadingRule{.kind = kind, .count = count};
        const RasterResult result = raster(judge, options);
        REQUIRE(result.poses.size() == single[0].poses.size());
        REQUIRE(result.rests.size() == result.poses.size());
        for (std::size_t i = 0; i < result.poses.size(); ++i) {
            std::uint64_t valid = 0;
            double best = -1;
            for (int k = 0; k < count; ++k) {
                if (single[std::size_t(k)].poses[i].verdict != Verdict::Valid) continue;
                valid |= std::uint64_t{1} << k;
                best = std::max(best, single[std::size_t(k)].rests[i].margin);
            }
            const RasterRest& rest = result.rests[i];
            CHECK(rest.valid_headings == valid);
            at_some += valid != 0 && std::popcount(valid) < count;
            const bool is_valid = kind == Kind::All ? std::popcount(valid) == count : valid != 0;
            CHECK((result.poses[i].verdict == Verdict::Valid) == is_valid);
            const auto k = std::size_t(std::lround(rest.yaw / (2 * pi) * count));
            REQUIRE(is_same_angle(rest.yaw, heading_of(int(k), count)));
            CHECK(result.poses[i].verdict == single[k].poses[i].verdict);
            CHECK(result.poses[i].z == single[k].poses[i].z);
            CHECK(rest.pitch == single[k].rests[i].pitch);
            if (is_valid && kind == Kind::Best) CHECK(rest.margin >= best - 1e-8);
            if (is_valid && kind != Kind::Best) CHECK(int(k) == std::countr_zero(valid));
        }
        options.threads = 2;
        CHECK(csv_of(raster(judge, options)) == csv_of(result));
        options.threads = 0;
        const std::string text = csv_of(result);
        CHECK(text.substr(0, text.find('\n')) ==
              "x,y,z,roll,pitch,yaw,layer,verdict,tilt,margin,tip_over,belly,valid_headings,ground");
    }
    CHECK(at_some > 20);
}

TEST_CASE("robots face downhill, uphill or a point")
{
    for (const double uphill : {0.0, 0.7, 2.5, -1.9}) {
        CAPTURE(uphill);
        const Judge judge(map_of(slope(0.2, uphill), 0.1, {{-2, -2, -2}, {2, 2, 2}}), long_box());
        RasterOptions options{.step = 1, .stance = Stance::Settled, .heading = HeadingRule{.kind = Kind::Downhill}};
        const RasterResult down = raster(judge, options);
        options.heading->kind = Kind::Uphill;
        const RasterResult up = raster(judge, options);
        CHECK(down.counts[Verdict::Valid] == 25);
        for (std::size_t i = 0; i < down.poses.size(); ++i) {
            CHECK(is_same_angle(down.rests[i].yaw, uphill + pi));
            CHECK(is_same_angle(up.rests[i].yaw, uphill));
            CHECK(std::abs(down.rests[i].pitch - 0.2) <= 1e-9);  // the nose is lower than the tail
            CHECK(std::abs(up.rests[i].pitch + 0.2) <= 1e-9);
            CHECK(std::abs(down.rests[i].roll) <= 1e-9);
        }
        options.heading = HeadingRule{.kind = Kind::Facing, .x = 0.3, .y = -5};
        const RasterResult facing = raster(judge, options);
        for (std::size_t i = 0; i < facing.poses.size(); ++i) {
            const RasterPose& pose = facing.poses[i];
            CHECK(is_same_angle(facing.rests[i].yaw, std::atan2(-5 - pose.y, 0.3 - pose.x)));
        }
    }
    const Judge flat(map_of(slope(0, 0), 0.1, {{-1, -1, -2}, {1, 1, 2}}), long_box());
    for (const Kind kind : {Kind::Downhill, Kind::Uphill}) {
        const RasterResult level = raster(flat,
                                          {.step = 1, .stance = Stance::Settled, .heading = HeadingRule{.kind = kind}});
        for (const RasterRest& rest : level.rests) CHECK(rest.yaw == 0);
    }
}

TEST_CASE("the clearest heading of a long robot beside a wall is along the wall")
{
    for (const int turned : {0, 3, 5}) {
        CAPTURE(turned);
        const double turn = heading_of(turned, 16);
        Scene scene;
        add_turned(scene, Label::Terrain, {30, 30, 1}, {0, 0, -0.5}, turn);
        add_turned(scene, Label::Obstacle, {20, 0.2, 1}, {0, 0.9, 0.5}, turn);
        const TestMap map = map_of(scene, 0.1, wide_bounds);
        const RasterRest rest = rest_at(map, Vec2::Zero(), {.kind = Kind::Clearest, .count = 16});
        CHECK(is_same_angle(rest.yaw, turn));
        CHECK(rest.free_length == Approx(0.8 - 0.15).margin(1e-8));
        const Pose pose{{0, 0, 0.02}, rotation_from_rpy(0, 0, turn)};
        CHECK(ClearanceMeter(map.geometry, long_box()).clearance_at(pose) == Approx(0.8 - 0.15).margin(1e-8));
    }
    Scene open;  // without obstacles, and with one above the robot: all headings are equal
    add_turned(open, Label::Terrain, {30, 30, 1}, {0, 0, -0.5}, 0);
    add_turned(open, Label::Obstacle, {30, 30, 1}, {0, 0, 1.5}, 0);
    CHECK(rest_at(map_of(open, 0.1, wide_bounds), Vec2::Zero(), {.kind = Kind::Clearest, .count = 16}).yaw == 0);
}

TEST_CASE("a robot along a corridor or a strip has its direction, towards the farther end, however the scene is turned")
{
    for (const int turned : {0, 1, 3, 6, 9, 14}) {
        CAPTURE(turned);
        const double turn = heading_of(turned, 16);
        const Vec2 place = (rotation_from_rpy(0, 0, turn) * Vec3(-3, 0.1, 0)).head<2>();
        const HeadingRule along{.kind = Kind::Along, .count = 16};
        Scene corridor;
        add_turned(corridor, Label::Terrain, {30, 30, 1}, {0, 0, -0.5}, turn);
        for (const double side : {-1.0, 1.0}) {
            add_turned(corridor, Label::Obstacle, {12, 0.02, 1}, {0, 0.7 * side, 0.5}, turn);
            add_turned(corridor, Label::Obstacle, {0.02, 2, 1}, {6 * side, 0, 0.5}, turn);
        }
        const RasterRest rest = rest_at(map_of(corridor, 0.1, wide_bounds), place, along);
        CHECK(is_same_angle(rest.yaw, turn));
        // Its front, 0.45 m ahead, starts 9 m - 0.01 m before the wall, and it goes on in steps of 0.45 m.
        CHECK(rest.free_length == Approx(18 * 0.45).margin(1e-9));
        Scene strip;  // a ledge with a step of 5 cm, above ground that is 3 m lower
        add_turned(strip, Label::Terrain, {30, 30, 1}, {0, 0, -3.5}, turn);
        add_turned(strip, Label::Terrain, {12, 0.9, 1}, {0, 0, -0.5}, turn);
        add_turned(strip, Label::Terrain, {4, 0.9, 0.05}, {4, 0, 0.025}, turn);
        CHECK(is_same_angle(rest_at(map_of(strip, 0.1, wide_bounds), place, along).yaw, turn));
    }
}

TEST_CASE("of equally long ways ahead, the longer one back decides, then the first heading")
{
    const HeadingRule along{.kind = Kind::Along, .count = 8};
    Scene open;
    add_turned(open, Label::Terrain, {50, 50, 1}, {0, 0, -0.5}, 0);
    const TestMap plane = map_of(open, 0.1, wide_bounds);
    const RasterRest rest = rest_at(plane, Vec2::Zero(), along);
    CHECK(rest.yaw == 0);
    CHECK(rest.free_length == Approx(18).margin(1e-9));  // 20 lengths of the robot
    CHECK(rest_at(plane, Vec2::Zero(), {.kind = Kind::Along, .count = 1}).free_length == rest.free_length);

    Scene tee;  // a strip from the middle along x, and one on both sides along y
    add_turned(tee, Label::Terrain, {6, 0.9, 1}, {2.5, 0, -0.5}, 0);
    add_turned(tee, Label::Terrain, {0.9, 11, 1}, {0, 0, -0.5}, 0);
    const TestMap map = map_of(tee, 0.1, wide_bounds);
    const Judge judge(map, long_box());
    const SettledPose ahead = judge.settle(Vec3::Zero(), 0), aside = judge.settle(Vec3::Zero(), pi / 2);
    REQUIRE(steps_from(judge, ahead, 1) == steps_from(judge, aside, 1));
    REQUIRE(steps_from(judge, ahead, -1) < steps_from(judge, aside, -1));
    CHECK(is_same_angle(rest_at(map, Vec2::Zero(), along).yaw, pi / 2));
}

TEST_CASE("the headings along a way and farthest from obstacles are those that a comparison of all headings finds",
          "[slow]")
{
    constexpr int count = 8;
    std::size_t chosen_along = 0, chosen_clear = 0;
    for (const std::uint64_t seed : {9, 12}) {
        const TestMap map = map_of(random_scene(seed));
        const Judge judge(map, long_box());
        const ClearanceMeter meter(map.geometry, long_box());
        RasterOptions options{.step = 1.3, .stance = Stance::Settled};
        options.heading = HeadingRule{.kind = Kind::Along, .count = count};
        const RasterResult along = raster(judge, options);
        options.heading->kind = Kind::Clearest;
        const RasterResult clear = raster(judge, options);
        options.threads = 2;
        CHECK(csv_of(raster(judge, options)) == csv_of(clear));
        for (std::size_t i = 0; i < along.poses.size(); ++i) {
            const RasterPose& pose = along.poses[i];
            std::pair<int, int> longest{-1, -1};
            double clearest = -1, way_yaw = 0, clear_yaw = 0;
            for (int k = 0; k < count; ++k) {
                const Vec3 place(pose.x, pose.y, along.rests[i].layer_height);
                const SettledPose settled = judge.settle(place, heading_of(k, count));
                if (settled.verdict != Verdict::Valid) continue;
                const std::pair<int, int> way{steps_from(judge, settled, 1), steps_from(judge, settled, -1)};
                if (way > longest) way_yaw = settled.yaw;
                longest = std::max(longest, way);
                const double clearance = meter.clearance_at(settled.lifted(judge.options().stand.lift));
                if (clearance > clearest + 1e-6) {
                    clear_yaw = settled.yaw;
                    clearest = clearance;
                }
            }
            CHECK((pose.verdict == Verdict::Valid) == (clearest >= 0));
            CHECK(std::isnan(along.rests[i].free_length) == (pose.verdict != Verdict::Valid));
            if (pose.verdict != Verdict::Valid) continue;
            CHECK(along.rests[i].yaw == way_yaw);
            CHECK(clear.rests[i].yaw == clear_yaw);
            CHECK(along.rests[i].free_length == Approx(longest.first * 0.45));
            CHECK(std::abs(clear.rests[i].free_length - clearest) <= 1e-6);
            CHECK(along.rests[i].valid_headings == clear.rests[i].valid_headings);
            chosen_along += way_yaw != 0;
            chosen_clear += clear_yaw != 0;
        }
    }
    CHECK(chosen_along > 10);
    CHECK(chosen_clear > 10);
}

TEST_CASE("spawns have the headings of their rule, and are valid")
{
    const Judge judge(map_of(random_scene(9)), long_box());
    for (const HeadingRule& rule :
         {HeadingRule{.kind = Kind::Any, .count = 5}, HeadingRule{.kind = Kind::All, .count = 5},
          HeadingRule{.kind = Kind::Best, .count = 5}, HeadingRule{.kind = Kind::Clearest, .count = 5},
          HeadingRule{.kind = Kind::Along, .count = 5}, HeadingRule{.kind = Kind::Downhill},
          HeadingRule{.kind = Kind::Facing, .x = 1, .y = 2}}) {
        CAPTURE(to_string(rule));
        SampleOptions options{.count = 60, .min_distance = 0.2, .heading = rule, .threads = 1};
        const SpawnList list = sample(judge, options);
        REQUIRE(list.spawns.size() >= 20);
        REQUIRE(list.rests.size() == list.spawns.size());
        const bool is_measured = rule.kind == Kind::Clearest || rule.kind == Kind::Along;
        for (const SpawnRest& rest : list.rests) CHECK(std::isfinite(rest.free_length) == is_measured);
        std::vector<int> used(5);
        for (const Spawn& spawn : list.spawns) {
            const Vec3& at = spawn.position;
            CHECK(judge.is_valid({at, rotation_from_rpy(spawn.roll, spawn.pitch, spawn.yaw)}));
            if (rule.kind == Kind::Facing) CHECK(is_same_angle(spawn.yaw, std::atan2(2 - at.y(), 1 - at.x())));
            if (!rule.has_several()) continue;
            const int k = int(std::lround(spawn.yaw / (2 * pi) * 5));
            CHECK(is_same_angle(spawn.yaw, heading_of(k, 5)));
            ++used[std::size_t(k)];
            if (rule.kind != Kind::All) continue;
            for (int other = 0; other < 5; ++other)
                CHECK(judge.settle(at, heading_of(other, 5)).verdict == Verdict::Valid);
        }
        if (rule.kind == Kind::Any || rule.kind == Kind::All)
            for (const int count : used) CHECK(count > 0);
        options.threads = 8;
        CHECK(spawns_csv(sample(judge, options)) == spawns_csv(list));
    }
}

TEST_CASE("rules for the heading that are out of range are refused")
{
    const Judge judge(map_of(slope(0, 0), 0.1, {{-1, -1, -2}, {1, 1, 2}}), long_box());
    for (const int count : {0, 65}) {
        const HeadingRule rule{.kind = Kind::Any, .count = count};
        CHECK_THROWS_WITH(sample(judge, {.heading = rule}), Contains("heading.count") && Contains("1 .. 64"));
        CHECK_THROWS_WITH(raster(judge, {.stance = Stance::Settled, .heading = rule}), Contains("1 .. 64"));
    }
    const HeadingRule rule{.kind = Kind::Downhill};
    CHECK_THROWS_WITH(sample(judge, {.stance = Stance::Level, .heading = rule}), Contains("stance is Level"));
    CHECK_THROWS_WITH(raster(judge, {.heading = rule}), Contains("stance is Level"));

    const Arena arena;
    const auto refused = [&](const std::string& command, const std::string& message) {
        const ProgramRun run = arena(command + husky_option);
        CAPTURE(command);
        CHECK(run.status == 2);
        CHECK_THAT(run.err, Contains(message));
    };
    refused("sample map -n 1 --yaw any:0",
            "--yaw is \"any:0\", needs a number of headings, 1 .. 64, for example any:8");
    refused("sample map -n 1 --yaw facing:1",
            "--yaw is \"facing:1\", needs a point x,y in m, for example facing:3,-1.5");
    refused("sample map -n 1 --yaw uphill:1", "needs uphill without anything after it");
    refused("sample map -n 1 --yaw sideways",
            "or random, or facing:X,Y, downhill, uphill, all:K, any:K, best:K, best:K:clearance or along");
    refused("sample map -n 1 --yaw best:9x:clearance",
            "--yaw is \"best:9x:clearance\", needs a number of headings, 1 .. 64, for example best:8:clearance");
    refused("sample map -n 1 --yaw best:8:margin",
            "--yaw is \"best:8:margin\", needs a number of headings, 1 .. 64, for example best:8 or best:8:clearance");
    refused("sample map -n 1 --yaw along:65", "needs a number of headings, 1 .. 64, for example along:8");
    for (const std::string command :
         {"sample map -n 1 --stance level", "search map -n 1", "raster map --dims 2 --step 4 -o x.csv"})
        refused(command + " --yaw best:4", "--yaw best:4 is only for robots at rest");
    const ProgramRun run = arena("raster map --dims 2 --settle --step 4 --yaw best:4" + husky_option);
    CHECK(run.status == 0);
    CHECK_THAT(run.out, Contains(",belly,valid_headings,ground\n"));
    CHECK_THAT(arena("raster map --dims 2 --settle --step 4 --yaw best:4:clearance" + husky_option).out,
               Contains(",valid_headings,ground,clearance\n"));
    CHECK_THAT(arena("sample map -n 1 --yaw best:4:clearance --format json" + husky_option).out,
               Contains("\"yaw\": \"best:4:clearance\""));
    CHECK_THAT(arena("sample map -n 1 --yaw along --format json" + husky_option).out,
               Contains("\"yaw\": \"along:16\""));
    CHECK(arena("heatmap map --yaw any:4 --step 2 -o x.svg" + husky_option).status == 0);
    CHECK_THAT(bytes_of(arena / "x.svg"), Contains("yaw any:4"));
}

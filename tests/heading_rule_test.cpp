#include "arena.h"
#include "test_map.h"

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
              "x,y,z,roll,pitch,yaw,layer,verdict,tilt,margin,tip_over,belly,valid_headings");
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

TEST_CASE("spawns have the headings of their rule, and are valid")
{
    const Judge judge(map_of(random_scene(9)), long_box());
    for (const HeadingRule& rule :
         {HeadingRule{.kind = Kind::Any, .count = 5}, HeadingRule{.kind = Kind::All, .count = 5},
          HeadingRule{.kind = Kind::Best, .count = 5}, HeadingRule{.kind = Kind::Downhill},
          HeadingRule{.kind = Kind::Facing, .x = 1, .y = 2}}) {
        CAPTURE(to_string(rule));
        SampleOptions options{.count = 60, .min_distance = 0.2, .heading = rule, .threads = 1};
        const SpawnList list = sample(judge, options);
        REQUIRE(list.spawns.size() >= 20);
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
    refused("sample map -n 1 --yaw sideways", "or random, or facing:X,Y, downhill, uphill, all:K, any:K or best:K");
    for (const std::string command :
         {"sample map -n 1 --stance level", "search map -n 1", "raster map --dims 2 --step 4 -o x.csv"})
        refused(command + " --yaw best:4", "--yaw best:4 is only for robots at rest");
    const ProgramRun run = arena("raster map --dims 2 --settle --step 4 --yaw best:4" + husky_option);
    CHECK(run.status == 0);
    CHECK_THAT(run.out, Contains(",belly,valid_headings\n"));
    CHECK(arena("heatmap map --yaw any:4 --step 2 -o x.svg" + husky_option).status == 0);
    CHECK_THAT(bytes_of(arena / "x.svg"), Contains("yaw any:4"));
}

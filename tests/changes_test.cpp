#include "catch.h"
#include "compare.h"
#include "temp_folder.h"
#include "test_map.h"

#include <spawnfield/bake.h>
#include <spawnfield/changes.h>
#include <spawnfield/error.h>
#include <spawnfield/frames.h>
#include <spawnfield/map_export.h>
#include <spawnfield/scene_parts.h>

#include <algorithm>
#include <cstdio>

using namespace spawnfield;

// A changed map gives the same answers, byte for byte, as the map that is baked from the changed scene.

namespace {

/// 100, or fewer where all would take many minutes.
const std::uint64_t change_count = compare::scene_count() / 3;

/// A scene before and after a random change.
struct RandomChange {
    Scene before, after, added;
    std::vector<std::string> removed;  ///< names
    std::vector<Pose> poses;
    Robot robot;
};

RandomChange random_change(std::uint64_t seed)
{
    Scene all = random_scene(seed);
    for (std::size_t part = 0; part < all.parts.size(); ++part) all.parts[part].name = "part-" + std::to_string(part);
    Random random{seed + 7000};
    std::vector<std::uint32_t> before, after, added;
    RandomChange out;
    const double adds = seed % 3 == 0 ? 0 : 0.3, removes = seed % 3 == 1 ? 0 : 0.3;
    for (std::uint32_t part = 0; part < all.parts.size(); ++part) {
        if (part > 0 && random.chance(adds)) {
            added.push_back(part);
            continue;
        }
        before.push_back(part);
        if (random.chance(removes))
            out.removed.push_back(all.parts[part].name);
        else
            after.push_back(part);
    }
    after.insert(after.end(), added.begin(), added.end());
    out.before = scene_of_parts(all, before);
    out.after = scene_of_parts(all, after);
    out.added = scene_of_parts(all, added);
    out.poses = random_poses(all, seed, 250);
    out.robot = random_robot(seed);
    return out;
}

Map changed(Map map, const RandomChange& change, int threads = 0)
{
    if (!change.removed.empty()) map = without_parts(map, change.removed, threads);
    return change.added.parts.empty() ? map : with_parts(map, change.added, threads);
}

/// The map of the scene before the change, and the options with which the scene after the change gets the same bounds.
struct BeforeAndAfter {
    Map before, after;
};

BeforeAndAfter bake_both(RandomChange& change, std::uint64_t seed)
{
    const BakeOptions options{
        .resolution = 0.25, .z = seed % 5 == 0 ? ZRange{-0.5, 2} : ZRange{}, .allow_no_terrain = true};
    BeforeAndAfter out;
    out.before = make_map(change.before, options);
    change.after.map_bounds = out.before.bounds;
    out.after = make_map(change.after, options);
    return out;
}

PoseTable table_of(const std::vector<Pose>& poses)
{
    std::string text = "x,y,z,roll,pitch,yaw\n";
    for (const Pose& pose : poses) {
        const Rpy rpy = rpy_from(pose.rotation);
        char row[200];
        std::snprintf(row, sizeof row, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", pose.position.x(), pose.position.y(),
                      pose.position.z(), rpy.roll, rpy.pitch, rpy.yaw);
        text += row;
    }
    return parse_poses(text, "poses");
}

std::string checked(const Map& map, const Robot& robot, const PoseTable& table, const RunOptions& run = {})
{
    return verdicts_csv(table, Judge(map, robot).check(table.poses, run), map);
}

std::string settled(const Map& map, const Robot& robot, const PoseTable& table, const RunOptions& run = {})
{
    const Judge judge(map, robot);
    return settled_csv(table, judge.settle(table.poses, run), judge);
}

/// Returns all spans, layers and water of a column in words.
std::string column_words(const Map& map, double x, double y)
{
    const Column column = column_at(map.geometry, x, y);
    std::string out;
    char text[100];
    for (const Span& span : column.spans) {
        std::snprintf(text, sizeof text, "%a %a %d %d ", span.bottom, span.top, span.terrain, span.sealed);
        out += text + map.geometry.parts()[span.part].name + "\n";
    }
    for (const double height : column.layers) out += "layer " + std::to_string(height);
    for (const double height : column.water) out += "water " + std::to_string(height);
    return out;
}

/// Returns a GLB file without the hash of the map.
std::string glb_of(Map map)
{
    map.hash.clear();
    std::string out;
    write_glb(map, {}, [&](std::string_view bytes) { out += bytes; });
    return out;
}

bool same_pages(const TerrainMap& a, const TerrainMap& b)
{
    return std::equal(a.pages.begin(), a.pages.end(), b.pages.begin(), b.pages.end(),
                      [](const auto& l, const auto& r) { return l.name == r.name && l.tiles == r.tiles; });
}

bool same_floors(const std::vector<Floor>& a, const std::vector<Floor>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Floor& l, const Floor& r) {
        return l.height == r.height && l.z == r.z && l.area == r.area && l.share == r.share;
    });
}

}  // namespace

TEST_CASE("after 100 random changes, columns, terrain and check are those of a new bake")
{
    std::size_t terrain_changes = 0, collisions = 0;
    for (std::uint64_t seed = 1; seed <= change_count; ++seed) {
        CAPTURE(seed);
        RandomChange change = random_change(seed);
        const auto [before, after] = bake_both(change, seed);
        const Map map = changed(before, change);
        CHECK(map.layers == after.layers);
        CHECK(map.geometry.element_count() == after.geometry.element_count());
        CHECK(map.geometry.bounds().min == after.geometry.bounds().min);
        CHECK(map.geometry.bounds().max == after.geometry.bounds().max);
        CHECK(same_pages(read_terrain(map), read_terrain(after)));
        CHECK(same_floors(floors_of(map), floors_of(after)));
        terrain_changes += map.layers != before.layers;
        for (const Pose& pose : change.poses)
            REQUIRE(column_words(map, pose.position.x(), pose.position.y()) ==
                    column_words(after, pose.position.x(), pose.position.y()));
        const PoseTable table = table_of(change.poses);
        const std::string csv = checked(map, change.robot, table);
        CHECK(csv == checked(after, change.robot, table));
        collisions += csv != checked(before, change.robot, table);
    }
    if (!compare::all_scenes()) return;
    CHECK(terrain_changes > 10);
    CHECK(collisions > 80);  // the changes mattered
}

TEST_CASE("after random changes, rasters are those of a new bake")
{
    for (std::uint64_t seed = 1; seed <= change_count; ++seed) {
        CAPTURE(seed);
        RandomChange change = random_change(seed);
        const auto [before, after] = bake_both(change, seed);
        const Map map = changed(before, change);
        const Judge judge(map, change.robot), expected(after, change.robot);
        const RasterOptions level{.step = 0.5};
        const RasterResult result = raster(judge, level), baked = raster(expected, level);
        CHECK(csv_of(result) == csv_of(baked));
        CHECK(result.exact_checks == baked.exact_checks);  // the masks are the same, too
        RasterOptions heights{.dims = 3, .step = 1.1, .step_z = 0.4};
        CHECK(csv_of(raster(judge, heights)) == csv_of(raster(expected, heights)));
        heights.height_check = false;
        CHECK(csv_of(raster(judge, heights)) == csv_of(raster(expected, heights)));
    }
}

TEST_CASE("after random changes, settled rasters are those of a new bake")
{
    for (std::uint64_t seed = 1; seed <= change_count; ++seed) {
        CAPTURE(seed);
        RandomChange change = random_change(seed);
        const auto [before, after] = bake_both(change, seed);
        const Map map = changed(before, change);
        const RasterOptions options{.step = 3.7, .stance = Stance::Settled, .yaw = 0.3};
        CHECK(csv_of(raster(Judge(map, change.robot), options)) == csv_of(raster(Judge(after, change.robot), options)));
        const PoseTable table = table_of({change.poses.begin(), change.poses.begin() + 10});
        CHECK(settled(map, change.robot, table) == settled(after, change.robot, table));
    }
}

TEST_CASE("after random changes, samples and searches are those of a new bake", "[slow]")
{
    const Robot robot = load_robot("box:0.3,0.2,0.2");  // fits in many places: samples end soon
    const Bounds box{{-4, -4, -10}, {4, 4, 10}};
    for (std::uint64_t seed = 1; seed <= change_count; ++seed) {
        CAPTURE(seed);
        RandomChange change = random_change(seed);
        const auto [before, after] = bake_both(change, seed);
        const Map map = changed(before, change);
        const Judge judge(map, robot), expected(after, robot);
        const SampleOptions level{
            .count = 25, .min_distance = 0.3, .seed = seed, .stance = Stance::Level, .bounds = box};
        const SpawnList found = sample(judge, level), baked = sample(expected, level);
        CHECK(spawns_csv(found) == spawns_csv(baked));
        CHECK((found.draws == baked.draws && found.is_full == baked.is_full));
        const SampleOptions rest{.count = 5, .min_distance = 0.5, .random_yaw = true, .seed = seed};
        CHECK(spawns_csv(sample(judge, rest)) == spawns_csv(sample(expected, rest)));
        SampleOptions placed{.count = 5, .seed = seed, .stance = Stance::Level};
        placed.place.near = {{change.after.parts.back().name, 0.1, 3}};
        placed.place.hidden_from = {{0, 0, 6}};
        CHECK(spawns_csv(sample(judge, placed)) == spawns_csv(sample(expected, placed)));
        const SearchOptions random{.count = 20, .min_distance = 0.2, .seed = seed, .max_failures = 1000};
        CHECK(spawns_csv(search(judge, random)) == spawns_csv(search(expected, random)));
    }
}

TEST_CASE("changes one after the other, and on maps of files, give the same answers")
{
    const TempFolder temp;
    const auto file = temp.write("scene.txt", "stands for the scene's file");
    for (std::uint64_t seed = 200; seed < 206; ++seed) {
        CAPTURE(seed);
        RandomChange change = random_change(seed);
        const auto [before, after] = bake_both(change, seed);
        const BakeOptions options{.resolution = 0.25, .z = before.z_limits, .allow_no_terrain = true};
        bake(change.before, file, temp / "map", options);
        Map map = read_map(temp / "map");
        for (std::uint32_t part = 0; part < change.added.parts.size(); ++part)
            map = with_parts(map, scene_of_parts(change.added, {part}));
        for (const std::string& name : change.removed) map = without_parts(map, {name});
        CHECK(map.changes.size() == change.added.parts.size() + change.removed.size());
        const PoseTable table = table_of(change.poses);
        CHECK(checked(map, change.robot, table) == checked(after, change.robot, table));
        CHECK(csv_of(raster(Judge(map, change.robot), {.step = 0.4})) ==
              csv_of(raster(Judge(after, change.robot), {.step = 0.4})));
        CHECK(same_pages(read_terrain(map), read_terrain(after)));
        CHECK(same_floors(floors_of(map), floors_of(after)));
        CHECK(map.layers == after.layers);
        CHECK(glb_of(map) == glb_of(after));
        const JudgeOptions voxels{.obstacles = Obstacles::Voxels};
        CHECK(csv_of(raster(Judge(map, change.robot, voxels), {.step = 1})) ==
              csv_of(raster(Judge(after, change.robot, voxels), {.step = 1})));
    }
}

TEST_CASE("a changed map gives the same bytes with 1, 2 and 8 threads")
{
    for (std::uint64_t seed = 300; seed < 306; ++seed) {
        RandomChange change = random_change(seed);
        const BeforeAndAfter maps = bake_both(change, seed);
        std::vector<std::string> results, hashes;
        for (const int threads : {1, 2, 8}) {
            const Map map = changed(maps.before, change, threads);
            const Judge judge(map, change.robot);
            const RasterOptions rest{.step = 2, .stance = Stance::Settled, .threads = threads};
            results.push_back(csv_of(raster(judge, {.step = 0.3, .threads = threads})) + csv_of(raster(judge, rest)));
            hashes.push_back(map.hash);
        }
        CHECK(results[0] == results[1]);
        CHECK(results[0] == results[2]);
        CHECK(hashes[0] == hashes[1]);
        CHECK(hashes[0] == hashes[2]);
    }
}

TEST_CASE("a crate that is added blocks its place, and removing it frees the place again")
{
    const Map map = training_map();
    const Robot robot = load_robot("box:0.4,0.4,0.4");
    const Pose pose{{-5, -5, 0.05}, Mat3::Identity()};
    REQUIRE(Judge(map, robot).check(pose).verdict == Verdict::Valid);
    Scene crate;
    crate.name = "extra";
    add_shape(crate, "crate", Label::Obstacle, {ShapeKind::Box, {1, 1, 1}, {{-5, -5, 0.5}, Mat3::Identity()}});
    const Map with = with_parts(map, crate);
    const Judge judge(with, robot);
    const Judgement judged = judge.check({{-5.6, -5, 0.05}, Mat3::Identity()});
    CHECK(judged.verdict == Verdict::Collision);
    CHECK(name_of(*judged.hit, with) == "crate");
    CHECK(judge.check({{-5.71, -5, 0.05}, Mat3::Identity()}).verdict == Verdict::Valid);
    CHECK(Judge(without_parts(with, {"CRA*"}), robot).check(pose).verdict == Verdict::Valid);
    CHECK(with.hash != map.hash);
    REQUIRE(with.changes.size() == 1);
    CHECK_THAT(with.changes[0], Catch::Matchers::StartsWith("with extra ("));
}

TEST_CASE("a robot as an obstacle is hit where a robot of the same shape is hit")
{
    const Map map = training_map();
    const Robot robot = random_robot(3);
    const Pose other{{-5, -5, 2}, rotation_from_rpy(0.1, 0.2, 0.7)};
    const Map with = with_parts(map, robot_as_obstacle(robot, other, "other"));
    const Judge judge(with, robot, {.max_height = 10});
    REQUIRE(Judge(map, robot, {.max_height = 10}).check(other).verdict == Verdict::Valid);
    CHECK(judge.check(other).verdict == Verdict::Collision);
    CHECK_THAT(name_of(*judge.check(other).hit, with), Catch::Matchers::StartsWith("other::"));
    CHECK(with.geometry.parts().size() == map.geometry.parts().size() + robot.parts.size());
}

TEST_CASE("changes that cannot be made are refused")
{
    const Map map = training_map();
    CHECK_THROWS_WITH(without_parts(map, {"nothing*"}),
                      Contains("\"nothing*\" matches no part of the map; there are floor, "));
    const Map less = without_parts(map, {"floor"});
    CHECK_THROWS_WITH(selection_of(less.geometry, {"floor"}, "on"), Contains("on \"floor\" matches no part"));
    Scene twice;
    add_shape(twice, "floor", Label::Obstacle, {ShapeKind::Box, {1, 1, 1}, {}});
    CHECK_THROWS_WITH(with_parts(map, twice), Contains("part \"floor\" exists in the map already"));
    CHECK_NOTHROW(with_parts(without_parts(map, {"floor"}), twice));
    CHECK_THROWS_AS(without_parts(without_parts(map, {"floor"}), {"floor"}), ArgumentError);
    Scene far;
    add_shape(far, "near", Label::Obstacle, {ShapeKind::Box, {1, 1, 1}, {}});
    add_shape(far, "far", Label::Obstacle, {ShapeKind::Box, {1, 1, 1}, {{100, 0, 0}, Mat3::Identity()}});
    CHECK(parts_off_map(far, map) == std::vector<std::string>{"far"});
}

#include "arena.h"
#include "catch.h"
#include "compare.h"
#include "scene_text.h"
#include "test_map.h"

#include "base/checksum.h"
#include "base/deflate.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>
#include <spawnfield/poses.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cmath>

using namespace spawnfield;

// Tests of which ground counts and how high the robot is above it: z limits, floors, --offset auto.

namespace {

using Json = nlohmann::json;

Scene tower_scene(const TempFolder& folder)
{
    // Three slabs of 20 x 10 m with their tops at 0, 3 and 6 m, the upper two half as wide; a ramp from 0 to 3 m.
    return load_parts(folder,
                      "  - {name: ground, label: terrain, box: [20, 10, 0.2], xyz: [0, 0, -0.1]}\n"
                      "  - {name: first, label: terrain, box: [10, 10, 0.2], xyz: [-5, 0, 2.9]}\n"
                      "  - {name: second, label: terrain, box: [10, 10, 0.2], xyz: [-5, 0, 5.9]}\n"
                      "  - {name: ramp, label: terrain, plane: [8, 2], xyz: [4, 0, 1.5], rpy: [0, 0.35877067, 0]}\n"
                      "  - {name: crate, label: obstacle, box: [1, 1, 1], xyz: [-5, 0, 3.5]}\n");
}

const Robot& small_box()
{
    static const Robot robot = load_robot("box:0.6,0.4,0.3");
    return robot;
}

TerrainMap terrain_of(const Map& map, double cell = 0.1)
{
    return rasterize_terrain(map.geometry, frame_around(map.bounds, cell), 1, {}, map.z_limits);
}

/// Returns the height of the layer on which a pose of a 2D raster stands.
double layer_height(const RasterPose& pose, const RasterResult& raster) { return pose.z - raster.offset; }

std::vector<RasterPose> filtered(const RasterResult& raster, const ZRange& z)
{
    std::vector<RasterPose> out;
    for (const RasterPose& pose : raster.poses)
        if (z.contains(layer_height(pose, raster), 1e-9)) out.push_back(pose);
    return out;
}

bool same_poses(const std::vector<RasterPose>& a, const std::vector<RasterPose>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const RasterPose& l, const RasterPose& r) {
        return l.x == r.x && l.y == r.y && l.z == r.z && l.verdict == r.verdict;
    });
}

}  // namespace

TEST_CASE("a 2D raster with a z range has exactly the poses whose layers are in the range, with the same verdicts")
{
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const HardCase hard = hard_case(seed);
        const TestMap map = compare::map_of_case(hard);
        const Judge judge(map, hard.robot);
        Random random{seed + 77};
        RasterOptions options{.step = std::max(1e-3, (map.bounds.max - map.bounds.min).head<2>().maxCoeff() / 23.7),
                              .offset = hard.offset,
                              .yaw = hard.yaws[0],
                              .threads = 1};
        const RasterResult all = raster(judge, options);
        const double low = map.bounds.min.z(), high = map.bounds.max.z();
        options.z.low = random.between(low, high);
        options.z.high = random.between(options.z.low, high);
        const RasterResult some = raster(judge, options);
        CAPTURE(seed, options.z.low, options.z.high);
        CHECK(same_poses(some.poses, filtered(all, options.z)));
        for (const RasterPose& pose : some.poses) CHECK(pose.layer >= 0);

        options.layers = {LayerChoice::Kind::Top, 0};
        for (const RasterPose& pose : raster(judge, options).poses) CHECK(pose.layer == 0);
    }
}

TEST_CASE("z limits of a map make poses beyond them outside, and change no other verdict")
{
    std::size_t outside = 0, inside = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const HardCase hard = hard_case(seed);
        TestMap map = compare::map_of_case(hard);
        JudgeOptions limits{.max_height = hard.max_height};
        const Judge judge(map, hard.robot, limits);
        Random random{seed + 3};
        std::vector<Pose> poses = random_poses(hard.scene, seed, 100);
        const std::vector<Pose> standing = compare::standing_poses(map, hard, compare::crop_near(map, random, 0.3, 14),
                                                                   100);
        poses.insert(poses.end(), standing.begin(), standing.end());
        const std::vector<Judgement> before = judge.check(poses, {.threads = 1});
        map.z_limits.low = random.between(map.bounds.min.z(), map.bounds.max.z());
        map.z_limits.high = map.z_limits.low + random.between(0, 2);
        for (const bool exhaustive : {false, true}) {
            limits.exhaustive = exhaustive;
            const std::vector<Judgement> after = Judge(map, hard.robot, limits).check(poses, {.threads = 1});
            for (std::size_t i = 0; i < poses.size(); ++i) {
                const bool is_out = !map.z_limits.contains(poses[i].position.z(), 1e-9);
                ++(is_out ? outside : inside);
                CAPTURE(seed, i, exhaustive);
                CHECK(after[i].verdict == (is_out ? Verdict::Outside : before[i].verdict));
            }
        }
    }
    CHECK(outside > 1000);
    CHECK(inside > 1000);
}

TEST_CASE("in a map with z limits a 3D raster and a search give the verdicts of check")
{
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const HardCase hard = hard_case(seed);
        TestMap map = compare::map_of_case(hard);
        Random random{seed + 5};
        RasterOptions options{.dims = 3,
                              .step = (map.bounds.max - map.bounds.min).head<2>().maxCoeff() / 6.3,
                              .step_z = std::max(0.01, (map.bounds.max.z() - map.bounds.min.z()) / 11.7),
                              .threads = 1};
        const double middle = random.between(map.bounds.min.z(), map.bounds.max.z());
        map.z_limits = {middle, middle + 4 * options.step_z};
        const Judge judge(map, hard.robot, {.max_height = hard.max_height}), exhaustive = without_mask(judge);
        const RasterResult result = raster(judge, options);
        VerdictCounts counts;
        for_each_pose(result, true, [&](const RasterPose& pose) {
            const Verdict wanted = verdict_in_raster(exhaustive, {{pose.x, pose.y, pose.z}, Mat3::Identity()});
            CAPTURE(seed, pose.x, pose.y, pose.z);
            CHECK(pose.verdict == wanted);
            ++counts[pose.verdict];
        });
        CHECK(counts == result.counts);

        const SearchOptions drawn{.count = 10, .bounds = map.bounds, .max_failures = 2000, .threads = 1};
        for (const Spawn& spawn : search(judge, drawn).spawns) CHECK(map.z_limits.contains(spawn.position.z(), 1e-9));
        const SpawnList quick = search(judge, drawn);
        CHECK(search(exhaustive, drawn).counts == quick.counts);
    }
}

TEST_CASE("spawns stand on layers within the z limits of the map, the query and the region")
{
    const TempFolder folder;
    TestMap map = map_of(tower_scene(folder));
    const Judge judge(map, small_box());
    SampleOptions options{.count = 400, .random_yaw = true, .stance = Stance::Level};
    const auto heights = [&] {
        std::map<double, int> out;
        for (const Spawn& spawn : sample(judge, options).spawns)
            ++out[std::round(10 * (spawn.position.z() - 0.1)) / 10];
        return out;
    };
    CHECK(heights().contains(0));
    CHECK(heights().contains(6));
    options.z = {2.5, 3.5};
    options.layers = {LayerChoice::Kind::Top, 0};
    for (const auto& [height, count] : heights()) CHECK((height >= 2.5 && height <= 3.5));
    CHECK(heights()[3] > 300);  // the top layer within the heights, though there is one above

    options.z = {};
    options.layers = {};
    options.area.within = {box_region(-10, -5, 0, 5, {2.9, 3.1}), box_region(0, -5, 10, 5, {-0.5, 0.5})};
    for (const Spawn& spawn : sample(judge, options).spawns)
        CHECK(std::abs(spawn.position.z() - 0.1 - (spawn.position.x() < 0 ? 3 : 0)) < 0.5);
    options.area = {};
    options.area.keep_out = {box_region(-10, -5, 10, 5, {-1, 5})};
    for (const Spawn& spawn : sample(judge, options).spawns) CHECK(spawn.position.z() > 5);

    options.area = {};
    map.z_limits = {2.5, 3.2};
    const SpawnList limited = sample(Judge(map, small_box()), options);
    REQUIRE(limited.spawns.size() == 400);
    for (const Spawn& spawn : limited.spawns) {
        CHECK(map.z_limits.contains(spawn.position.z(), 1e-9));
        CHECK(map.z_limits.contains(spawn.position.z() - 0.1, 1e-9));
    }
}

TEST_CASE("a sample with a z range is proven full, and dense probing finds no room")
{
    const TempFolder folder;
    TestMap map = map_of(tower_scene(folder));
    const Judge judge(map, small_box()), exhaustive = without_mask(judge);
    SampleOptions options{.count = 10000, .min_distance = 1.5, .stance = Stance::Level, .z = {2.5, 3.5}};
    const SpawnList list = sample(judge, options);
    CHECK(list.is_full);
    CHECK(list.undecided_area == 0);
    CHECK(list.spawns.size() > 20);
    for (double x = -10; x <= 0; x += 0.07)
        for (double y = -5; y <= 5; y += 0.07) {
            const Column column = column_at(map.geometry, x, y);
            for (const double layer : column.layers) {
                if (!options.z.contains(layer, 1e-9)) continue;
                const Vec3 p(x, y, layer + 0.1);
                const bool far = std::none_of(list.spawns.begin(), list.spawns.end(),
                                              [&](const Spawn& s) { return (s.position - p).norm() < 1.5; });
                if (far) CHECK_FALSE(exhaustive.is_valid({p, Mat3::Identity()}));
            }
        }
    options.z = {3.2, 5};  // contains only a crate and no ground
    const SpawnList none = sample(judge, options);
    CHECK(none.spawns.empty());
    CHECK(none.is_full);

    // Origins above the map's z limits are outside: no pose of the upper slab is valid.
    options.z = {};
    map.z_limits = {5, 6.05};
    const SpawnList outside = sample(Judge(map, small_box()), options);
    CHECK(outside.spawns.empty());
    CHECK(outside.is_full);
}

TEST_CASE("solid space beyond z limits still collides")
{
    const TempFolder folder;
    TestMap map = map_of(load_parts(folder,
                                    "  - {name: floor, label: terrain, box: [10, 10, 0.2], xyz: [0, 0, -0.1]}\n"
                                    "  - {name: beam, label: obstacle, box: [10, 1, 0.2], xyz: [0, 0, 1]}\n"));
    map.z_limits = {-0.5, 0.5};
    const Judge judge(map, load_robot("box:0.5,0.5,1"));
    CHECK(judge.check({{0, 0, 0.1}, Mat3::Identity()}).verdict == Verdict::Collision);
    CHECK(judge.check({{0, 3, 0.1}, Mat3::Identity()}).verdict == Verdict::Valid);
}

TEST_CASE("floors are the heights of the slabs of a tower, and a ramp belongs to the lower floor up to half its height")
{
    const TempFolder folder;
    const TestMap map = map_of(tower_scene(folder));
    const std::vector<Floor> floors = find_floors(terrain_of(map), 2);
    REQUIRE(floors.size() == 3);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(floors[std::size_t(k)].height - 3 * k) < 0.011);
    CHECK(std::abs(floors[0].z.high - 1.5) < 0.01);
    CHECK(floors[1].z.low > floors[0].z.high);
    CHECK(floors[1].z.low < floors[0].z.high + 1e-6);
    CHECK(std::isinf(floors[0].z.low));
    CHECK(std::isinf(floors[2].z.high));
    // The two lower floors share the ramp, half each. Ground with less than 1.5 m of height below the ramp is not
    // counted.
    const double run = 8 * std::cos(0.35877067), ramp = 2 * run;
    CHECK(std::abs(floors[2].area - 100) < 2);
    CHECK(std::abs(floors[1].area - (100 + ramp / 2)) < 3);
    CHECK(std::abs(floors[0].area - (200 - ramp / 2 + ramp / 2)) < 3);
    CHECK(std::abs(floors[0].share + floors[1].share + floors[2].share - 1) < 1e-12);
}

TEST_CASE("hills are one floor, terraces are several, and a map without ground has none")
{
    const TempFolder folder;
    const auto relief = [](double slope, double step) {
        TerrainMap terrain;
        terrain.frame = {0, 0, 0.5, 200, 200};
        std::vector<float> tile(256 * 256, std::nanf(""));
        for (int row = 0; row < 200; ++row)
            for (int col = 0; col < 200; ++col)
                tile[std::size_t(row * 256 + col)] = float(step * (col / 50) + slope * (row + 0.1 * col) +
                                                           std::sin(0.1 * col));
        terrain.pages.push_back({"height.0", {deflate_floats(tile, 256)}});
        return terrain;
    };
    CHECK(find_floors(relief(0.1, 0)).size() == 1);
    CHECK(find_floors(relief(0.1, 0))[0].share == 1);
    TerrainMap terraces = relief(0, 0);
    std::vector<float> tile(256 * 256, std::nanf(""));
    for (int row = 0; row < 200; ++row)
        for (int col = 0; col < 200; ++col) tile[std::size_t(row * 256 + col)] = 2.0f * float(col / 50);
    terraces.pages[0].tiles[0] = deflate_floats(tile, 256);
    const std::vector<Floor> floors = find_floors(terraces);
    REQUIRE(floors.size() == 4);
    CHECK(std::abs(floors[3].height - 6) < 0.011);
    CHECK(std::abs(floors[3].area - 2500) < 1);
    CHECK(find_floors(rasterize_terrain(Geometry(), {0, 0, 1, 3, 3})).empty());
}

TEST_CASE("the automatic offset puts the lowest point 0.1 m above the layer")
{
    CHECK(auto_offset(load_robot("box:0.99,0.67,0.39")) == 0.1);
    CHECK(auto_offset(husky()) == 0.1);
    CHECK(std::abs(auto_offset(load_robot("box:1,1,1@0,0,0.2")) - 0.4) < 1e-12);
    CHECK(std::abs(auto_offset(load_robot("box:1,1,1@0,0,2")) + 1.4) < 1e-12);
    CHECK(is_in_flat_ground(load_robot("box:1,1,1@0,0,0.2"), 0.3));
    CHECK_FALSE(is_in_flat_ground(load_robot("box:1,1,1@0,0,0.2"), 0.31));

    const TestMap map = training_map();
    const Judge sunk(map, load_robot("box:0.99,0.67,0.39@0,0,0.095"));
    SampleOptions options{.count = 50, .stance = Stance::Level};
    for (const Spawn& spawn : sample(sunk, options).spawns) CHECK(spawn.position.z() > 0.1);
    CHECK(raster(sunk, {}).offset == auto_offset(sunk.robot()));
    options.offset = 1.1;
    CHECK_THROWS_WITH(sample(sunk, options),
                      "sample: offset is 1.1, needs at most max_height, 1 m: such poses are aerial");
}

TEST_CASE("with the same options, check finds every pose of sample valid")
{
    const Arena arena;
    arena.write("rover.yaml",
                "format: spawnfield-robot/1\nname: rover\nparts:\n  - {box: [0.6, 0.4, 0.3], xyz: [0, 0, 0.05]}\n");
    for (const char* const options :
         {"--offset auto", "--offset 0.3", "--max-height 0.4", "--max-height 2 --offset 1.5", "--max-water-depth 0.2",
          "--max-slope 5", "--max-slope 20 --offset 0.2", "--collision octree", "--exhaustive",
          "--collision octree --max-water-depth 0.1 --max-height 0.3"}) {
        const std::string common = std::string("map --robot rover.yaml ") + options;
        CAPTURE(options);
        const ProgramRun drawn = arena("sample " + common +
                                       " --stance level -n 60 --yaw random --min-distance 0.3 -o spawns.csv");
        INFO(drawn.err);
        REQUIRE(drawn.status == 0);
        std::string of_check = common;  // without --offset, which check does not have
        if (const std::size_t at = of_check.find("--offset"); at != std::string::npos) {
            const std::size_t end = of_check.find(' ', at + 9);
            of_check.erase(at, end == std::string::npos ? end : end - at);
        }
        const ProgramRun checked = arena("check " + of_check + " --poses spawns.csv --summary s.json -o verdicts.csv");
        INFO(checked.err);
        REQUIRE(checked.status == 0);
        CHECK(Json::parse(bytes_of(arena / "s.json"))["counts"]["valid"] == 60);
    }
}

TEST_CASE("all commands respect --z and --floor, so a picture or a map of one floor needs one command")
{
    const TempFolder folder;
    const auto run = [&](const std::string& arguments) { return run_program(folder, arguments); };
    REQUIRE(run("bake '" + source_folder() + "/maps/storeys/scene.yaml' -o map --resolution 0.2").status == 0);
    const Json info = Json::parse(run("info map --json").out);
    REQUIRE(info["floors"].size() == 3);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(info["floors"][std::size_t(k)]["height"].get<double>() - 3 * k) < 0.011);
    CHECK_THAT(run("info map").out, Contains("  1: at 3 m, ") && Contains("--floor K selects one"));

    const std::string robot = " map" + husky_option;
    const auto heights = [&](const std::string& file) {
        std::vector<double> out;
        for (const Pose& pose : read_poses(folder / file).poses) out.push_back(pose.position.z());
        return out;
    };
    REQUIRE(run("sample" + robot + "-n 60 --stance level --floor 1 -o floor.csv").status == 0);
    for (const double z : heights("floor.csv")) CHECK((z > 1.5 && z < 4.6));
    REQUIRE(run("sample" + robot + "-n 60 --stance level --z 2.9:3.1 -o z.csv").status == 0);
    for (const double z : heights("z.csv")) CHECK((z > 2.99 && z < 3.21));
    REQUIRE(run("sample" + robot + "-n 60 --stance level --region=-15,-8,2.9,15,8,3.1 -o box.csv").status == 0);
    CHECK(bytes_of(folder / "box.csv") == bytes_of(folder / "z.csv"));
    REQUIRE(run("raster" + robot + "--dims 2 --step 0.5 --floor 2 -o raster.csv").status == 0);
    for (const double z : heights("raster.csv")) CHECK(z > 4.5);
    REQUIRE(run("raster" + robot + "--dims 2 --step 0.5 --bounds=-15,-8,2.9,15,8,3.1 -o six.csv").status == 0);
    REQUIRE(run("raster" + robot + "--dims 2 --step 0.5 --bounds=-15,-8,15,8 --z 2.9:3.1 -o four.csv").status == 0);
    CHECK(bytes_of(folder / "six.csv") == bytes_of(folder / "four.csv"));
    for (const double z : heights("six.csv")) CHECK((z > 2.99 && z < 3.21));
    CHECK(run("heatmap" + robot + "--step 0.2 --floor 1 -o floor.png").status == 0);
    CHECK(run("export" + robot + "--format nav2 --floor 1 --resolution 0.5 -o floor.yaml").status == 0);
    CHECK_THAT(bytes_of(folder / "floor.yaml"), Contains("(top, floor 1 at 3 m)"));
    CHECK(run("export" + robot + "--format nav2 --z 2.9:3.1 --resolution 0.5 -o deck.yaml").status == 0);
    CHECK(run("export map --format geotiff --floor 1 --resolution 0.5 -o floor.tif").status == 0);
    CHECK(run("search" + robot + "-n 5 --z 2.9:3.4 -o search.csv").status == 0);
    for (const double z : heights("search.csv")) CHECK((z >= 2.9 && z <= 3.4));

    const std::pair<std::string, std::string> refusals[] = {
        {"--floor 3", "--floor is 3; the map has 3 floors: 0 at 0 m, 1 at 3 m, 2 at 6 m"},
        {"--floor 1 --z 0:2", "--floor and --z (or six numbers for a box) both limit heights; give one of them"},
        {"--z 2", "--z is \"2\", needs LOW:HIGH in m, for example 5:8 or 5:"},
        {"--z 3:2", "--z is \"3:2\"; give the lower height first"},
        {"--z 0:2 --region=0,0,0,1,1,1", "--z and the six numbers of --region both limit heights; give one of them"},
        {"--stance level --offset up", "--offset: \"up\""}};
    for (const auto& [options, message] : refusals) {
        const ProgramRun refused = run("sample" + robot + "-n 1 " + options);
        CHECK(refused.status == 2);
        CHECK_THAT(refused.err, Contains(message));
    }
    CHECK(run("raster" + robot + "--dims 3 --step 1 --floor 1").status == 2);
}

TEST_CASE("z limits of a bake apply in every command")
{
    const TempFolder folder;
    const auto run = [&](const std::string& arguments) { return run_program(folder, arguments); };
    const std::string scene = "bake '" + source_folder() + "/maps/storeys/scene.yaml' --resolution 0.2 ";
    REQUIRE(run(scene + "-o map --bounds=-15,-8,2.5,15,8,5").status == 0);
    REQUIRE(run(scene + "-o same --z 2.5:5").status == 0);
    const Json info = Json::parse(run("info map --json").out);
    CHECK(info["z_limits"] == Json({2.5, 5.0}));
    CHECK(info["floors"].size() == 1);
    const std::string robot = " map" + husky_option;
    REQUIRE(run("sample" + robot + "-n 100 --stance level -o spawns.csv").status == 0);
    for (const Pose& pose : read_poses(folder / "spawns.csv").poses)
        CHECK((pose.position.z() > 2.5 && pose.position.z() < 5));
    REQUIRE(run("sample same" + husky_option + "-n 100 --stance level -o other.csv").status == 0);
    CHECK(bytes_of(folder / "spawns.csv") == bytes_of(folder / "other.csv"));
    folder.write("poses.csv", "x,y,z\n-3,-5,3.1\n-3,-5,0.1\n-3,3,6.1\n");
    CHECK_THAT(run("check" + robot + "--poses poses.csv").out,
               Contains("3.1,valid") && Contains("0.1,outside") && Contains("6.1,outside"));
    REQUIRE(run("export" + robot + "--format nav2 --stance level --resolution 0.5 -o limited.yaml").status == 0);
    REQUIRE(run(scene + "-o whole").status == 0);
    REQUIRE(run("export whole" + husky_option + "--format nav2 --stance level --z 2.5:5 --resolution 0.5 -o whole.yaml")
                .status == 0);
    // The same picture, except that an origin above 5 m (on the upper end of the ramp) is outside the map, and so
    // unknown.
    const std::string limited = bytes_of(folder / "limited.pgm"), whole = bytes_of(folder / "whole.pgm");
    REQUIRE(limited.size() == whole.size());
    std::size_t outside = 0;
    for (std::size_t i = 0; i < limited.size(); ++i) {
        if (limited[i] == whole[i]) continue;
        CHECK(std::uint8_t(limited[i]) == 205);
        ++outside;
    }
    CHECK(outside > 0);
    CHECK(outside < 30);

    REQUIRE(run(scene + "-o upper --z 5:").status == 0);
    CHECK(Json::parse(run("info upper --json").out)["z_limits"] == Json({5.0, nullptr}));
    CHECK(run(scene + "-o both --z 5: --bounds=-15,-8,2.5,15,8,5").status == 2);
    CHECK(run(scene + "-o off --z 50:60").status == 4);
}

TEST_CASE("a map of format version 2 is read: it has no z limits, and its floors are found again")
{
    const TempFolder folder;
    REQUIRE(
        run_program(folder, "bake '" + source_folder() + "/maps/storeys/scene.yaml' -o map --resolution 0.2").status ==
        0);
    std::string yaml = bytes_of(folder / "map/map.yaml");
    const std::size_t floors = yaml.find("# from the lowest up"), after = yaml.find("terrain:  #");
    REQUIRE(floors < after);
    yaml.erase(floors, after - floors);
    yaml.replace(yaml.find("spawnfield-map/9"), 16, "spawnfield-map/2");
    yaml.erase(yaml.rfind("hash: "));
    folder.write("map/map.yaml", yaml + "hash: \"" + checksum(yaml) + "\"\n");
    const Map map = read_map(folder / "map");
    CHECK_FALSE(map.floors.has_value());
    CHECK(map.z_limits.is_unlimited());
    CHECK(floors_of(map).size() == 3);
    CHECK(run_program(folder, "sample map" + husky_option + "-n 5 --floor 2").status == 0);
}

TEST_CASE("the offset is chosen automatically, and an impossible one ends at once with status 3")
{
    const Arena arena;
    arena.write("tall.yaml", "format: spawnfield-robot/1\nname: tall\nparts:\n  - {box: [0.6, 0.4, 0.8]}\n");
    const ProgramRun found = arena("sample map --robot tall.yaml -n 5 --stance level --summary s.json -o spawns.csv");
    CHECK(found.status == 0);
    CHECK_THAT(found.err, Contains("offset 0.5 m (auto)"));
    CHECK(Json::parse(bytes_of(arena / "s.json"))["offset"] == 0.5);
    const std::string why =
        "at --offset 0.1 m the robot collides with all flat ground: its lowest point is 0.4 m below its origin; give "
        "--offset auto, which is 0.5 m";
    for (const char* const command :
         {"sample map -n 5 --stance level -o none.csv", "raster map --dims 2 --step 1 -o none_raster.csv",
          "heatmap map --stance level -o none.png", "export map --format nav2 --stance level -o none.yaml",
          "export map --format ply --stance level --step 1 -o none.ply"}) {
        const ProgramRun run = arena(std::string(command) + " --robot tall.yaml --offset 0.1");
        CAPTURE(command);
        CHECK(run.status == 3);
        CHECK_THAT(run.err, Contains(why));
    }
    CHECK(bytes_of(arena / "none.csv") == "x,y,z,roll,pitch,yaw\n");
    for (const char* const file : {"none_raster.csv", "none.png", "none.yaml", "none.ply"})
        CHECK_FALSE(std::filesystem::exists(arena / file));

    for (const char* const command :
         {"sample map -n 5 --stance level", "raster map --dims 2 --step 1", "heatmap map --stance level -o none.png",
          "export map --format nav2 --stance level -o none.yaml"}) {
        const ProgramRun run = arena(std::string(command) + " --robot tall.yaml --offset 1.2");
        CAPTURE(command);
        CHECK(run.status == 2);
        CHECK_THAT(run.err, Contains("--offset is 1.2 m, needs at most --max-height, 1 m: `check` calls higher poses "
                                     "aerial; give --max-height 1.2 or more"));
    }
    CHECK(arena("sample map -n 5 --stance level --robot box:0.3,0.3,0.3@0,0,-1.5").status == 2);  // auto is 1.75 m
    CHECK(
        arena("sample map -n 5 --robot box:0.3,0.3,0.3@0,0,-1.5 --max-height 1.75 --stance level -o high.csv").status ==
        0);
}

TEST_CASE("the preview of a world with roofs has a picture of each floor")
{
    const TempFolder folder;
    const auto preview_of = [&](const std::string& map) {
        return cv::imread((folder / (map + "/preview.png")).string());
    };
    const auto bake_parts = [&](const std::string& name, const std::string& parts) {
        folder.write(name + ".yaml", "format: spawnfield-scene/1\nname: test\nparts:\n" + parts);
        REQUIRE(run_program(folder, "bake " + name + ".yaml -o " + name + " --resolution 0.2").status == 0);
    };
    const std::string floor =
        "  - {name: floor, label: terrain, box: [20, 10, 0.2], xyz: [0, 0, -0.1]}\n  - {name: crate, label: obstacle, "
        "box: [2, 2, 1], xyz: [3, 0, 0.5]}\n";
    bake_parts("open", floor);
    bake_parts("roofed", floor + "  - {name: roof, label: obstacle, box: [20, 10, 0.2], xyz: [0, 0, 5]}\n");
    bake_parts("two", floor + "  - {name: upper, label: terrain, box: [20, 10, 0.2], xyz: [0, 0, 3.9]}\n");
    const cv::Mat open = preview_of("open"), roofed = preview_of("roofed"), two = preview_of("two");
    // The roof is cut away, so the picture with the roof shows the same floor and crate as the open one, under another
    // title.
    REQUIRE(open.size() == roofed.size());
    const cv::Rect plot(0, 150, open.cols * 3 / 4, open.rows / 2);
    cv::Mat difference;
    cv::absdiff(open(plot), roofed(plot), difference);
    CHECK(cv::mean(difference)[0] < 4);
    CHECK(two.cols > 1.5 * two.rows);  // two pictures side by side
}

#include "arena.h"
#include "test_map.h"

#include <spawnfield/memory.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <thread>

using namespace spawnfield;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::string complaint_of(const MemoryNeed& need, double cell, double area, double limit)
{
    try {
        require_cell_memory(need, "--step", cell, area, limit);
        return "";
    } catch (const MemoryError& error) {
        return error.what();
    }
}

/// Returns the size in "…; 0.12 m would fit".
double fitting(const std::string& complaint)
{
    const std::size_t at = complaint.find("; ");
    return at == std::string::npos ? NAN : std::stod(complaint.substr(at + 2));
}

std::string far_scene(double x, double y)
{
    const std::string at = "xyz: [" + std::to_string(x) + ", " + std::to_string(y) + ", ";
    return "format: spawnfield-scene/1\nname: far\nparts:\n- {name: floor, label: terrain, box: [30, 20, 1], " + at +
           "-0.5]}\n- {name: crate, label: obstacle, box: [1, 1, 2], " + at + "1]}\n";
}

}  // namespace

TEST_CASE("cells that need too much memory are refused, and the size that would fit does fit")
{
    const MemoryNeed need{1e8, 20};
    CHECK(complaint_of(need, 0.05, 2500, infinite).empty());
    CHECK(complaint_of(need, 0.05, 2500, 1.2e8 + 1).empty());  // a million cells
    const std::string words = complaint_of(need, 0.001, 1.5e6, 8e9);
    CHECK(words.starts_with("needs about 3e+04 GB of memory at 0.001 m (--step), the limit is 8 GB (--max-memory); "));
    for (const double limit : {1.2e8, 2e8, 1e9, 8e9, 7.7e10})
        for (const double area : {1e4, 1.5e6, 3e8}) {
            const std::string complaint = complaint_of(need, 1e-4, area, limit);
            const double size = fitting(complaint);
            REQUIRE(size > 0);
            CHECK(complaint_of(need, size, area, limit).empty());
            CHECK(!complaint_of(need, size * 0.85, area, limit).empty());  // it is rounded to two digits only
        }
    CHECK_THAT(complaint_of(need, 1, 1, 5e7), Contains("and 100 MB are for the scene alone"));
}

TEST_CASE("the memory that is available is some of what the machine has")
{
    std::ifstream file("/proc/meminfo");
    std::string name;
    double total = 0;
    file >> name >> total;
    REQUIRE(name == "MemTotal:");
    CHECK(available_memory() > 1e6);
    CHECK(available_memory() < total * 1024);
}

TEST_CASE("a map that needs more memory than the limit is refused before the work")
{
    const Scene scene = load_scene(source_folder() + "/maps/training/scene.yaml");
    CHECK_THROWS_AS(make_map(scene, {.resolution = 0.01, .max_memory = 8.5e7}), MemoryError);
    CHECK_NOTHROW(make_map(scene, {.resolution = 0.5, .max_memory = 1e9}));
    const Arena arena;
    const ProgramRun bake = arena("bake " + training_scene + " -o map --resolution 0.01 --max-memory 100MB");
    CHECK(bake.status == 1);
    CHECK_THAT(bake.err,
               Contains("spawnfield: needs about 162 MB of memory at 0.01 m (--resolution), the limit is 100 MB"));
    CHECK(run_program(arena, "info map --verify").status == 0);
    const ProgramRun raster = arena("raster map --dims 2 --step 0.01 --adaptive --max-memory 0.1GB" + husky_option);
    CHECK(raster.status == 1);
    CHECK_THAT(raster.err, Contains("at 0.01 m (--step), the limit is 100 MB (--max-memory); "));
    const ProgramRun little = arena("info map --max-memory 99MB");
    CHECK(little.status == 2);
    CHECK_THAT(little.err, Contains("--max-memory is \"99MB\", needs at least 100 MB for the program itself"));
    const ProgramRun size = arena("info map --max-memory banana");
    CHECK(size.status == 2);
    CHECK_THAT(size.err, Contains("--max-memory is \"banana\", needs a size > 0, for example 8GB or 500MB"));
}

TEST_CASE("a map in the coordinates of a survey has voxels of the usual size, and the verdicts of the same map at home")
{
    const TempFolder folder;
    const double x = 500'000, y = 4'000'000;
    folder.write("home.yaml", far_scene(0, 0));
    folder.write("far.yaml", far_scene(x, y));
    CHECK(run_program(folder, "bake home.yaml -o home -q").status == 0);
    const ProgramRun bake = run_program(folder, "bake far.yaml -o far");
    CHECK(bake.status == 0);
    CHECK(bake.err.find("notice") == std::string::npos);
    const Map home = read_map(folder / "home"), far = read_map(folder / "far");
    CHECK(bytes_of(folder / "home/map.yaml").starts_with("format: spawnfield-map/9\n"));
    CHECK(bytes_of(folder / "far/map.yaml").starts_with("format: spawnfield-map/9\n"));
    CHECK(far.occupancy_resolution == 0.25);
    CHECK(home.occupancy_origin == Vec3(0, 0, 0));
    CHECK((far.occupancy_origin - Vec3(x, y, 0)).norm() < 100);
    const OccupancyTree at_home = read_occupancy(home), there = read_occupancy(far);
    CHECK(at_home.leaves() > 100);
    std::size_t occupied = 0;
    for (double dx = -15.125; dx < 15; dx += 0.25)
        for (double dy = -10.125; dy < 10; dy += 0.25)
            for (const double z : {-0.125, 0.125, 1.125, 2.125}) {
                const OccupancyTree::State state = at_home.at({dx, dy, z});
                occupied += state == OccupancyTree::State::Occupied;
                REQUIRE(there.at({x + dx, y + dy, z}) == state);
            }
    CHECK(occupied > 1000);
    folder.write("home.csv", "x,y,z\n0.8,0,0.5\n1.2,0,0.5\n5,5,0.5\n");
    folder.write("far.csv", "x,y,z\n500000.8,4000000,0.5\n500001.2,4000000,0.5\n500005,4000005,0.5\n");
    for (const std::string collision : {"geometry", "octree"}) {
        const auto verdicts = [&](const std::string& name) {
            return column_of(parse_poses(run_program(folder, "check " + name + " --robot box:1,0.5,0.5 --poses " +
                                                                 name + ".csv --collision " + collision)
                                             .out,
                                         name),
                             "verdict");
        };
        CHECK(verdicts("far") == verdicts("home"));
        CHECK(verdicts("far") ==
              std::vector<std::string>{"collision", collision == "octree" ? "collision" : "valid", "valid"});
    }
    const std::string update = "bake far.yaml -o far --update '*' -q";
    CHECK(run_program(folder, update).status == 0);
    CHECK(read_map(folder / "far").hash == far.hash);
}

TEST_CASE("a part far away from all others is named, and refused with --strict")
{
    const TempFolder folder;
    const auto scene_with = [&](const std::string& parts) {
        return folder.write("scene.yaml", far_scene(0, 0) + parts);
    };
    const auto strays = [&](const std::string& parts) {
        std::string out;
        for (const std::string& text : load_scene(scene_with(parts)).notices)
            if (text.find("from the rest of the world") != std::string::npos) out += text;
        return out;
    };
    CHECK(strays("").empty());
    CHECK(strays("- {name: near, label: obstacle, box: [1, 1, 1], xyz: [3500, 0, 0]}\n").empty());
    const std::string lost = "- {name: lost, label: obstacle, box: [1, 1, 1], xyz: [343582, 0, 0]}\n";
    CHECK_THAT(strays(lost), Contains("part \"lost\" is 343566 m away from the rest of the world, which is 36.18"));
    CHECK_THAT(strays(lost + "- {name: other, label: obstacle, box: [1, 1, 1], xyz: [0, -99999, 0]}\n"),
               Contains("part \"lost\" is") && Contains("(and 1 more parts)"));
    CHECK_THROWS_WITH(
        load_scene(scene_with(lost), {.strict = true}),
        Contains("scene.yaml: part \"lost\" is 343566 m away") && Contains("--strict does not allow this"));
}

TEST_CASE("a map that is replaced again and again while it is read is the old one or the new one")
{
    const TempFolder folder;
    const auto file = folder.write("a.yaml", far_scene(0, 0));
    const auto other = folder.write("b.yaml", far_scene(3, 0));
    const Scene a = load_scene(file), b = load_scene(other);
    const BakeOptions options{.resolution = 0.5, .threads = 1};
    const std::string hash_a = bake(a, file, folder / "a", options).hash,
                      hash_b = bake(b, other, folder / "b", options).hash;
    REQUIRE(hash_a != hash_b);
    bake(a, file, folder / "map", options);
    std::atomic<bool> is_done{false};
    std::thread baking([&] {
        for (int i = 0; !is_done; ++i) bake(i % 2 == 0 ? b : a, i % 2 == 0 ? other : file, folder / "map", options);
    });
    std::size_t from_b = 0, reads = 0;
    std::string failure;
    try {
        const auto has_seen_both = [&] { return from_b > 0 && from_b < reads; };
        for (; (reads < 300 || (!has_seen_both() && reads < 100'000)) && failure.empty(); ++reads) {
            const Map map = read_map(folder / "map");
            const bool is_b = map.hash == hash_b;
            from_b += is_b;
            const double x = is_b ? 3 : 0;
            const TerrainMap terrain = read_terrain(map);
            const OccupancyTree tree = read_occupancy(map);
            if (map.hash != hash_a && !is_b) failure = "another hash";
            if (terrain.frame.x0 != x - 15) failure = "terrain of another map";
            if (tree.at({x - 14.9, 0, -0.1}) != OccupancyTree::State::Occupied ||
                tree.at({x - 16.5, 0, -0.1}) != OccupancyTree::State::Unknown)
                failure = "occupancy of another map";
        }
    } catch (const std::exception& error) {
        failure = error.what();
    }
    is_done = true;
    baking.join();
    CHECK(failure == "");
    CHECK(reads >= 300);
    CHECK(from_b > 0);
    CHECK(from_b < reads);
}

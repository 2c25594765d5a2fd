#include "arena.h"
#include "test_map.h"

#include <spawnfield/poses.h>
#include <spawnfield/thesis.h>

#include <Eigen/LU>

#include <sstream>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

/// Returns the numbers of lines "x, y, z", converted back to our frame.
std::vector<Vec3> locations(const fs::path& file)
{
    std::istringstream stream(bytes_of(file));
    std::vector<Vec3> out;
    double x = 0, y = 0, z = 0;
    char comma = 0;
    while (stream >> x >> comma >> y >> comma >> z) out.push_back({x, z, y});
    return out;
}

std::vector<Vec3> poses_of(const RasterResult& raster, bool aerial, const std::set<Verdict>& verdicts)
{
    std::vector<Vec3> out;
    for_each_pose(raster, aerial, [&](const RasterPose& pose) {
        if (verdicts.contains(pose.verdict)) out.push_back({pose.x, pose.y, pose.z});
    });
    return out;
}

std::string value_of(const std::string& text, const std::string& name)
{
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        if (line.starts_with(name + ": ")) return line.substr(name.size() + 2);
    return "no " + name;
}

}  // namespace

TEST_CASE("Unity's frame is left-handed with y up")
{
    CHECK(unity_from({1, 2, 3}) == Vec3(1, 3, 2));
    Mat3 unity_axes;
    for (int axis = 0; axis < 3; ++axis) unity_axes.col(axis) = unity_from(Vec3::Unit(axis));
    CHECK(unity_axes.determinant() == -1);  // the handedness changes
    const TempFolder folder;
    SpawnList list;
    list.spawns = {{{1.5, -2.25, 0.125}, 0.3}};
    write_thesis_locations(folder.path(), list);
    CHECK(bytes_of(folder / "Valid_Locations.txt") == "1.5, 0.125, -2.25\n");
    CHECK(bytes_of(folder / "Invalid_Locations.txt").empty());
    CHECK(names_in(folder.path()) == std::set<std::string>{"Valid_Locations.txt", "Invalid_Locations.txt"});
}

TEST_CASE("in the terms of the thesis valid is valid, aerial and off_terrain are aerial, and all others are invalid")
{
    const std::map<Verdict, ThesisClass> classes = {
        {Verdict::Outside, ThesisClass::Invalid},    {Verdict::Aerial, ThesisClass::Aerial},
        {Verdict::OffTerrain, ThesisClass::Aerial},  {Verdict::Submerged, ThesisClass::Invalid},
        {Verdict::Collision, ThesisClass::Invalid},  {Verdict::Steep, ThesisClass::Invalid},
        {Verdict::Unstable, ThesisClass::Invalid},   {Verdict::Valid, ThesisClass::Valid},
        {Verdict::Obstructed, ThesisClass::Invalid}, {Verdict::Unreachable, ThesisClass::Invalid},
    };
    CHECK(classes.size() == verdict_count);  // every verdict is there
    for (const auto& [verdict, expected] : classes) CHECK(thesis_class_of(verdict) == expected);
}

TEST_CASE("locations of rasters are read back as the same poses, class by class, with and without aerial poses")
{
    std::uint64_t steep = 0, unstable = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const TestMap map = seed == 1 ? training_map() : map_of(random_scene(seed));
        JudgeOptions limits;
        if (seed % 2 == 1) limits.max_slope = 0.1;
        const Judge judge(map, husky(), limits);
        for (const int dims : {2, 3}) {
            RasterOptions options{.dims = dims};
            options.step = 0.7 + 0.01 * double(seed);  // numbers with many digits
            options.snap = dims == 3 && seed % 2 == 0;
            const RasterResult result = raster(judge, options);
            const TempFolder folder;
            const ThesisCounts with_air = write_thesis_locations(folder.path(), result, true);
            CHECK(locations(folder / "Valid_Locations.txt") == poses_of(result, true, {Verdict::Valid}));
            CHECK(locations(folder / "Invalid_Locations.txt") ==
                  poses_of(
                      result, true,
                      {Verdict::Outside, Verdict::Submerged, Verdict::Collision, Verdict::Steep, Verdict::Unstable}));
            CHECK(locations(folder / "Air_Locations.txt") ==
                  poses_of(result, true, {Verdict::Aerial, Verdict::OffTerrain}));
            CHECK(with_air[std::size_t(ThesisClass::Aerial)] ==
                  result.counts[Verdict::Aerial] + result.counts[Verdict::OffTerrain]);
            steep += result.counts[Verdict::Steep];
            unstable += result.counts[Verdict::Unstable];
            const TempFolder other;
            const ThesisCounts without = write_thesis_locations(other.path(), result, false);
            CHECK(without == ThesisCounts{with_air[0], with_air[1], 0});
            CHECK_FALSE(fs::exists(other / "Air_Locations.txt"));
            for (const char* const name : {"Valid_Locations.txt", "Invalid_Locations.txt"})
                CHECK(bytes_of(other / name) == bytes_of(folder / name));
        }
    }
    CHECK((steep > 0 && unstable > 0));
}

TEST_CASE("raster --format thesis writes a folder whose counts are those of the summary")
{
    const Arena arena;
    const std::string command = "raster map --dims 3 --step 1 --step-z 0.5 --format thesis -o out" + husky_option;
    const ProgramRun run = arena(command + "--write-aerial");
    CHECK(run.status == 0);
    CHECK(run.out.empty());
    CHECK(names_in(arena / "out") == std::set<std::string>(thesis_files.begin(), thesis_files.end()));
    const std::string stats = bytes_of(arena / "out/Stats.txt"), times = bytes_of(arena / "out/RunTime.txt");
    std::size_t lines = 0;
    for (const char* const name : {"Valid", "Invalid", "Air"}) {
        const std::string file = std::string(name) + "_Locations.txt";
        const std::size_t count = locations(arena / "out" / file).size();
        CHECK(count > 0);
        CHECK(value_of(stats, "Lines of " + file) == std::to_string(count));
        CHECK(value_of(stats, name == std::string("Air") ? "Aerial" : name) == std::to_string(count));
        lines += count;
    }
    CHECK(value_of(stats, "Judged") == std::to_string(lines));
    CHECK(lines == 21 * 21 * 13);
    CHECK(value_of(stats, "Command") == "raster");
    CHECK(value_of(stats, "Step z (m)") == "0.5");
    CHECK(value_of(stats, "Robot") == "husky");
    CHECK(value_of(stats, "Map hash") == read_map(arena / "map").hash);
    CHECK(std::stod(value_of(stats, "Verdict valid")) > 0);
    CHECK(std::stod(value_of(times, "Load (s)")) + std::stod(value_of(times, "Query (s)")) <=
          std::stod(value_of(times, "Total (s)")));

    CHECK(arena(command).status == 0);  // replaces its own result
    CHECK_FALSE(fs::exists(arena / "out/Air_Locations.txt"));
    CHECK(value_of(bytes_of(arena / "out/Stats.txt"), "Aerial") == value_of(stats, "Aerial"));
    CHECK(arena.names() == std::set<std::string>{"map", "out"});
    const ProgramRun flat = arena("raster map --dims 2 --step 1 --format thesis --write-aerial -o out" + husky_option);
    CHECK(flat.status == 0);
    CHECK(fs::exists(arena / "out/Air_Locations.txt"));
}

TEST_CASE("search and sample write their spawns as valid locations, and report what they do not store")
{
    const Arena arena;
    for (const std::string command : {"sample", "search"}) {
        const std::string query = command + " map -n 7 --min-distance 0.3 --seed 5" + husky_option;
        CHECK(arena(query + "-o spawns.csv").status == 0);
        CHECK(arena(query + "--format thesis -o " + command).status == 0);
        std::vector<Vec3> expected;
        for (const Pose& pose : read_poses(arena / "spawns.csv").poses) expected.push_back(pose.position);
        CHECK(expected.size() == 7);
        CHECK(locations(arena / command / "Valid_Locations.txt") == expected);
        CHECK(bytes_of(arena / command / "Invalid_Locations.txt").empty());
        const std::string stats = bytes_of(arena / command / "Stats.txt");
        CHECK(value_of(stats, "Spawns") == "7");
        CHECK(value_of(stats, "Seed") == "5");
        CHECK(value_of(stats, "Lines of Valid_Locations.txt") == "7");
        CHECK(value_of(stats, "Lines of Invalid_Locations.txt") == "0");
        CHECK(value_of(stats, "Positions that are not valid") == "counted, not written");
        CHECK(names_in(arena / command) ==
              std::set<std::string>{"Valid_Locations.txt", "Invalid_Locations.txt", "Stats.txt", "RunTime.txt"});
    }
    CHECK(arena("sample map -n 50 --min-distance 15 --format thesis -o few" + husky_option).status == 3);
    CHECK_FALSE(locations(arena / "few/Valid_Locations.txt").empty());
}

TEST_CASE("a folder with other contents is refused, and does not change")
{
    const Arena arena;
    const std::string command = "raster map --dims 2 --step 1 --format thesis" + husky_option;
    arena.write("out/Stats.txt", "old");
    arena.write("out/notes.txt", "mine");
    const ProgramRun run = arena(command + "-o out");
    CHECK(run.status == 1);
    CHECK(run.err ==
          "spawnfield: out: contains notes.txt, which is not part of any thesis result; choose another name or remove "
          "it\n");
    CHECK(bytes_of(arena / "out/Stats.txt") == "old");
    CHECK(bytes_of(arena / "out/notes.txt") == "mine");
    arena.write("file", "mine");
    CHECK(arena(command + "-o file").err ==
          "spawnfield: file: exists and is not a folder; choose another name or remove it\n");
    arena.write("nested/Stats.txt/deep", "mine");
    CHECK(arena(command + "-o nested").status == 1);
    CHECK(bytes_of(arena / "nested/Stats.txt/deep") == "mine");
    const ProgramRun nowhere = arena(command);
    CHECK(nowhere.status == 2);
    CHECK(nowhere.err == "spawnfield: --format thesis needs -o FOLDER\n");
    const ProgramRun picture = arena(command + "-o new --heatmap none/new.png");
    CHECK(picture.status == 1);
    CHECK(arena.names() == std::set<std::string>{"map", "out", "file", "nested"});

    fs::create_directory(arena / "empty");
    fs::create_directory_symlink("empty", arena / "link");
    CHECK(arena(command + "-o link/").status == 0);
    CHECK(fs::is_symlink(arena / "link"));
    CHECK(names_in(arena / "empty").contains("Valid_Locations.txt"));
    const ProgramRun stopped = interrupt_program(
        arena, "raster map --dims 3 --step 0.02 --no-height-check --format thesis -o empty" + husky_option);
    CHECK(stopped.status == 130);
    CHECK(value_of(bytes_of(arena / "empty/Stats.txt"), "Dimensions") == "2");
    CHECK(arena.names() == std::set<std::string>{"map", "out", "file", "nested", "empty", "link"});
}

#include "arena.h"
#include "figure_text.h"
#include "rest_robots.h"
#include "test_map.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>
#include <spawnfield/island_choice.h>
#include <spawnfield/raster_islands.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

using namespace spawnfield;
using rest_robots::add_block;
using rest_robots::boxy;

// Tests of choices of islands, in the library and in the commands.

namespace {

using Numbers = std::vector<std::size_t>;

/// Two rooms without a door between them: 4 x 4 m and 2 x 4 m. A table stands in the larger one; the robot fits onto it
/// and below it.
Scene two_rooms()
{
    Scene scene;
    add_block(scene, {-4, -2, -0.2}, {2.1, 2, 0});
    add_shape(scene, "wall", Label::Obstacle, box_shape({0.1, 4, 1}, {{0.05, 0, 0.5}}));
    add_block(scene, {-3, -1, 0.6}, {-1.5, 1, 0.65});
    return scene;
}

/// Small enough that it can turn everywhere except close to walls.
Robot small_robot() { return boxy({0.3, 0.3, 0.2}); }

struct Rooms {
    TestMap map = map_of(two_rooms());
    Judge judge{map, small_robot()};
    ReachGraph graph{judge, {.step = 0.1}};

    Numbers chosen(const IslandChoice& choice) const { return chosen_islands(graph, judge, choice); }
};

const Rooms& rooms()
{
    static const Rooms out;
    return out;
}

IslandChoice at(double x, double y, std::optional<double> z = {}) { return {.at = StartPlace{x, y, z}}; }

}  // namespace

TEST_CASE("a choice without conditions selects all islands, and each condition leaves some")
{
    const std::span<const Island> islands = rooms().graph.islands();
    REQUIRE(islands.size() >= 3);  // the rooms and the table
    CHECK(IslandChoice{}.selects_all());
    CHECK(rooms().chosen({}).size() == islands.size());
    CHECK(rooms().chosen({.largest = true}) == Numbers{0});
    CHECK(rooms().chosen({.number = 1}) == Numbers{1});
    CHECK(rooms().chosen({.min_area = islands[1].area}) == Numbers{0, 1});
    CHECK(rooms().chosen({.min_area = 1e6}).empty());
    CHECK(rooms().chosen({.largest = true, .number = 1}).empty());
}

TEST_CASE("an island is found by a place on it, on the floor below a table, on the table, and in the other room")
{
    CHECK(rooms().chosen(at(-0.7, 1)) == Numbers{0});
    CHECK(rooms().chosen(at(1, 0)) == Numbers{1});
    CHECK(rooms().chosen(at(-2, 0, 0)) == Numbers{0});
    CHECK(rooms().chosen(at(-2, 0, 0.65)) == Numbers{2});
    CHECK(rooms().chosen(at(-2, 0, 1)) == Numbers{2});
    CHECK(rooms().graph.islands()[2].low == Approx(0.65));
}

TEST_CASE("several start places select the islands of all of them, and further conditions leave fewer")
{
    const std::vector<StartPlace> both{{1, 0}, {-0.7, 1}};
    CHECK(rooms().chosen({.reachable_from = both}) == Numbers{0, 1});
    CHECK(rooms().chosen({.largest = true, .reachable_from = both}) == Numbers{0});
    CHECK(rooms().chosen({.min_area = rooms().graph.islands()[0].area, .reachable_from = {both[0]}}).empty());
}

TEST_CASE("faults in a choice of islands say what is wrong and what to do")
{
    const auto choose = [](const IslandChoice& choice) { return rooms().chosen(choice); };
    const std::size_t count = rooms().graph.islands().size();
    CHECK_THROWS_WITH(choose({.number = 900}), "chosen_islands: island 900 does not exist: there are " +
                                                   std::to_string(count) + " islands, 0 to " +
                                                   std::to_string(count - 1) + ", the largest first");
    CHECK_THROWS_WITH(choose({.min_area = -1}), "chosen_islands: min_area is -1, needs >= 0 m2");
    CHECK_THROWS_WITH(choose(at(-2, 0)),
                      "chosen_islands: at -2,0 the robot can stand on several islands above each other: at 0.65 m "
                      "(island 2), 0 m (island 0); give the height, too, for example -2,0,0.65");
    // Beside the wall, the robot comes to rest on top of it.
    CHECK_THROWS_WITH(choose(at(-0.1, 0)),
                      "chosen_islands: at -0.1,0 the robot can stand at none of 16 headings (at yaw 0: aerial: 1.02 m "
                      "above the ground, the limit is 1 m (--max-height); this is where it rests, raised by --lift); "
                      "give a place where it can stand");
    CHECK_THROWS_WITH(choose(at(50, 0)), Contains("at 50,0 the robot can stand at none") && Contains("outside"));
    CHECK_THROWS_WITH(choose(at(1, 0, 5)), Contains("at 1,0,5") && Contains("aerial: 5 m above the ground"));
    CHECK_THROWS_WITH(choose({.reachable_from = {{1, 0}, {0.05, 0}}}), Contains("at 0.05,0 the robot can stand"));
    CHECK_THROWS_WITH(choose(at(std::nan(""), 0)), Contains("a place is nan, needs finite numbers, m"));
}

TEST_CASE("without any island, every number is refused, and a choice selects none")
{
    const TestMap map = map_of(two_rooms());
    const Judge judge(map, boxy({9, 9, 0.2}));  // larger than the map
    const ReachGraph graph(judge, {.step = 0.5});
    REQUIRE(graph.islands().empty());
    CHECK(chosen_islands(graph, judge, {.largest = true}).empty());
    CHECK_THROWS_WITH(chosen_islands(graph, judge, {.number = 0}),
                      Contains("island 0 does not exist: there is no island, because the robot can stand nowhere"));
}

TEST_CASE("all samples lie on the chosen island, and a raster has unreachable poses elsewhere")
{
    const Rooms& here = rooms();
    const auto is_on = [&](const Vec3& p, std::size_t island) {
        return island == 0 ? p.x() < 0 && p.z() < 0.3 : island == 1 ? p.x() > 0 : p.z() > 0.6;
    };
    for (const std::size_t island : {0, 1, 2}) {
        CAPTURE(island);
        const ReachFilter filter = on_islands(here.graph, Numbers{island});
        const SpawnList list = sample(here.judge, {.count = 60, .random_yaw = true, .is_reachable = filter});
        REQUIRE(list.spawns.size() == 60);
        for (const Spawn& spawn : list.spawns) CHECK(is_on(spawn.position, island));
        CHECK(list.counts[Verdict::Unreachable] > 0);

        const RasterResult result = raster(here.judge,
                                           {.step = 0.25, .stance = Stance::Settled, .is_reachable = filter});
        std::size_t valid = 0;
        for (const RasterPose& pose : result.poses) {
            const bool is_here = is_on({pose.x, pose.y, pose.z}, island);
            if (pose.verdict == Verdict::Valid) CHECK(is_here);
            valid += pose.verdict == Verdict::Valid;
        }
        CHECK(valid > 8);
        CHECK(result.counts[Verdict::Unreachable] > 60);
    }
}

TEST_CASE("the islands of a raster are those of its settled poses, at any number of threads")
{
    const Rooms& here = rooms();
    const RasterResult result = raster(here.judge, {.step = 0.19, .stance = Stance::Settled, .yaw = 0.3});
    const std::vector<std::int32_t> islands = islands_of(here.graph, here.judge, result, {.threads = 1});
    REQUIRE(islands.size() == result.poses.size());
    std::array<int, 3> found{};
    for (std::size_t p = 0; p < islands.size(); ++p) {
        const RasterPose& pose = result.poses[p];
        const auto expected = here.graph.island_of(
            here.judge.settle({pose.x, pose.y, result.rests[p].layer_height}, result.rests[p].yaw));
        CHECK(islands[p] == (expected ? std::int32_t(*expected) : no_island));
        if (pose.verdict != Verdict::Valid) CHECK(islands[p] == no_island);
        if (islands[p] >= 0 && islands[p] < 3) ++found[std::size_t(islands[p])];
    }
    for (const int count : found) CHECK(count > 10);
    CHECK(islands_of(here.graph, here.judge, result, {.threads = 8}) == islands);
    CHECK_THROWS_WITH(islands_of(here.graph, here.judge, raster(here.judge, {.step = 0.5})),
                      Contains("islands_of: size of raster.rests is 0, needs as many as its poses"));
}

TEST_CASE("a picture of islands needs the island of each pose, and the area of each island")
{
    const Rooms& here = rooms();
    const TempFolder folder;
    const RasterResult result = raster(here.judge, {.step = 0.5, .stance = Stance::Settled});
    const TerrainMap terrain = rasterize_terrain(here.map.geometry, frame_around(here.map.bounds, 0.5));
    HeatmapOptions options{.quantity = HeatmapQuantity::Island};
    const auto draw = [&] { write_heatmap(here.map, terrain, result, options, folder / "a.svg"); };
    CHECK_THROWS_WITH(draw(),
                      "write_heatmap: size of islands is 0, needs as many as the raster's poses for this quantity");
    options.islands.assign(result.poses.size(), no_island);
    draw();
    options.islands.back() = 0;
    CHECK_THROWS_WITH(draw(), "write_heatmap: islands is 0, needs less than the number of island_areas, 0");
}

// ---------------------------------------------------------------- commands

namespace {

/// A folder with a map of the two rooms. The commands need no more than 0.2 s for its graph.
class RoomsFolder : public TempFolder {
public:
    RoomsFolder()
    {
        write("rooms.yaml",
              "format: spawnfield-scene/1\nparts:\n"
              "- {name: floor, box: [6.1, 4, 0.2], xyz: [-0.95, 0, -0.1], label: terrain}\n"
              "- {name: wall, box: [0.1, 4, 1], xyz: [0.05, 0, 0.5], label: obstacle}\n");
        REQUIRE(run_program(*this, "bake rooms.yaml -o rooms").status == 0);
    }

    ProgramRun operator()(const std::string& command, const std::string& options) const
    {
        return run_program(*this, command + " rooms --robot box:0.3,0.3,0.2 --reach-step 0.1 " + options);
    }

    /// Returns the x of the spawns of a CSV file.
    static std::vector<double> xs(const std::string& csv)
    {
        std::vector<double> out;
        for (const Pose& pose : parse_poses(csv, "csv", true).poses) out.push_back(pose.position.x());
        return out;
    }
};

}  // namespace

TEST_CASE("sample --island puts all spawns into one room, the same at any number of threads")
{
    const RoomsFolder rooms;
    const ProgramRun large = rooms("sample", "-n 80 --yaw random --island largest --threads 1"),
                     small = rooms("sample", "-n 80 --yaw random --island at:1,0 --summary small.json");
    REQUIRE((large.status == 0 && small.status == 0));
    for (const double x : RoomsFolder::xs(large.out)) CHECK(x < 0);
    for (const double x : RoomsFolder::xs(small.out)) CHECK(x > 0.1);
    CHECK(RoomsFolder::xs(small.out).size() == 80);
    CHECK_THAT(large.err, Contains(" islands found in ") && Contains("; only island 0;") && Contains(" unreachable"));
    const nlohmann::json summary = nlohmann::json::parse(bytes_of(rooms / "small.json"));
    CHECK(summary.at("counts").at("unreachable") > 20);
    CHECK(summary.at("seconds").at("islands") > 0);
    for (const char* const threads : {"2", "8"})
        CHECK(rooms("sample", std::string("-n 80 --yaw random --island largest --threads ") + threads).out ==
              large.out);

    const ProgramRun json = rooms("sample", "-n 1 --format json --island largest --reachable-from -1,0");
    CHECK(nlohmann::json::parse(json.out)["settings"]["islands"] == "island largest, reachable from -1,0");
    CHECK(!nlohmann::json::parse(
               run_program(rooms, "sample rooms --robot box:0.3,0.3,0.2 -n 1 --format json").out)["settings"]
               .contains("islands"));
    // The map may follow after a place.
    const ProgramRun one = run_program(rooms, "sample --reachable-from 1,0 rooms --robot box:0.3,0.3,0.2 -n 9");
    REQUIRE(one.status == 0);
    for (const double x : RoomsFolder::xs(one.out)) CHECK(x > 0.1);
    const ProgramRun both = rooms("sample", "-n 80 --reachable-from 1,0 --reachable-from -1,0,0.1");
    const std::vector<double> xs = RoomsFolder::xs(both.out);
    CHECK(std::any_of(xs.begin(), xs.end(), [](double x) { return x < 0; }));
    CHECK(std::any_of(xs.begin(), xs.end(), [](double x) { return x > 0; }));
}

TEST_CASE("sample prints a notice if its spawns stand on several islands, unless --island was given")
{
    const RoomsFolder rooms;
    const std::string robot = " rooms --robot box:0.3,0.3,0.2 -n 80";
    const ProgramRun plain = run_program(rooms, "sample" + robot);
    CHECK_THAT(plain.err, Contains("notice: the spawns stand on ") &&
                              Contains(" islands, between which box:0.3,0.3,0.2 "
                                       "cannot drive: ") &&
                              Contains("--island largest excludes all but the largest"));
    for (const char* const more : {" --island all", " --island largest", " --stance level"})
        CHECK_THAT(run_program(rooms, "sample" + robot + more).err, !Contains("the spawns stand on"));
    CHECK(run_program(rooms, "sample" + robot + " --island all").out == plain.out);
    CHECK_THAT(run_program(rooms, "sample" + robot + " --region 1,-1,2,1").err, !Contains("the spawns stand on"));
}

TEST_CASE("only the largest island is used if no label was given for the scene")
{
    const TempFolder folder;
    // A floor of 4 x 4 m and, 1 m above it, a shelf of 2 x 2 m.
    folder.write("room.obj",
                 "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 1\nv 2 0 1\nv 2 2 1\nv 0 2 1\nf 1 2 3 4\nf 5 6 7 8\n");
    REQUIRE(run_program(folder, "bake room.obj --up z -o bare").status == 0);
    REQUIRE(run_program(folder, "bake room.obj --up z --label '*=terrain' -o labelled").status == 0);
    const auto heights = [&](const std::string& arguments) {
        const ProgramRun run = run_program(folder, "sample " + arguments + " --robot box:0.3,0.3,0.2 -n 100");
        const bool has_notice = run.err.find("notice: no label was given for the scene of room") != std::string::npos;
        std::size_t high = 0;
        std::istringstream lines(run.out);
        std::string line;
        std::getline(lines, line);
        while (std::getline(lines, line)) high += std::stod(line.substr(line.find(',', line.find(',') + 1) + 1)) > 0.5;
        return std::pair(high, has_notice);
    };
    CHECK(heights("bare") == std::pair<std::size_t, bool>(0, true));
    CHECK(heights("bare --island all").first > 5);
    CHECK(!heights("bare --island all").second);
    CHECK(heights("labelled").first > 5);
    CHECK(!heights("labelled").second);
    CHECK(!heights("bare --stance level").second);
    CHECK(heights("bare --island 1").first == 100);
    CHECK_THAT(run_program(folder, "heatmap bare --robot box:0.3,0.3,0.2 -o a.png").err,
               Contains("no label was given") && Contains(" unreachable"));
    CHECK_THAT(run_program(folder, "export bare --robot box:0.3,0.3,0.2 --format ply --step 0.2 -o a.ply").err,
               Contains("no label was given"));
    CHECK_THAT(run_program(folder, "sample bare --robot box:0.3,0.3,0.2 -n 1 --reach-step 0.2").err,
               Contains("only island 0"));
}

TEST_CASE("if no island is selected, sample ends with status 3 and the reason")
{
    const RoomsFolder rooms;
    const ProgramRun run = rooms("sample", "-n 5 --min-island 100");
    CHECK(run.status == 3);
    CHECK(RoomsFolder::xs(run.out).empty());
    CHECK_THAT(run.err, Contains("no island is selected: --min-island is 100 m2, but the largest island has ") &&
                            Contains("; give a smaller --min-island"));
    CHECK_THAT(rooms("sample", "-n 5 --island 0 --reachable-from 1,0").err,
               Contains("none fulfils --island, --min-island and --reachable-from together"));
    const ProgramRun few = rooms("sample", "-n 999 --min-distance 1 --island at:1,0");
    CHECK(few.status == 3);
    CHECK_THAT(few.err, Contains("a choice of more islands"));
}

TEST_CASE("heatmap and export have unreachable poses in the other room")
{
    const RoomsFolder rooms;
    const ProgramRun picture = rooms("heatmap", "-o a.svg --island largest --step 0.2");
    REQUIRE(picture.status == 0);
    CHECK_THAT(picture.err, Contains(" unreachable"));
    CHECK_THAT(bytes_of(rooms / "a.svg"), Contains(">unreachable<") && Contains("island largest"));
    REQUIRE(rooms("export", "--format nav2 -o a.yaml --resolution 0.5 --min-island 8").status == 0);
    CHECK_THAT(bytes_of(rooms / "a.yaml"), Contains("islands from 8 m2"));
    const ProgramRun ply = rooms("export", "--format ply --step 0.3 --reachable-from 1,0");
    REQUIRE(ply.status == 0);
    CHECK_THAT(ply.out, Contains("9 unreachable") && Contains("reachable from 1,0"));
    CHECK_THAT(ply.err, Contains(" unreachable"));
    CHECK_THAT(rooms("export", "--format glb --island 0 -o a.glb").err,
               Contains("--island is not for --format glb; it is for nav2, geotiff, ply"));
}

TEST_CASE("heatmap --quantity island draws the islands with their numbers and areas")
{
    const RoomsFolder rooms;
    REQUIRE(rooms("heatmap", "-o a.svg --quantity island --step 0.1").status == 0);
    const std::vector<std::string> texts = svg_texts(bytes_of(rooms / "a.svg"));
    const auto after = [&](const std::string& text) {
        const auto found = std::find(texts.begin(), texts.end(), text);
        return found == texts.end() || found + 1 == texts.end() ? std::string() : *(found + 1);
    };
    CHECK_THAT(after("island 0"), Contains(" m2"));
    // The robot can overhang the edges of the floor, but not the wall.
    CHECK(std::stod(after("island 0")) == Approx((4 - 0.15) * 4).margin(0.8));
    CHECK(std::stod(after("island 1")) == Approx((2 - 0.15) * 4).margin(0.5));
    CHECK(!after("not valid").empty());
    for (const char* const number : {"0", "1"}) CHECK(std::count(texts.begin(), texts.end(), number) >= 1);

    const ProgramRun one = rooms("heatmap", "-o b.svg --quantity island --step 0.1 --island at:1,0");
    REQUIRE(one.status == 0);
    const std::vector<std::string> fewer = svg_texts(bytes_of(rooms / "b.svg"));
    CHECK(std::count(fewer.begin(), fewer.end(), "island 0") == 0);
    CHECK(std::count(fewer.begin(), fewer.end(), "island 1") == 1);
    CHECK_THAT(rooms("heatmap", "-o c.svg --quantity island --yaw random").err, Contains("needs one heading"));
    CHECK_THAT(run_program(rooms, "heatmap rooms --robot box:1,1,1 -o c.svg --quantity island --stance level").err,
               Contains("--quantity island is about the robot at rest; leave --stance level out"));
}

TEST_CASE("faults in the options of islands are named with their values and what to do")
{
    const RoomsFolder rooms;
    const auto message = [&](const std::string& options) {
        const ProgramRun run = rooms("sample", "-n 1 " + options);
        CHECK(run.status == 2);
        CHECK(run.out.empty());
        return run.err;
    };
    CHECK_THAT(message("--island big"), Contains("--island is \"big\", needs largest, all, the number of an island ("));
    CHECK_THAT(message("--island -1"), Contains("--island is \"-1\", needs largest"));
    CHECK_THAT(message("--island ''"), Contains("--island is \"\", needs largest"));
    CHECK_THAT(message("--island at:1"),
               Contains("the place of --island is \"1\", needs x,y or x,y,z in m, for example 1.5,-2"));
    CHECK_THAT(message("--island at:1,a"), Contains("\"a\" is not a finite number"));
    CHECK_THAT(message("--island 99"), Contains("island 99 does not exist: there are "));
    CHECK_THAT(message("--island at:0.05,0"), Contains("at 0.05,0 the robot can stand at none of 16 headings"));
    CHECK_THAT(message("--min-island 0"), Contains("--min-island is 0, needs > 0"));
    CHECK_THAT(message("--reachable-from 1,2,3,4"), Contains("--reachable-from is \"1,2,3,4\", needs x,y or x,y,z"));
    CHECK_THAT(message("--island largest --stance level"),
               Contains("--island is only for settled robots, because islands are where they can drive; leave "
                        "--stance level out"));
    CHECK_THAT(message(""), Contains("--reach-step is only for --island, --min-island and --reachable-from; give one"));
}

TEST_CASE("info --islands lists the floors of each island, and prints notices about the robot")
{
    const Arena arena;
    const std::string command = "info map --islands --reach-step 0.4 --robot box:0.9,0.6,0.3";
    const ProgramRun run = arena(command);
    REQUIRE(run.status == 0);
    CHECK_THAT(run.out, Contains(", floors 0, 1\n") && Contains(", floor 1\n"));
    CHECK_THAT(run.err, Contains("notice: box:0.9,0.6,0.3 has no centre of mass") && Contains(" islands found in "));
    const nlohmann::json islands = nlohmann::json::parse(arena(command + " --json").out).at("reach").at("islands");
    CHECK(islands.at(0).at("floors") == nlohmann::json{0, 1});  // the ground, and the platform at the ramp's end
    for (const nlohmann::json& island : islands)
        if (island.at("z").at(0) > 2) CHECK(island.at("floors") == nlohmann::json{1});
    CHECK_THAT(arena("info map --islands --robot box:90,90,1 --reach-step 2").err, Contains("larger than the map"));
}

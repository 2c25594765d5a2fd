#include "arena.h"
#include "catch.h"
#include "rest_robots.h"
#include "scene_text.h"
#include "temp_folder.h"
#include "test_map.h"

#include "base/binary.h"
#include "reach/reach_graph.h"

#include <spawnfield/bake.h>
#include <spawnfield/input_file.h>
#include <spawnfield/kept_graph.h>
#include <spawnfield/path.h>
#include <spawnfield/output_file.h>

#include <filesystem>
#include <random>
#include <set>
#include <tuple>

using namespace spawnfield;
using Catch::Matchers::Contains;

namespace fs = std::filesystem;

// Tests that a drivable graph that was read from its file is the one that was built.

namespace {

/// Two rooms of 4 x 4 m and 2 x 4 m without a door between them, and a table in the larger one.
Scene two_rooms(double table = 0.6)
{
    Scene scene;
    const auto add = [&](const char* name, Label label, const Vec3& low, const Vec3& high) {
        add_shape(scene, name, label, box_shape(high - low, {(low + high) / 2}));
    };
    add("floor", Label::Terrain, {-4, -2, -0.2}, {2.1, 2, 0});
    add("wall", Label::Obstacle, {0, -2, 0}, {0.1, 2, 1});
    add("table", Label::Terrain, {-3, -1, table}, {-1.5, 1, table + 0.05});
    return scene;
}

Robot small_robot() { return make_robot("small", {shape_part(box_shape({0.3, 0.3, 0.2}, {{0, 0, 0.1}}))}); }

/// A map in a folder.
struct BakedRooms {
    TempFolder temp;
    fs::path folder = temp / "map";

    BakedRooms() { bake(); }
    void bake(double table = 0.6) const
    {
        const fs::path scene = temp.write("scene.txt", std::to_string(table));  // its bytes are in the map's hash
        spawnfield::bake(two_rooms(table), scene, folder);
    }
    Judge judge(const JudgeOptions& options = {}, const Robot& robot = small_robot()) const
    {
        return {read_map(folder), robot, options};
    }
    std::vector<fs::path> kept_files() const
    {
        std::vector<fs::path> out;
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().filename().string().starts_with("reach-")) out.push_back(entry.path());
        return out;
    }
};

constexpr double reach_step = 0.2;

void check_equal(const ReachGraph& graph, const ReachGraph& expected, const Judge& judge)
{
    REQUIRE(graph.islands().size() == expected.islands().size());
    for (std::size_t i = 0; i < graph.islands().size(); ++i) {
        const Island &a = graph.islands()[i], &b = expected.islands()[i];
        CHECK(std::tie(a.area, a.share, a.low, a.high) == std::tie(b.area, b.share, b.low, b.high));
        CHECK(a.place == b.place);
    }
    CHECK(graph.options().step == expected.options().step);
    const auto places = graph.places(), expected_places = expected.places();
    REQUIRE(places.size() == expected_places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const ReachPlace &a = places[i], &b = expected_places[i];
        CHECK(std::tie(a.x, a.y, a.ground, a.island) == std::tie(b.x, b.y, b.ground, b.island));
    }
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(-4, 2), y(-2, 2), yaw(-3, 3), z(0, 1);
    std::size_t found = 0;
    for (int i = 0; i < 200; ++i) {
        const SettledPose pose = judge.settle({x(random), y(random), z(random)}, yaw(random));
        CHECK(graph.island_of(pose) == expected.island_of(pose));
        found += graph.island_of(pose).has_value();
    }
    CHECK(found > 50);
}

}  // namespace

TEST_CASE("a drivable graph is kept in the map's folder, and read again")
{
    const BakedRooms rooms;
    const ReachOptions options{.step = reach_step};
    const Judge judge = rooms.judge();
    const ReachGraph expected(judge, options);
    REQUIRE(expected.islands().size() >= 3);
    const KeptGraph built = kept_graph(judge, options);
    CHECK(!built.is_read);
    CHECK(built.notice.empty());
    REQUIRE(rooms.kept_files() == std::vector{kept_graph_file(judge, options)});
    check_equal(built.graph, expected, judge);
    const KeptGraph again = kept_graph(rooms.judge(), options);
    CHECK(again.is_read);
    CHECK(again.notice.empty());
    check_equal(again.graph, expected, judge);
    CHECK_NOTHROW(verify_map(rooms.folder));
}

TEST_CASE("a graph with its ways is kept, too, and serves for islands")
{
    const BakedRooms rooms;
    const ReachOptions options{.step = reach_step, .keep_ways = true};
    const Judge judge = rooms.judge();
    const KeptGraph built = kept_graph(judge, options), again = kept_graph(judge, options);
    CHECK(!built.is_read);
    CHECK(again.is_read);
    check_equal(again.graph, built.graph, judge);
    CHECK(again.graph.impl()->ways == built.graph.impl()->ways);
    PathSearch search(built.graph), search_again(again.graph);
    const std::vector<ReachPlace> places = built.graph.places();
    std::size_t found = 0;
    for (std::size_t k = 0; k + 7 < places.size(); k += places.size() / 40) {
        const SettledPose start = judge.settle({places[k].x, places[k].y, places[k].ground}, 0),
                          goal = judge.settle({places[k + 7].x, places[k + 7].y, places[k + 7].ground}, 1);
        const auto path = search.path(start, goal), other = search_again.path(start, goal);
        REQUIRE(path.has_value() == other.has_value());
        if (!path) continue;
        ++found;
        CHECK(path->length == other->length);
        CHECK(path->poses.size() == other->poses.size());
    }
    CHECK(found > 5);
    const KeptGraph islands = kept_graph(judge, {.step = reach_step});
    CHECK(islands.is_read);
    CHECK(rooms.kept_files().size() == 1);
    check_equal(islands.graph, ReachGraph(judge, {.step = reach_step}), judge);
}

TEST_CASE("a kept graph is only for the same map, robot, limits and options")
{
    const BakedRooms rooms;
    const ReachOptions options{.step = reach_step};
    std::set<fs::path> files;
    const auto add = [&](const Judge& judge, const ReachOptions& reach) {
        CHECK(files.insert(kept_graph_file(judge, reach)).second);
    };
    add(rooms.judge(), options);
    add(rooms.judge(), {.step = reach_step / 2});
    add(rooms.judge(), {.drive = Drive::Omni, .step = reach_step});
    add(rooms.judge(), {.max_step = 0.05, .step = reach_step});
    for (const double radius : {1.0, 2.0})
        add(rooms.judge(), {.drive = Drive::Car, .turning_radius = radius, .step = reach_step});
    add(rooms.judge(), {.step = reach_step, .keep_ways = true});
    add(rooms.judge({.max_height = 0.5}), options);
    add(rooms.judge({.max_water_depth = 0.5}), options);
    add(rooms.judge({.stand = {.lift = 0.01}}), options);
    add(rooms.judge({.stand = {.max_slope = 0.3}}), options);
    add(rooms.judge({.stand = {.max_tilt = 0.6}}), options);
    add(rooms.judge({.stand = {.min_stability = 0.02}}), options);
    add(rooms.judge({.stand = {.friction = 0.5}}), options);
    add(rooms.judge({.stand = {.drop = 0.5}}), options);
    Robot moved = small_robot(), heavy = small_robot(), two = small_robot();
    moved.parts[0].shape.pose.position.x() += 0.01;
    heavy.mass_center = Vec3(0, 0, 0.02);
    two.parts.push_back(moved.parts[0]);
    for (const Robot& robot : {moved, heavy, two}) add(rooms.judge({}, robot), options);
    rooms.bake(0.5);
    add(rooms.judge(), options);

    CHECK(kept_graph_file(rooms.judge({.exhaustive = true}), options).empty());
    const TestMap without_folder = map_of(two_rooms());
    CHECK(kept_graph_file(Judge(without_folder, small_robot()), options).empty());
    CHECK(!kept_graph(Judge(without_folder, small_robot()), options).is_read);
    // The same value, given or by default; names and threads do not matter.
    Robot named = small_robot();
    named.name = "other";
    CHECK(kept_graph_file(rooms.judge({}, named), {.step = auto_reach_step(named), .threads = 2}) ==
          kept_graph_file(rooms.judge(), {}));
}

TEST_CASE("a damaged file of a kept graph is named, and replaced")
{
    const BakedRooms rooms;
    const ReachOptions options{.step = reach_step};
    const Judge judge = rooms.judge();
    const ReachGraph expected = kept_graph(judge, options).graph;
    const fs::path file = kept_graph_file(judge, options);
    const std::string bytes = read_file(file);
    std::string changed = bytes;
    changed[bytes.size() / 2] = char(changed[bytes.size() / 2] ^ 1);
    for (const std::string& damaged :
         {changed, bytes.substr(0, bytes.size() - 1), bytes.substr(0, 20), std::string()}) {
        write_file_atomically(file, damaged);
        const KeptGraph kept = kept_graph(judge, options);
        CHECK(!kept.is_read);
        CHECK_THAT(kept.notice,
                   Contains(file.string() + ": the kept graph cannot be used: ") && Contains("it is built again"));
        check_equal(kept.graph, expected, judge);
        CHECK(read_file(file) == bytes);
        CHECK(kept_graph(judge, options).is_read);
    }
    fs::remove(file);
    fs::create_directory(file);
    const KeptGraph kept = kept_graph(judge, options);
    check_equal(kept.graph, expected, judge);
    CHECK_THAT(kept.notice, Contains("the graph is not kept") && Contains(file.string()));
}

TEST_CASE("numbers of a kept graph that do not fit each other are refused")
{
    const Judge judge(map_of(two_rooms()), small_robot());
    const ReachOptions options{.step = reach_step};
    using Impl = ReachGraph::Impl;
    const Impl graph(judge, options);
    CHECK_NOTHROW(Impl(judge, options, Impl::Keep::Islands, graph.bytes()));
    const auto check_refused = [&](const auto& change) {
        Impl other(judge, options);
        change(other);
        CHECK_THROWS_AS(Impl(judge, options, Impl::Keep::Islands, other.bytes()), std::exception);
    };
    check_refused([](Impl& other) { other.first.pop_back(); });
    check_refused([](Impl& other) { std::swap(other.first.front(), other.first.back()); });
    check_refused([](Impl& other) { other.ground.pop_back(); });
    check_refused([](Impl& other) { other.valid.back() = 0; });
    check_refused([](Impl& other) { other.first_node[1] = 3; });
    check_refused([](Impl& other) { other.node_islands.back() = std::uint32_t(other.islands.size()); });
    CHECK_THROWS(Impl(judge, {.step = reach_step / 2}, Impl::Keep::Islands, graph.bytes()));
    CHECK_THROWS(Impl(judge, options, Impl::Keep::Islands, std::string_view(graph.bytes()).substr(0, 100)));
}

TEST_CASE("ways of a kept graph that lead nowhere are refused")
{
    const Judge judge(map_of(two_rooms()), small_robot());
    const ReachOptions options{.step = reach_step};
    using Impl = ReachGraph::Impl;
    const auto bytes_with = [&](const auto& change) {
        Impl graph(judge, options, Impl::Keep::Ways);
        change(graph.ways);
        return graph.bytes();
    };
    const auto read = [&](const std::string& bytes) { return Impl(judge, options, Impl::Keep::Ways, bytes); };
    CHECK_NOTHROW(read(bytes_with([](auto&) {})));
    CHECK_THROWS(read(bytes_with([](auto& ways) { ways[std::size_t(Way::Left)].pop_back(); })));
    CHECK_THROWS(read(bytes_with([](auto& ways) { ways[std::size_t(Way::Turn)].clear(); })));
    CHECK_THROWS(read(bytes_with([](auto& ways) { ways[std::size_t(Way::Aside)] = ways[0]; })));
    CHECK_THROWS(read(bytes_with([](auto& ways) { ways[std::size_t(Way::Ahead)][0][8] = 0; })));  // out of the grid
    CHECK_THROWS(read(bytes_with([](auto& ways) { ways[std::size_t(Way::Ahead)][0][0] = 200; })));
    CHECK_THROWS(read(Impl(judge, options).bytes()));
}

TEST_CASE("a new bake keeps graphs of the same map, and removes those of another one")
{
    const BakedRooms rooms;
    const ReachOptions options{.step = reach_step};
    kept_graph(rooms.judge(), options);
    const std::vector<fs::path> before = rooms.kept_files();
    REQUIRE(before.size() == 1);
    const fs::path notes = rooms.folder / "reach-notes.bin";  // of the user
    write_file_atomically(notes, "not a graph");
    rooms.bake();
    CHECK(kept_graph(rooms.judge(), options).is_read);
    rooms.bake(0.5);
    CHECK(!fs::exists(before[0]));
    CHECK(fs::exists(notes));
    CHECK(!kept_graph(rooms.judge(), options).is_read);
}

TEST_CASE("info --islands reads the graph that it kept before")
{
    const Arena arena;
    const std::string command = "info map --islands --reach-step 0.4 --robot box:0.9,0.6,0.3";
    const ProgramRun first = arena(command), second = arena(command);
    CHECK_THAT(first.err, Contains("found in"));
    CHECK_THAT(second.err, Contains("read in"));
    CHECK(first.out == second.out);
}

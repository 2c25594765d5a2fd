#include "catch.h"
#include "random_scene.h"
#include "reach/path_search.h"
#include "rest_robots.h"
#include "slow_reach.h"
#include "test_map.h"

#include <spawnfield/raster_quantities.h>
#include <spawnfield/room.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

using namespace spawnfield;
using rest_robots::add_block;
using rest_robots::boxy;

// Tests of shortest paths on the drivable graph.

namespace {

constexpr double floor_half = 2;

Scene level_floor()
{
    Scene scene;
    add_block(scene, {-floor_half, -floor_half, -0.5}, {floor_half, floor_half, 0});
    return scene;
}

void add_wall(Scene& scene, const Vec2& low, const Vec2& high)
{
    add_shape(scene, "wall", Label::Obstacle,
              box_shape({high.x() - low.x(), high.y() - low.y(), 0.6},
                        {{(low.x() + high.x()) / 2, (low.y() + high.y()) / 2, 0.3}}));
}

/// A floor with walls at random.
Scene random_walls(std::uint64_t seed)
{
    Scene scene = level_floor();
    Random random(seed);
    for (int k = 0; k < 5; ++k) {
        const Vec2 at(random.between(-1.5, 1.5), random.between(-1.5, 1.5));
        const bool is_along = random.chance(0.5);
        add_wall(scene, at,
                 at + (is_along ? Vec2(random.between(0.2, 1.5), 0.1) : Vec2(0.1, random.between(0.2, 1.5))));
    }
    return scene;
}

/// The length in nanometres, and the turns on the spot.
using SlowCost = std::pair<std::int64_t, int>;

Vec2 vector_of(const LatticeMove& move) { return {double(move.cols), double(move.rows)}; }

/// Returns the shortest paths from one state to all others by definition: relaxes all ways until nothing changes.
std::map<slow::Reach::State, SlowCost> slow_paths(const slow::Reach& reach, const ReachGraph::Impl& graph,
                                                  const slow::Reach::State& start)
{
    struct Edge {
        slow::Reach::State a, b;
        SlowCost cost;
    };
    std::vector<Edge> edges;
    const RasterGrid& grid = graph.grid;
    const auto ground = [&](const slow::Reach::State& s) { return reach.places(s[0], s[1])[std::size_t(s[2])].ground; };
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            for (int k = 0; k < int(reach.places(col, row).size()); ++k)
                for (int h = 0; h < lattice_headings; ++h) {
                    if (!reach.places(col, row)[std::size_t(k)].poses[std::size_t(h)]) continue;
                    for (const Way way : all_ways) {
                        if (way == Way::Aside && !goes_aside(*graph.options.drive)) continue;
                        if (way == Way::Turn && graph.options.drive == Drive::Car) continue;
                        const slow::Reach::State from{col, row, k, h};
                        const auto target = reach.target(from, way);
                        if (!target) continue;
                        const WayEnd end = graph.lattice.end(way, h);
                        const slow::Reach::State to{col + end.move.cols, row + end.move.rows, *target, end.heading};
                        double flat = end.move.length();
                        if (is_curve(way)) {
                            const double yaw = lattice_yaw(h),
                                         turn = std::remainder(lattice_yaw(end.heading) - yaw, 2 * std::numbers::pi);
                            flat = slow::Reach::length(
                                {{0, 0}, vector_of(end.move), yaw, turn, vector_of(graph.lattice.corner(way, h))});
                        }
                        const double length = std::hypot(flat * grid.step, ground(to) - ground(from));
                        edges.push_back(
                            {from, to, way == Way::Turn ? SlowCost{0, 1} : SlowCost{std::llround(length * 1e9), 0}});
                    }
                }
    std::map<slow::Reach::State, SlowCost> out{{start, {0, 0}}};
    for (bool changes = true; changes;) {
        changes = false;
        for (const Edge& edge : edges)
            for (const auto& [from, to] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
                const auto known = out.find(from);
                if (known == out.end()) continue;
                const SlowCost sum{known->second.first + edge.cost.first, known->second.second + edge.cost.second};
                const auto [there, is_new] = out.emplace(to, sum);
                if (!is_new && sum >= there->second) continue;
                there->second = sum;
                changes = true;
            }
    }
    return out;
}

/// Returns the area of the places to which these paths lead, if they are not longer than `range`, m.
double slow_room(const std::map<slow::Reach::State, SlowCost>& paths, double range, double step)
{
    std::set<std::array<int, 3>> places;
    for (const auto& [state, cost] : paths)
        if (double(cost.first) * 1e-9 <= range) places.insert({state[0], state[1], state[2]});
    return double(places.size()) * step * step;
}

/// Returns the number of turns on the spot.
int turns_of(const std::vector<std::uint64_t>& states)
{
    int out = 0;
    for (std::size_t k = 1; k < states.size(); ++k)
        out += states[k] / lattice_headings == states[k - 1] / lattice_headings;
    return out;
}

struct PathWorld {
    TestMap map;
    Judge judge;
    ReachGraph graph;

    PathWorld(Scene scene, const Robot& robot, ReachOptions options)
        : map(map_of(std::move(scene))), judge(map, robot), graph(judge, with_ways(options))
    {
    }
    static ReachOptions with_ways(ReachOptions options)
    {
        options.keep_ways = true;
        return options;
    }
    SettledPose at(double x, double y, double yaw = 0) const { return judge.settle({x, y, 0}, yaw); }
};

/// Returns the length of the shortest path of the graph.
std::optional<double> graph_length(PathSearch::Impl& search, const SettledPose& start, const SettledPose& goal)
{
    const auto first = search.end_of(start), last = search.end_of(goal);
    return first && last ? search.find(*first, *last, 1e3) : std::nullopt;
}

}  // namespace

TEST_CASE("Shortest paths are those of a slow search on the slow graph")
{
    std::size_t reached = 0, unreached = 0;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        const Drive drive = seed == 2 ? Drive::Omni : seed == 4 ? Drive::Car : Drive::Differential;
        Scene scene = random_walls(seed);
        if (seed == 3) add_wall(scene, {0.3, -2}, {0.4, 2});  // two islands
        ReachOptions options{.drive = drive, .step = 0.4};
        if (drive == Drive::Car) options.turning_radius = 1.2;
        const PathWorld world(std::move(scene), boxy({0.5, 0.3, 0.25}), options);
        const ReachGraph::Impl& graph = *world.graph.impl();
        Scene surfaces = world.map.scene;
        for (Piece& piece : surfaces.pieces) piece.solid = false;
        const slow::Reach reach(world.judge, graph.options, graph.grid, Geometry(surfaces));
        std::vector<slow::Reach::State> states;
        std::vector<std::uint64_t> ids;
        for (int row = 0; row < graph.grid.rows; ++row)
            for (int col = 0; col < graph.grid.cols; ++col)
                for (std::size_t p = graph.first[graph.column_of(col, row)];
                     p < graph.first[graph.column_of(col, row) + 1]; ++p)
                    for (int h = 0; h < lattice_headings; ++h)
                        if (has_heading(graph.valid[p], h)) {
                            states.push_back({col, row, int(p - graph.first[graph.column_of(col, row)]), h});
                            ids.push_back(p * lattice_headings + std::uint64_t(h));
                        }
        PathSearch::Impl search(std::make_shared<const PathGraph>(world.graph.impl()));
        for (const std::size_t start : {std::size_t(0), states.size() / 2}) {
            const auto expected = slow_paths(reach, graph, states[start]);
            for (const double range : {0.6123, 1.4987}) {
                CAPTURE(seed, start, range);
                const auto [col, row, place, heading] = states[start];
                const SettledPose& pose = *reach.places(col, row)[std::size_t(place)].poses[std::size_t(heading)];
                CHECK(room_on(world.graph, range)(pose.lifted(world.judge.options().stand.lift)) ==
                      Approx(slow_room(expected, range, graph.grid.step)));
            }
            for (std::size_t goal = 0; goal < states.size(); ++goal) {
                const auto found = search.find(ids[start], ids[goal], 1e3);
                const auto known = expected.find(states[goal]);
                CAPTURE(seed, start, goal);
                REQUIRE(found.has_value() == (known != expected.end()));
                ++(found ? reached : unreached);
                if (!found) continue;
                const std::vector<std::uint64_t> path = search.states();
                // The rounding of each way is at most 1 nm.
                CHECK(std::abs(*found - double(known->second.first) * 1e-9) < 2e-9 * double(path.size()));
                CHECK((path.front() == ids[start] && path.back() == ids[goal]));
                CHECK(turns_of(path) == known->second.second);
                // A limit just below the length finds nothing, and one at the length finds the path.
                if (*found == 0) continue;
                CHECK_FALSE(search.find(ids[start], ids[goal], *found - 1e-6));
                CHECK(*search.find(ids[start], ids[goal], *found) == *found);
            }
        }
    }
    CHECK(reached > 500);
    CHECK(unreached > 20);
}

TEST_CASE("A path of the graph has the same length in both directions, and a shortened one is not longer")
{
    const PathWorld world(random_walls(4), boxy({0.5, 0.3, 0.25}), {.step = 0.2});
    PathSearch::Impl graph_search(std::make_shared<const PathGraph>(world.graph.impl()));
    PathSearch search(world.graph);
    Random random(7);
    int paths = 0, shorter = 0;
    for (int k = 0; k < 60; ++k) {
        const auto pose = [&] { return world.at(random.between(-2, 2), random.between(-2, 2), random.between(-3, 3)); };
        const SettledPose start = pose(), goal = pose();
        const auto path = search.path(start, goal);
        const auto island = world.graph.island_of(start);
        CHECK(path.has_value() == (island && island == world.graph.island_of(goal)));
        if (!path) continue;
        ++paths;
        const double on_graph = *graph_length(graph_search, start, goal);
        CHECK(*graph_length(graph_search, goal, start) == Approx(on_graph).margin(1e-9));
        CHECK(path->length >= (goal.position - start.position).head<2>().norm() - 1e-9);
        CHECK(path->length <= on_graph + 1e-9);
        shorter += path->length < on_graph - 1e-3;
        CHECK_FALSE(search.path(start, goal, path->length - 1e-6));
        CHECK(search.path(start, goal, on_graph));
        for (const SettledPose& stop : path->poses) CHECK(stop.verdict == Verdict::Valid);
        CHECK(path->poses.front().position == start.position);
        CHECK(path->poses.back().position == goal.position);
    }
    CHECK(paths > 10);
    CHECK(shorter > 10);
}

TEST_CASE("The room of spawns and of rasters is that of their poses, with any number of threads, and grows with range")
{
    const PathWorld world(random_walls(4), boxy({0.5, 0.3, 0.25}), {.step = 0.2});
    const RasterResult plain = raster(world.judge, {.step = 0.3, .stance = Stance::Settled, .yaw = 0.3});
    std::vector<double> last(plain.poses.size(), 0);
    std::size_t known = 0;
    for (const double range : {0.3, 1.0, 3.0, 20.0}) {
        const PlaceMeasures measures{.room_range = range, .room = room_on(world.graph, range)};
        const auto rooms = [&](int threads) {
            const PlaceMeasures fresh{.room_range = range, .room = room_on(world.graph, range)};
            return raster_quantity(world.judge, plain, PlaceQuantity::Room, fresh, {.threads = threads});
        };
        const std::vector<double> one = rooms(1), three = rooms(3);
        for (std::size_t p = 0; p < one.size(); ++p) {
            CHECK(std::isnan(one[p]) == (plain.poses[p].verdict != Verdict::Valid));
            if (std::isnan(one[p])) continue;
            ++known;
            CHECK(one[p] == three[p]);
            CHECK(one[p] >= last[p]);
            last[p] = one[p];
            const auto island = world.graph.island_of(world.at(plain.poses[p].x, plain.poses[p].y, 0.3));
            CHECK((one[p] > 0) == island.has_value());
            if (island) CHECK(one[p] <= world.graph.islands()[*island].area + 1e-9);
            if (island && range == 20) CHECK(one[p] == Approx(world.graph.islands()[*island].area));
        }
        SampleOptions options{.count = 20, .random_yaw = true, .measures = measures};
        options.measures.columns = {PlaceQuantity::Room};
        options.measures.prefer = {{PlaceQuantity::Room, 1}};
        const SpawnList list = sample(world.judge, options);
        for (std::size_t i = 0; i < list.spawns.size(); ++i) {
            const Spawn& spawn = list.spawns[i];
            const Pose pose{spawn.position, rotation_of_rpy(spawn.roll, spawn.pitch, spawn.yaw)};
            CHECK(list.columns[0].values[i] == measures.room(pose));
            CHECK(list.columns[0].values[i] > 0);  // a place with the density 0 is never drawn
        }
    }
    CHECK(known > 50);
    CHECK_THROWS_WITH(room_on(world.graph, 101), "room_on: range is 101, needs > 0 and at most 100 m");
    CHECK_THROWS_WITH(room_on(ReachGraph(world.judge, {.step = 0.4}), 3), Catch::Matchers::Contains("ways"));
}

TEST_CASE("On a path, the robot collides nowhere between its poses")
{
    int pieces = 0;
    for (const std::uint64_t seed : {5, 6, 7}) {
        const PathWorld world(random_walls(seed), boxy({0.5, 0.3, 0.25}), {.step = 0.15});
        PathSearch search(world.graph);
        Random random(seed);
        for (int k = 0; k < 40; ++k) {
            const auto pose = [&] {
                return world.at(random.between(-2, 2), random.between(-2, 2), random.between(-3, 3));
            };
            const auto path = search.path(pose(), pose());
            if (!path) continue;
            double length = 0;
            for (std::size_t p = 1; p < path->poses.size(); ++p) {
                const SettledPose &from = path->poses[p - 1], &to = path->poses[p];
                CAPTURE(seed, k, p);
                const Vec3 move = to.position - from.position;
                const double turn = turn_between(from.yaw, to.yaw), step = move.norm();
                CHECK(std::abs(turn) < 0.47);  // the largest turn between two headings of the graph
                length += step;
                // On curves, the robot leaves the straight line; the test of the graph covers them. All others go
                // ahead or back, or turn on the spot.
                if (step > 1e-9 && std::abs(turn) > 1e-9) continue;
                ++pieces;
                for (int part = 0; part <= 8; ++part) {
                    const double t = part / 8.0;
                    const Pose between{from.position + t * move + world.judge.options().stand.lift * Vec3::UnitZ(),
                                       rotation_of_rpy(0, 0, from.yaw + t * turn)};
                    CHECK(world.judge.check(between).verdict == Verdict::Valid);
                }
            }
            CHECK(path->length >= length - 1e-6);  // the chords of curves are shorter
            CHECK(path->length <= length * 1.03 + 1e-6);
        }
    }
    CHECK(pieces > 500);
}

TEST_CASE("The path of a car turns only along curves")
{
    Scene scene = level_floor();
    add_wall(scene, {-0.05, -2}, {0.05, 0.3});
    const double radius = 0.45;
    const PathWorld world(std::move(scene), boxy({0.3, 0.2, 0.2}),
                          {.drive = Drive::Car, .turning_radius = radius, .step = 0.125});
    PathSearch search(world.graph);
    const auto path = search.path(world.at(-1, -0.5), world.at(1, -0.5, std::numbers::pi / 2));
    REQUIRE(path);
    double turned = 0;
    for (std::size_t k = 0; k < path->poses.size(); ++k) {
        CHECK(path->poses[k].verdict == Verdict::Valid);
        if (k < 2 || k + 1 >= path->poses.size()) continue;  // the ends are joined with the grid
        const SettledPose &a = path->poses[k - 1], &b = path->poses[k];
        const double turn = std::abs(std::remainder(b.yaw - a.yaw, 2 * std::numbers::pi)),
                     distance = (b.position - a.position).head<2>().norm();
        CHECK(distance > 0);
        CHECK(distance < 0.125 * std::sqrt(5) + 1e-9);
        CHECK(2 * radius * std::sin(turn / 2) <= distance + 1e-9);  // the chord of an arc
        turned += turn;
    }
    CHECK(turned > 1);
    CHECK(path->length > 2.5);
}

TEST_CASE("In the open, a path is the straight line, at any heading")
{
    const PathWorld world(level_floor(), boxy({0.5, 0.3, 0.25}), {.step = 0.25});
    PathSearch search(world.graph);
    const auto length = [&](const SettledPose& start, const SettledPose& goal) {
        return search.path(start, goal)->length;
    };
    CHECK_THAT(length(world.at(-1, 0), world.at(1, 0)), Catch::Matchers::WithinAbs(2, 1e-9));
    CHECK_THAT(length(world.at(-1, 0, std::numbers::pi / 2), world.at(1, 0, std::numbers::pi)),
               Catch::Matchers::WithinAbs(2, 1e-9));
    CHECK_THAT(length(world.at(-1, -0.5), world.at(1, 0.5)), Catch::Matchers::WithinAbs(std::sqrt(5), 1e-9));
    CHECK_THAT(length(world.at(-1.03, -0.77, 2), world.at(0.91, 1.13, -1)),
               Catch::Matchers::WithinAbs(std::hypot(1.94, 1.9), 1e-9));
    CHECK_FALSE(search.path(world.at(-1, 0), world.at(1, 0), 1.99));
    CHECK(search.path(world.at(-1, 0), world.at(1, 0), 2.01));
    // The start, seven stops in between, and the goal: 0.25 m apart, without a turn.
    CHECK(search.path(world.at(-1, 0), world.at(1, 0))->poses.size() == 9);
}

TEST_CASE("In the open, paths have the length that searches take as their lower limit")
{
    const Lattice lattice;
    for (int heading = 0; heading < lattice_headings; ++heading)
        for (const Way way : {Way::Ahead, Way::Left, Way::Right}) {
            const LatticeMove move = lattice.end(way, heading).move;
            CHECK(open_length(move.cols, move.rows) == Approx(lattice.length(way, heading)).epsilon(1e-12));
        }
    const PathWorld world(level_floor(), boxy({0.5, 0.3, 0.25}), {.step = 0.125});
    PathSearch::Impl search(std::make_shared<const PathGraph>(world.graph.impl()));
    for (int cols = -7; cols <= 7; ++cols)
        for (int rows = -7; rows <= 7; ++rows) {
            CAPTURE(cols, rows);
            const double length = open_length(cols, rows), straight = std::hypot(cols, rows);
            CHECK(length >= straight * (1 - 1e-12));
            CHECK(length <= 1.02 * straight);
            // Not each end is a sum of few moves. The poses are near the middle, where all ways are free.
            const double found = *graph_length(search, world.at(0, 0), world.at(cols * 0.125, rows * 0.125)) / 0.125;
            CHECK(found >= length * (1 - 1e-12));
            CHECK(found <= length + 0.5);
        }
}

namespace {

/// A floor of 8 x 8 m with posts at random, and a second floor 0.2 m above a part of it, on which the robot can drive.
Scene random_posts(std::uint64_t seed)
{
    Scene scene;
    add_block(scene, {-4, -4, -0.5}, {4, 4, 0});
    if (seed % 2 == 1) add_block(scene, {2, -4, 1}, {4, -2, 1.2});
    Random random(seed);
    for (int k = 0; k < 6; ++k) {
        const Vec2 at(random.between(-3, 3), random.between(-3, 3));
        add_wall(scene, at, at + Vec2(random.between(0.05, 0.8), random.between(0.05, 0.8)));
    }
    return scene;
}

/// Returns the lowest cost, and with it the fewest turns, from a state to each state of a graph: Dijkstra's algorithm
/// without estimates, for all ways of all states.
std::vector<std::pair<PathCost, int>> plain_search(const PathGraph& graph, std::uint64_t start)
{
    using Cost = std::pair<PathCost, int>;
    std::vector<Cost> out(graph.graph().ground.size() * lattice_headings, {std::numeric_limits<PathCost>::max(), 0});
    std::set<std::pair<Cost, std::uint64_t>> queue{{{0, 0}, start}};
    out[start] = {0, 0};
    while (!queue.empty()) {
        const auto [cost, state] = *queue.begin();
        queue.erase(queue.begin());
        graph.for_each_neighbour(state, PathGraph::all_directions, [&, known = cost](std::uint64_t next, PathCost way) {
            const Cost sum{known.first + way, known.second + (way == 0 ? 1 : 0)};
            if (sum >= out[next]) return;
            queue.erase({out[next], next});
            out[next] = sum;
            queue.insert({sum, next});
        });
    }
    return out;
}

}  // namespace

TEST_CASE("The legs of groups are the ways of their states, also on level ground, where they are not stored")
{
    for (const std::uint64_t seed : {1, 2, 3}) {
        const Drive drive = seed == 2 ? Drive::Omni : Drive::Differential;
        const PathWorld world(random_posts(seed), boxy({0.4, 0.3, 0.25}), {.drive = drive, .step = 0.2});
        const PathGraph graph(world.graph.impl());
        using Leg = std::tuple<PathGraph::Group, PathGraph::Group, PathCost>;
        std::set<Leg> of_groups, of_states;
        for (PathGraph::Group from = 0; from < graph.groups(); ++from)
            graph.for_each_leg(from, [&](PathGraph::Group to, PathCost cost) { of_groups.insert({from, to, cost}); });
        for (std::size_t place = 0; place < world.graph.impl()->ground.size(); ++place)
            for (int heading = 0; heading < lattice_headings; ++heading) {
                if (!has_heading(world.graph.impl()->valid[place], heading)) continue;
                const std::uint64_t state = place * lattice_headings + std::uint64_t(heading);
                graph.for_each_neighbour(state, PathGraph::all_directions, [&](std::uint64_t next, PathCost cost) {
                    if (cost > 0) of_states.insert({graph.group_of(state), graph.group_of(next), cost});
                });
            }
        CHECK(of_groups == of_states);
        CHECK(of_groups.size() > 10000);
    }
}

TEST_CASE("Searches that leave out legs and groups find the paths of a search that does not")
{
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        const Drive drive = seed == 2 ? Drive::Omni : Drive::Differential;
        const PathWorld world(random_posts(seed), boxy({0.4, 0.3, 0.25}), {.drive = drive, .step = 0.2});
        const auto graph = std::make_shared<const PathGraph>(world.graph.impl());
        PathSearch::Impl search(graph);
        Random random(seed);
        const auto any_state = [&] {
            for (;;) {
                const auto place = std::size_t(random.between(0, double(world.graph.impl()->ground.size())));
                const int heading = int(random.between(0, lattice_headings));
                if (has_heading(world.graph.impl()->valid[place], heading))
                    return std::uint64_t(place) * lattice_headings + std::uint64_t(heading);
            }
        };
        for (int k = 0; k < 4; ++k) {
            const std::uint64_t start = any_state();
            const auto expected = plain_search(*graph, start);
            for (int goal = 0; goal < 100; ++goal) {
                const std::uint64_t end = any_state();
                const auto found = search.find(start, end, 1e3);
                CAPTURE(seed, start, end);
                REQUIRE(found.has_value() == (expected[end].first != std::numeric_limits<PathCost>::max()));
                if (!found) continue;
                CHECK(*found == double(expected[end].first) * nanometre);
                CHECK(graph->at_least(graph->group_of(start), graph->group_of(end)) <= expected[end].first);
                CHECK(turns_of(search.states()) == expected[end].second);
            }
        }
    }
}

TEST_CASE("A path that is one straight way is the one that shortening finds")
{
    const PathWorld world(random_posts(5), boxy({0.4, 0.3, 0.25}), {.step = 0.2});
    const auto graph = std::make_shared<const PathGraph>(world.graph.impl());
    PathSearch::Impl search(graph);
    Random random(5);
    int straight = 0, others = 0;
    for (int k = 0; k < 80; ++k) {
        const auto pose = [&] { return world.at(random.between(-4, 4), random.between(-4, 4), random.between(-3, 3)); };
        const auto start = search.end_of(pose()), goal = search.end_of(pose());
        if (!start || !goal || !search.find(*start, *goal, 1e3)) continue;
        const ShortPath found = search.path(*start, *goal, true);
        std::vector<Stop> stops{start->stop};
        std::vector<double> lengths{start->length};
        const std::vector<std::uint64_t> states = search.states();
        for (std::size_t i = 0; i < states.size(); ++i) {
            stops.push_back({graph->ground_of(states[i]), lattice_yaw(int(states[i] % lattice_headings))});
            PathCost least = std::numeric_limits<PathCost>::max();
            if (i + 1 < states.size())
                graph->for_each_neighbour(states[i], PathGraph::all_directions, [&](std::uint64_t to, PathCost cost) {
                    if (to == states[i + 1]) least = std::min(least, cost);
                });
            lengths.push_back(i + 1 < states.size() ? double(least) * nanometre : goal->length);
        }
        stops.push_back(goal->stop);
        const ShortPath expected = shortened(*world.graph.impl(), stops, lengths);
        CHECK(found.length == expected.length);
        REQUIRE(found.stops.size() == expected.stops.size());
        for (std::size_t i = 0; i < found.stops.size(); ++i) {
            CHECK(found.stops[i].ground == expected.stops[i].ground);
            CHECK(found.stops[i].yaw == expected.stops[i].yaw);
        }
        ++(StraightWays(*world.graph.impl()).find(start->stop, goal->stop) ? straight : others);
    }
    CHECK(straight > 5);
    CHECK(others > 5);
}

TEST_CASE("In a maze, a path is at most 1 % longer than the shortest one")
{
    // A round robot: its middle keeps its radius from the walls. So the shortest path is a rubber band around circles
    // about the ends of two walls, one from below and one from above.
    constexpr double radius = 0.2, wall = 0.1;
    Scene scene;
    add_block(scene, {-3, -2, -0.5}, {3, 2, 0});
    add_wall(scene, {-1 - wall / 2, -2.5}, {-1 + wall / 2, 1});
    add_wall(scene, {1 - wall / 2, -1}, {1 + wall / 2, 2.5});
    Robot robot = make_robot("round", {shape_part(cylinder_shape(radius, 0.3, {{0, 0, 0.15}}))});
    robot.mass_center = Vec3(0, 0, 0.1);
    const Vec2 start(-2.53, -1.51), first(-1 - wall / 2, 1), second(-1 + wall / 2, 1), third(1 - wall / 2, -1);
    const double to_first = (first - start).norm(), across = (third - second).norm();
    const auto direction = [](const Vec2& way) { return std::atan2(way.y(), way.x()); };
    // Tangents: the first circle is on the right of the path, the third one on its left.
    const double up = direction(first - start) + std::asin(radius / to_first),
                 down = direction(third - second) - std::asin(2 * radius / across);
    const double shortest = 2 * (std::sqrt(to_first * to_first - radius * radius) + radius * (up - down) + wall) +
                            std::sqrt(across * across - 4 * radius * radius);
    const PathWorld world(scene, robot, {.step = 0.1});
    const auto path = PathSearch(world.graph).path(world.at(start.x(), start.y()), world.at(-start.x(), -start.y()));
    REQUIRE(path);
    CAPTURE(shortest);
    CHECK(path->length >= shortest - 1e-6);
    CHECK(path->length <= 1.01 * shortest);
}

TEST_CASE("A path search needs a graph that keeps its ways")
{
    const TestMap map = map_of(level_floor());
    const Judge judge(map, boxy({0.5, 0.3, 0.25}));
    const ReachGraph graph(judge, {.step = 0.5});
    CHECK_THROWS_WITH(PathSearch(graph), Contains("does not keep its ways"));
}

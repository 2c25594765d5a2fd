#include "arena.h"
#include "catch.h"
#include "compare.h"
#include "reach/disjoint_sets.h"
#include "reach/head_room.h"
#include "reach/level_ground.h"
#include "reach/reach_graph.h"
#include "reach/way_judge.h"
#include "rest_robots.h"
#include "shared_scenes.h"
#include "slow_reach.h"
#include "test_map.h"

#include <spawnfield/column.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

using namespace spawnfield;
using rest_robots::add_block;
using rest_robots::boxy;
using rest_robots::rad;
using rest_robots::wheeled;

// Tests of the drivable graph and its islands.

namespace {

using Impl = ReachGraph::Impl;

constexpr int headings = lattice_headings;

Bounds box_of(const Vec3& low, const Vec3& high)
{
    Bounds out;
    out.extend(low);
    out.extend(high);
    return out;
}

void add_obstacle(Scene& scene, const Vec3& low, const Vec3& high)
{
    add_shape(scene, "obstacle", Label::Obstacle, box_shape(high - low, {(low + high) / 2}));
}

/// Calls visit(state) for each state of a graph.
template <class Visit>
void for_each_state(const Impl& graph, const Visit& visit)
{
    for (int row = 0; row < graph.grid.rows; ++row)
        for (int col = 0; col < graph.grid.cols; ++col) {
            const std::size_t begin = graph.first[graph.column_of(col, row)];
            for (std::size_t p = begin; p < graph.first[graph.column_of(col, row) + 1]; ++p)
                for (int k = 0; k < headings; ++k)
                    if (has_heading(graph.valid[p], k)) visit(slow::Reach::State{col, row, int(p - begin), k}, p);
        }
}

std::uint32_t island_at(const Impl& graph, std::size_t place, int heading)
{
    return graph.node_islands[graph.node_of(place, heading)];
}

/// Returns the index of the place in its column to which a way of the graph leads.
std::optional<int> target_of(const Impl& graph, std::size_t place, int heading, Way way)
{
    const std::vector<Impl::Ways>& ways = graph.ways[std::size_t(way)];
    if (ways.empty()) return std::nullopt;
    const std::uint8_t index = ways[place][std::size_t(heading)];
    return index == Impl::nowhere ? std::nullopt : std::optional<int>(index);
}

struct Compared {
    std::size_t states = 0, islands = 0;
    std::array<std::size_t, way_count> ways{}, no_ways{};
};

void compare_places(const Impl& graph, const slow::Reach& expected)
{
    for (int row = 0; row < graph.grid.rows; ++row)
        for (int col = 0; col < graph.grid.cols; ++col) {
            const std::size_t begin = graph.first[graph.column_of(col, row)];
            const std::vector<slow::ReachPlace>& places = expected.places(col, row);
            REQUIRE(graph.first[graph.column_of(col, row) + 1] - begin == places.size());
            for (std::size_t k = 0; k < places.size(); ++k) {
                REQUIRE(graph.ground[begin + k] == places[k].ground);
                for (int heading = 0; heading < headings; ++heading)
                    REQUIRE(has_heading(graph.valid[begin + k], heading) ==
                            places[k].poses[std::size_t(heading)].has_value());
            }
        }
}

/// Compares the ways of a graph and its islands with the definition.
void compare_ways(const Impl& graph, const slow::Reach& expected, Compared& out)
{
    std::map<slow::Reach::State, std::uint32_t> numbers;
    std::vector<std::uint32_t> islands;
    for_each_state(graph, [&](const slow::Reach::State& state, std::size_t place) {
        numbers.emplace(state, std::uint32_t(numbers.size()));
        islands.push_back(island_at(graph, place, state[3]));
    });
    DisjointSets sets;
    sets.grow(numbers.size());
    for_each_state(graph, [&](const slow::Reach::State& state, std::size_t place) {
        for (const Way way : all_ways) {
            if (way == Way::Aside && !goes_aside(*graph.options.drive)) continue;
            if (way == Way::Turn && graph.options.drive == Drive::Car) continue;
            CAPTURE(state, int(way));
            const std::optional<int> target = expected.target(state, way);
            ++(target ? out.ways : out.no_ways)[std::size_t(way)];
            const std::optional<int> found = target_of(graph, place, state[3], way);
            CHECK(found.has_value() == target.has_value());
            if (!target) continue;
            if (way != Way::Turn) CHECK(found == target);
            const WayEnd end = graph.lattice.end(way, state[3]);
            sets.join(numbers.at(state),
                      numbers.at({state[0] + end.move.cols, state[1] + end.move.rows, *target, end.heading}));
        }
    });
    // Islands and connected parts must correspond one to one.
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::set<std::uint32_t> roots, found;
    for (std::uint32_t i = 0; i < islands.size(); ++i) {
        pairs.emplace(sets.find(i), islands[i]);
        roots.insert(sets.find(i));
        found.insert(islands[i]);
    }
    CHECK(pairs.size() == roots.size());
    CHECK(pairs.size() == found.size());
    CHECK(found.size() == graph.islands.size());
    out.states += islands.size();
    out.islands += found.size();
}

void compare_graph(const TestMap& map, const Robot& robot, const JudgeOptions& limits, const ReachOptions& options,
                   Compared& out)
{
    const Judge judge(map, robot, limits);
    const Impl graph(judge, options, Impl::Keep::Ways), islands_only(judge, options);
    CHECK(graph.node_islands == islands_only.node_islands);
    Scene surfaces = map.scene;
    for (Piece& piece : surfaces.pieces) piece.solid = false;
    const slow::Reach expected(judge, graph.options, graph.grid, Geometry(surfaces));
    compare_places(graph, expected);
    compare_ways(graph, expected, out);
}

/// Returns the robot with boxes in the place of its round parts.
Robot without_round_parts(const Robot& robot)
{
    std::vector<RobotPart> parts;
    for (const RobotPart& part : robot.parts) {
        const Bounds box = part.bounds();
        const bool is_round = part.shape.kind != ShapeKind::Box && part.shape.kind != ShapeKind::Hull;
        parts.push_back(is_round ? shape_part(box_shape(box.max - box.min, {(box.min + box.max) / 2})) : part);
    }
    return make_robot("boxes", std::move(parts));
}

/// A floor, whose mesh has cells of some length, and heights that differ by up to `rough` from 0.
void add_floor(Scene& scene, Random& random, double half, double cell, double rough)
{
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    const int n = int(std::lround(2 * half / cell));
    for (int row = 0; row <= n; ++row)
        for (int col = 0; col <= n; ++col)
            vertices.push_back({-half + col * cell, -half + row * cell, random.between(-rough, rough)});
    const auto index = [&](int col, int row) { return std::uint32_t(row * (n + 1) + col); };
    for (int row = 0; row < n; ++row)
        for (int col = 0; col < n; ++col) {
            triangles.push_back({index(col, row), index(col + 1, row), index(col + 1, row + 1)});
            triangles.push_back({index(col, row), index(col + 1, row + 1), index(col, row + 1)});
        }
    add_mesh(scene, "floor", Label::Terrain, vertices, triangles);
}

/// A floor with blocks, walls, tables, kerbs and plates on it, in it and above it.
Scene furnished(std::uint64_t seed, double half)
{
    Random random(seed);
    Scene scene;
    if (random.chance(0.2))
        add_block(scene, {-half, -half, -1}, {half, half, 0});
    else
        add_floor(scene, random, half, random.chance(0.5) ? half : half / 2, random.chance(0.5) ? 0 : 2e-5);
    const int count = 1 + random.below(8);
    for (int k = 0; k < count; ++k) {
        const double x = random.between(-half, half), y = random.between(-half, half), wide = random.between(0.02, 1);
        const double low = random.chance(0.4) ? random.between(-0.5, 0.8) : 0,
                     high = low + (random.chance(0.5) ? random.between(0.005, 0.1) : random.between(0.1, 1));
        const Label label = random.chance(0.5) ? Label::Obstacle : Label::Terrain;
        const Mat3 turned = rotation_of_rpy(0, 0, random.chance(0.5) ? random.between(-3, 3) : 0);
        const Pose pose{{x, y, (low + high) / 2}, turned};
        switch (random.below(4)) {
        case 0: add_shape(scene, "post", label, cylinder_shape(wide / 2, high - low, pose)); break;
        case 1: add_shape(scene, "ball", label, sphere_shape(wide / 2, pose.position)); break;
        default: add_shape(scene, "block", label, box_shape({wide, random.between(0.02, 2), high - low}, pose));
        }
    }
    return scene;
}

/// Level ground with walls, on which robots of all sizes rest alike.
Scene walled(std::uint64_t seed)
{
    Scene scene;
    Random random(seed);
    add_block(scene, {-2, -2, -0.5}, {2, 2, 0});
    for (int k = 0; k < 6; ++k) {
        const Pose pose{{random.between(-2, 2), random.between(-2, 2), 0.3},
                        rotation_of_rpy(0, 0, random.between(-3, 3))};
        add_shape(scene, "wall", Label::Obstacle, box_shape({random.between(0.1, 1.5), 0.1, 0.6}, pose));
    }
    return scene;
}

/// Robots of which LevelGround must prove much, little or nothing.
std::vector<Robot> robots_of_all_kinds()
{
    std::vector<Robot> out{boxy({0.5, 0.3, 0.25}), wheeled(), rest_robots::on_balls(0.05), rest_robots::on_skids()};
    const auto add = [&](const char* name, std::vector<RobotPart> parts, std::optional<Vec3> mass_center = {}) {
        out.push_back(make_robot(name, std::move(parts)));
        out.back().mass_center = mass_center;
    };
    add("drum", {shape_part(cylinder_shape(0.3, 0.2, {{0, 0, 0.1}}))});
    add("drum, off its middle", {shape_part(cylinder_shape(0.3, 0.2, {{0.1, 0, 0.1}}))}, Vec3(0.38, 0.06, 0.1));
    add("large drum", {shape_part(cylinder_shape(8, 1, {{0, 0, 0.5}}))});
    add("three discs", {shape_part(cylinder_shape(0.05, 0.1, {{0.2, 0, 0.05}})),
                        shape_part(cylinder_shape(0.05, 0.1, {{-0.2, 0.2, 0.05}})),
                        shape_part(cylinder_shape(0.05, 0.1, {{-0.2, -0.2, 0.05}})),
                        shape_part(box_shape({0.5, 0.5, 0.1}, {{0, 0, 0.15}}))});
    add("tilted",
        {shape_part(sphere_shape(0.1, {0.2, 0, 0.1})), shape_part(sphere_shape(0.1, {-0.2, 0.2, 0.1})),
         shape_part(sphere_shape(0.1, {-0.2, -0.2, 0.101})), shape_part(box_shape({0.4, 0.4, 0.1}, {{0, 0, 0.2}}))});
    add("near the edge", {shape_part(box_shape({0.5, 0.3, 0.2}, {{0, 0, 0.1}}))}, Vec3(0.2479, 0, 0.1));
    add("rather near the edge", {shape_part(box_shape({0.5, 0.3, 0.2}, {{0, 0, 0.1}}))}, Vec3(0.245, 0, 0.1));
    add("large wheels", {shape_part(cylinder_shape(3, 1, {{3, 0, 3}, rotation_of_rpy(std::numbers::pi / 2, 0, 0)})),
                         shape_part(cylinder_shape(3, 1, {{-3, 0, 3}, rotation_of_rpy(std::numbers::pi / 2, 0, 0)})),
                         shape_part(cylinder_shape(6.5, 1, {{0, 0, 6}}))});
    add("high", {shape_part(box_shape({0.3, 0.3, 2}, {{0, 0, 1}}))});
    add("above its origin", {shape_part(box_shape({0.5, 0.3, 0.2}, {{0, 0, 0.4}}))});
    add("below its origin", {shape_part(box_shape({0.5, 0.3, 0.2}, {{0.1, 0, -0.4}}))});
    return out;
}

/// Returns half of the side of a furnished() floor for a robot, m.
double half_of_world(const Robot& robot)
{
    const Vec3 size = robot.bounds().max - robot.bounds().min;
    return 2 * std::max(size.x(), size.y());
}

/// Counts the states of a map that LevelGround proves, and checks them with Judge::settle. Also checks poses at other
/// headings on the same places.
std::size_t check_proven(const TestMap& map, const Robot& robot, double step, const JudgeOptions& limits = {})
{
    const Judge judge(map, robot, limits);
    const Lattice lattice;
    WayJudge ways(judge.impl(), 0.03, lattice, step / lattice.longest());
    std::size_t proven = 0;
    std::vector<PlaceStates> places;
    DetailsStore details;
    for (double y = map.bounds.min.y(); y <= map.bounds.max.y(); y += step)
        for (double x = map.bounds.min.x(); x <= map.bounds.max.x(); x += step) {
            places.clear();
            details.clear();
            ways.find_places({x, y}, places, details);
            for (const PlaceStates& place : places) {
                const Vec3 ground(x, y, place.ground);
                const double yaw = std::remainder(x + 3 * y, std::numbers::pi);
                const SettledPose aside = judge.settle(ground, yaw);
                const auto standing = ways.stand(ground, yaw);
                CAPTURE(robot.name, x, y, place.ground, yaw);
                REQUIRE(standing.has_value() == (aside.verdict == Verdict::Valid));
                if (standing) {
                    CHECK(standing->ground.z() == aside.ground->height);
                    CHECK(std::abs(standing->pose.z - aside.position.z()) <=
                          (standing->pose.is_exact ? 0 : LevelGround::tolerance));
                }
                for (int k = 0; k < headings; ++k) {
                    if (!has_heading(place.valid, k)) continue;
                    const StatePose state = place.pose(k);
                    if (state.is_exact) continue;
                    ++proven;
                    const SettledPose pose = judge.settle(ground, lattice_yaw(k));
                    CAPTURE(k, place.is_open);
                    CHECK(to_string(pose.verdict) == to_string(Verdict::Valid));
                    CHECK(std::abs(pose.position.z() - state.z) <= LevelGround::tolerance);
                    CHECK(pose.tilt * robot.bounds().max.norm() <= LevelGround::tolerance);
                }
            }
        }
    return proven;
}

/// Returns the islands at the places nearest to a point: one for each heading, or none if it is farther than a step.
std::set<std::uint32_t> islands_near(const Impl& graph, const Vec3& point)
{
    std::set<std::uint32_t> out;
    double nearest = 1.5 * graph.grid.step;
    graph.for_each_place([&](std::size_t p, int col, int row) {
        const double distance = (Vec3(graph.grid.x_of(col), graph.grid.y_of(row), graph.ground[p]) - point).norm();
        if (!(distance < nearest)) return;
        nearest = distance;
        out.clear();
        for (std::uint32_t node = graph.first_node[p]; node < graph.first_node[p + 1]; ++node)
            out.insert(graph.node_islands[node]);
    });
    return out;
}

/// Returns whether the robot can drive from one point to another one, with some headings.
bool is_joined(const Impl& graph, const Vec3& a, const Vec3& b)
{
    const std::set<std::uint32_t> of_a = islands_near(graph, a), of_b = islands_near(graph, b);
    REQUIRE(!of_a.empty());
    REQUIRE(!of_b.empty());
    return std::any_of(of_a.begin(), of_a.end(), [&](std::uint32_t island) { return of_b.contains(island); });
}

Impl graph_of(const TestMap& map, const Robot& robot, const ReachOptions& options = {}, const JudgeOptions& limits = {},
              Impl::Keep keep = Impl::Keep::Islands)
{
    return {Judge(map, robot, limits), options, keep};
}

/// Two floors, at 0 and at a height, with a ramp between them from x = 0.
Scene ramp(double angle, double height)
{
    const double length = height / std::tan(angle);
    Scene scene;
    const std::vector<Vec3> profile{{-2, 0, 0}, {0, 0, 0}, {length, 0, height}, {length + 2, 0, height}};
    std::vector<Vec3> vertices;
    for (const Vec3& point : profile)
        for (const double y : {-1.0, 1.0}) vertices.push_back({point.x(), y, point.z()});
    std::vector<Triangle> triangles;
    for (std::uint32_t k = 0; k + 3 < vertices.size(); k += 2) {
        triangles.push_back({k, k + 2, k + 1});
        triangles.push_back({k + 1, k + 2, k + 3});
    }
    add_mesh(scene, "ramp", Label::Terrain, vertices, triangles);
    return scene;
}

/// A ramp around the z axis, with turns of 1.5 m height, and a floor below.
Scene spiral(int turns)
{
    constexpr int sides = 24;
    constexpr double inner = 0.8, outer = 2, rise = 1.5;
    Scene scene;
    add_block(scene, {-3, -3, -0.5}, {3, 3, 0});
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    for (int k = 0; k <= sides * turns; ++k) {
        const double angle = 2 * std::numbers::pi * k / sides, z = rise * k / sides;
        for (const double radius : {inner, outer})
            vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
    for (std::uint32_t k = 0; k + 3 < vertices.size(); k += 2) {
        triangles.push_back({k, k + 1, k + 2});
        triangles.push_back({k + 1, k + 3, k + 2});
    }
    add_mesh(scene, "spiral", Label::Terrain, vertices, triangles, Solid::No);
    return scene;
}

}  // namespace

TEST_CASE("each way of the lattice has a reverse")
{
    for (const double radius : {0.0, 1.0, 5.3, 40.0}) {
        CAPTURE(radius);
        const Lattice lattice(radius);
        for (int k = 0; k < headings; ++k) {
            const int back = lattice_heading(k, headings / 2);
            const auto is_reverse = [&](Way way, int heading, Way other, int other_heading) {
                const LatticeMove sum = lattice.end(way, heading).move + lattice.end(other, other_heading).move;
                return sum.cols == 0 && sum.rows == 0;
            };
            CHECK(is_reverse(Way::Ahead, k, Way::Ahead, back));
            CHECK(is_reverse(Way::Aside, k, Way::Aside, back));
            // The end of a curve to the left is the beginning of one to the right, for a robot that has turned around.
            const WayEnd left = lattice.end(Way::Left, k);
            const int turned = lattice_heading(left.heading, headings / 2);
            CHECK(is_reverse(Way::Left, k, Way::Right, turned));
            CHECK(lattice.end(Way::Right, turned).heading == back);
            CHECK(lattice.end(Way::Turn, k).heading == lattice_heading(k, 1));
            CHECK(std::abs(left.move.rows) <= lattice.longest_rows());
            CHECK(left.move.length() <= lattice.longest());
        }
    }
    CHECK(Lattice().longest_rows() == 3);
}

TEST_CASE("the arcs of a car have at least its turning radius, and hardly more moves than needed")
{
    for (const double radius : {0.1, 1.0, 4.2, 5.3, 40.0}) {
        const Lattice lattice(radius);
        for (int k = 0; k < headings; ++k)
            for (const Way way : {Way::Left, Way::Right}) {
                CAPTURE(radius, k);
                const Curve curve = lattice.curve(way, k);
                CHECK(curve.radius() >= radius * (1 - 1e-9));
                CHECK((curve.first == 0 || curve.last == 0));
                // With one move less on each line, the arc would be too small, unless there is only one.
                const double moves = lattice.corner(way, k).length() / lattice_move(k).length();
                const double tangent = radius * std::tan(curve.turn / 2);
                CHECK((moves == 1 || (moves - 1) * lattice_move(k).length() < tangent));
            }
    }
}

TEST_CASE("the yaws of the lattice agree with its moves, and curves end tangentially")
{
    double before = lattice_yaw(headings - 1) - 2 * std::numbers::pi;
    for (int k = 0; k < headings; ++k) {
        const double yaw = lattice_yaw(k);
        const LatticeMove move = lattice_move(k);
        CHECK(move.length() * std::cos(yaw) == Approx(move.cols).margin(1e-12));
        CHECK(move.length() * std::sin(yaw) == Approx(move.rows).margin(1e-12));
        const double turn = std::remainder(yaw - before, 2 * std::numbers::pi);
        CHECK(turn > 0.3);
        CHECK(turn < 0.5);
        before = yaw;
        // From the corner of a curve, the move at its last heading leads to its end.
        const Lattice lattice;
        for (const Way way : {Way::Left, Way::Right}) {
            const WayEnd end = lattice.end(way, k);
            const LatticeMove last = lattice_move(end.heading);
            CHECK(end.move.cols - move.cols == last.cols);
            CHECK(end.move.rows - move.rows == last.rows);
        }
        const LatticeMove aside = lattice.end(Way::Aside, k).move;
        CHECK(aside.cols == -move.rows);
        CHECK(aside.rows == move.cols);
    }
}

TEST_CASE("the graph is that of its definition in random scenes")
{
    Compared all;
    for (std::uint64_t seed = 1; seed <= compare::scene_count() / 25; ++seed) {
        CAPTURE(seed);
        const HardCase hard = hard_case(seed, {.razor = false});
        Random random(seed);
        const Robot robot = without_round_parts(hard.robot);
        const double step = std::max(0.02, auto_reach_step(robot)) * random.between(0.5, 1.5);
        const TestMap whole = map_of(hard.scene, hard.resolution);
        const Bounds crop = compare::crop_near(whole, random, step, 7);
        const TestMap map = map_of(hard.scene, hard.resolution, crop);
        ReachOptions options{.drive = std::array{Drive::Differential, Drive::Car, Drive::Omni, Drive::Legged}[seed % 4],
                             .max_step = random.chance(0.5) ? 0.03 : random.between(0, 0.3),
                             .step = step,
                             .threads = 1};
        if (options.drive == Drive::Car) options.turning_radius = step * random.between(0.1, 12);
        compare_graph(map, robot, {.max_height = hard.max_height}, options, all);
    }
    if (!compare::all_scenes()) return;
    for (std::size_t way = 0; way < way_count; ++way) {
        CAPTURE(way);
        CHECK(all.ways[way] >= 500);
        CHECK(all.no_ways[way] >= 100);
    }
}

TEST_CASE("the graph is that of its definition on floors with walls, blocks and plates")
{
    Compared all;
    for (std::uint64_t seed = 1; seed <= (compare::scene_count() + 74) / 75; ++seed) {
        CAPTURE(seed);
        const TestMap map = map_of(furnished(seed, 0.8), 0.1);
        Robot robot = seed % 2 ? boxy({0.5, 0.3, 0.25}) : without_round_parts(wheeled());
        if (seed % 2 == 0) robot = enlarged(robot, 0.5);
        ReachOptions options{.drive = std::array{Drive::Omni, Drive::Car, Drive::Differential, Drive::Omni}[seed % 4],
                             .step = 0.16,
                             .threads = 1};
        if (options.drive == Drive::Car) options.turning_radius = 1;
        compare_graph(map, robot, {}, options, all);
    }
    if (!compare::all_scenes()) return;
    for (std::size_t way = 0; way < way_count; ++way) {
        CAPTURE(way);
        CHECK(all.ways[way] >= 300);
        CHECK(all.no_ways[way] >= 200);
    }
}

TEST_CASE("states that are proven without letting the robot down are valid")
{
    std::map<std::string, std::size_t> proven;
    const std::vector<Robot> robots = robots_of_all_kinds();
    for (std::uint64_t seed = 1; seed <= compare::scene_count() / 10; ++seed) {
        CAPTURE(seed);
        const Robot& robot = robots[seed % robots.size()];
        const double half = half_of_world(robot);
        proven[robot.name] += check_proven(map_of(furnished(seed, half), 0.1), robot, half / 2.3);
    }
    if (!compare::all_scenes()) return;
    for (const Robot& robot : robots) {
        CAPTURE(robot.name);
        const std::set<std::string> difficult{"drum",   "drum, off its middle", "large drum",      "three discs",
                                              "tilted", "near the edge",        "above its origin"};
        CHECK((proven[robot.name] > 0) == !difficult.contains(robot.name));
    }
}

TEST_CASE("valid poses have the least head room of their robot, and not much more is proven of a box")
{
    const Robot box = make_robot("box", {shape_part(box_shape({0.6, 0.4, 0.3}, {{0, 0, 0.15}}))});
    const double radius = 0.15, aside = radius * std::sin(0.5);  // of a ball in the middle
    CHECK(least_head_room(box, 0.5) >= 2 * std::sqrt(radius * radius - aside * aside) - 1e-12);
    CHECK(least_head_room(box, 0.5) <= 0.3);
    Robot fork = box;  // with a prong below, on the axis
    fork.parts.push_back(shape_part(box_shape({0.6, 0.4, 0.02}, {{0, 0, -0.1}})));
    CHECK(least_head_room(fork, 0.5) < 0.021);
    Robot hollow = make_robot("hollow", {shape_part(box_shape({0.1, 0.1, 0.3}, {{0.3, 0, 0.15}}))});
    CHECK(least_head_room(hollow, 0.5) == 0);
    std::size_t too_low = 0, valid = 0;
    const std::vector<Robot> robots = robots_of_all_kinds();
    for (std::uint64_t seed = 1; seed <= compare::scene_count() / 10; ++seed) {
        CAPTURE(seed);
        const Robot& robot = robots[seed % robots.size()];
        const double half = half_of_world(robot);
        const Map map = map_of(furnished(seed, half), 0.1);
        const Judge judge(map, robot);
        const double least = least_head_room(robot, judge.options().stand.max_slope);
        Random random(seed);
        for (int n = 0; n < 200 && least > 0; ++n) {
            const double x = random.between(-half, half), y = random.between(-half, half);
            const Column column = column_at(map.geometry, x, y);
            for (const double layer : column.layers) {
                double room = 1e9;
                for (const Span& span : column.spans)
                    if (span.top > layer + layer_tolerance) room = std::min(room, span.bottom - layer);
                const bool is_valid = judge.settle({x, y, layer}, random.between(-3, 3)).verdict == Verdict::Valid;
                if (is_valid) CHECK(room >= least - 1e-6);
                valid += is_valid && room < 3 * least;
                too_low += room < least;
            }
        }
    }
    CHECK(too_low > 0);
    CHECK(valid > 0);
}

TEST_CASE("the place of all columns of a rectangle is the only one of each")
{
    const Robot robot = boxy({0.3, 0.2, 0.2});
    const Lattice lattice;
    constexpr double step = 0.08;
    std::size_t proven = 0, not_proven = 0;
    for (std::uint64_t seed = 1; seed <= compare::scene_count(); ++seed) {
        CAPTURE(seed);
        Random random(seed);
        Scene scene;
        const auto sheet = [&](const char* name, Label label, double x, double y, double z) {
            add_mesh(scene, name, label, {{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}}, {{0, 1, 2}, {0, 2, 3}});
        };
        if (random.chance(0.5))
            add_block(scene, {-4, -4, -0.3}, {4, 4, 0});
        else
            sheet("floor", Label::Terrain, 4, 4, 0);
        if (random.chance(0.4)) sheet("below", Label::Terrain, 4, random.between(1, 4), random.between(-0.5, -1e-6));
        if (random.chance(0.2)) sheet("above", Label::Terrain, random.between(0.1, 4), 4, random.between(1e-7, 2));
        if (random.chance(0.2)) sheet("pool", Label::Water, random.between(0.1, 2), 1, random.between(-1, 1));
        if (random.chance(0.4))
            add_shape(scene, "ball", random.chance(0.5) ? Label::Obstacle : Label::Terrain,
                      sphere_shape(random.between(0.01, 0.5),
                                   {random.between(-4, 4), random.between(-4, 4), random.between(-2, 2)}));
        const TestMap map = map_of(std::move(scene), 0.1);
        const Judge judge(map, robot);
        WayJudge ways(judge.impl(), 0.03, lattice, step);
        for (int n = 0; n < 10; ++n) {
            const Vec2 low(random.between(-3.5, 2.5), random.between(-3.5, 2.5)),
                high = low + Vec2(random.between(0, 1.2), random.between(0, 1.2));
            const auto same = ways.place_of_all(low, high);
            ++(same ? proven : not_proven);
            for (int k = 0; k < 20 && same; ++k) {
                std::vector<PlaceStates> places;
                DetailsStore details;
                ways.find_places({random.between(low.x(), high.x()), random.between(low.y(), high.y())}, places,
                                 details);
                REQUIRE(places.size() == 1);
                CHECK(places[0].is_open);
                CHECK(places[0].ground == same->ground);
                CHECK(places[0].valid == same->valid);
                CHECK(places[0].level_z == same->level_z);
            }
        }
    }
    CHECK(proven > 50);
    CHECK(not_proven > 50);
}

TEST_CASE("nothing is proven inside a mesh that is filled although it has holes")
{
    for (const Solid solid : {Solid::Auto, Solid::Yes})
        for (const Label label : {Label::Terrain, Label::Obstacle}) {
            Scene scene;  // a tunnel along x, without ends, with its floor on the ground
            Random random(1);
            add_floor(scene, random, 3, 1, 0);
            const std::vector<Vec3> corners{{-1, -2, 0}, {-1, 2, 0}, {-1, 2, 1}, {-1, -2, 1},
                                            {1, -2, 0},  {1, 2, 0},  {1, 2, 1},  {1, -2, 1}};
            add_mesh(scene, "tunnel", label, corners,
                     {{0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 6}, {2, 6, 3}, {3, 6, 7}, {3, 7, 0}, {0, 7, 4}}, solid);
            CHECK(check_proven(map_of(scene), boxy({0.6, 0.3, 0.3}), 0.17) > 0);
        }
}

TEST_CASE("nothing is proven beside holes, cracks and T-junctions of the ground, unless it is right")
{
    Scene scene;
    Random random(2);
    const double far = 2.5;
    // A hole in the middle; the mesh to the right of it has other corners on its edge than that to the left.
    const std::vector<Vec3> corners{{-far, -far, 0}, {0, -far, 0},   {0, far, 0},   {-far, far, 0}, {0, -0.3, 0},
                                    {0, 0.3, 0},     {far, -far, 0}, {far, far, 0}, {0.6, 0, 0}};
    add_mesh(scene, "left", Label::Terrain, corners, {{0, 1, 2}, {0, 2, 3}});
    add_mesh(scene, "right", Label::Terrain, corners, {{1, 6, 4}, {4, 6, 8}, {8, 6, 7}, {8, 7, 5}, {5, 7, 2}});
    // Terrain at another height, below which there is no floor.
    add_block(scene, {far, -far, -1}, {far + 1, far, -1e-4});
    for (const Robot& robot : {boxy({0.5, 0.3, 0.25}), wheeled(), rest_robots::on_balls(0.02)})
        CHECK(check_proven(map_of(scene), robot, 0.13) > 0);
}

TEST_CASE("a robot over an end of the ground is proven if its feet on the ground carry it")
{
    Scene scene;
    add_block(scene, {-2, -2, -1}, {2, 2, 0});
    const TestMap map = map_of(scene);
    const auto proves = [&](const Robot& robot, const Vec2& at, double yaw) {
        const Judge judge(map, robot);
        WayJudge ways(judge.impl(), 0.03, Lattice(), 0.1);
        const auto standing = ways.stand({at.x(), at.y(), 0}, yaw);
        return standing && !standing->pose.is_exact;
    };
    const Robot box = boxy({0.5, 0.3, 0.25});
    for (const double yaw : {0.0, 0.3, 2.0}) {
        CAPTURE(yaw);
        CHECK(proves(box, {1.98, 0}, yaw));
        CHECK(proves(box, {-1.98, 1.98}, yaw));
        CHECK_FALSE(proves(box, {1.998, 0}, yaw));  // its mass is too near to the end
        CHECK_FALSE(proves(box, {2, 0}, yaw));
    }
    CHECK(proves(wheeled(), {1.7, 0}, 0));                      // a part of its body is over the end
    CHECK_FALSE(proves(wheeled(), {1.8, 0}, 0));                // its front wheels, too
    CHECK(proves(wheeled(), {1.73, 0}, std::numbers::pi / 2));  // parts of two wheels
}

TEST_CASE("a robot that is proven to tip at an end of the ground does not stand there")
{
    std::size_t proven = 0, all = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        const double yaw = random.chance(0.3) ? 0 : random.between(-std::numbers::pi, std::numbers::pi);
        Scene scene;
        add_shape(scene, "floor", Label::Terrain, box_shape({8, 8, 1}, {{0, 0, -0.5}, rotation_from_rpy(0, 0, yaw)}));
        if (random.chance(0.3)) add_floor(scene, random, 6, 6, random.between(-1.5, -1e-3));
        Vec3 size(random.between(0.2, 1), random.between(0.2, 1), random.between(0.1, 0.6));
        Robot robot = boxy(size);
        robot.mass_center = size.cwiseProduct(Vec3(random.between(-0.3, 0.3), random.between(-0.3, 0.3), 0.5));
        if (random.chance(0.2)) robot.parts.push_back(shape_part(box_shape({0.01, 0.01, 0.01}, {{0, 0, size.z()}})));
        JudgeOptions options;
        options.stand.min_stability = random.between(0, 0.05);
        const TestMap map = map_of(scene, 0.2);
        const Judge judge(map, robot, options);
        LevelGround level(judge.impl());
        for (int n = 0; n < 10; ++n) {
            const double past = random.chance(0.3) ? 0 : random.between(0, random.chance(0.5) ? 0.01 : 0.3);
            const Vec3 place = rotation_from_rpy(0, 0, yaw) * Vec3(4 - past, random.between(-4, 4), 0);
            level.set_place(place.head<2>(), 2);
            if (!level.set_layer(0)) continue;
            for (int heading = 0; heading < lattice_headings; ++heading) {
                ++all;
                if (!level.tips_at(heading)) continue;
                ++proven;
                CHECK_FALSE(level.stands_at(heading));
                CHECK(judge.settle(place, lattice_yaw(heading)).verdict != Verdict::Valid);
            }
        }
    }
    CHECK(proven > 3000);
    CHECK(all > 2 * proven);
}

TEST_CASE("a robot is not proven to tip where a lower floor or a part of another shape may hold it")
{
    const auto proves = [](const Robot& robot, double lower) {
        Scene scene;
        add_block(scene, {-4, -4, -0.001}, {4, 4, 0});
        add_block(scene, {-8, -8, lower - 1}, {8, 8, lower});
        const TestMap map = map_of(scene, 0.2);
        const Judge judge(map, robot);
        LevelGround level(judge.impl());
        level.set_place({4, 0}, 2);
        return level.set_layer(0) && level.tips_at(0);
    };
    CHECK(proves(boxy({0.5, 0.3, 0.25}), -2));
    CHECK_FALSE(proves(boxy({0.5, 0.3, 0.25}), -0.01));
    CHECK_FALSE(proves(boxy({0.5, 0.3, 0.25}), -0.4));
    CHECK_FALSE(proves(wheeled(), -4));
}

TEST_CASE("what is proven of real robots is right", "[real]")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    std::vector<Robot> robots{load_robot(source_folder() + "/maps/robots/husky_wheels.yaml")};
    for (const char* file : {"robot_turtlebot3/turtlebot3_description/urdf/turtlebot3_waffle.urdf",
                             "robot_anymal_c/anymal_c_simple_description/urdf/anymal.urdf"})
        robots.push_back(load_robot((*folder / file).string(), {.model_paths = {*folder}}));
    for (const Robot& robot : robots) {
        CAPTURE(robot.name);
        Scene scene;
        Random random(1);
        add_floor(scene, random, 4, 2, 0);
        add_obstacle(scene, {0.5, -2, 0}, {0.6, 2, 1});
        const std::size_t proven = check_proven(map_of(scene), robot, 0.61);
        // The caster of the TurtleBot3 is not exactly as low as its wheels.
        CHECK((proven > 1000) == (robot.name != "turtlebot3_waffle"));
    }
}

TEST_CASE("a door that is wider than the robot joins two rooms, and a narrower one does not")
{
    const Robot robot = boxy({0.6, 0.5, 0.3});
    for (const double more : {0.01, -0.01}) {
        CAPTURE(more);
        const double half = (0.5 + more) / 2;
        Scene scene;
        add_block(scene, {-1.5, -1, -0.1}, {1.5, 1, 0});
        add_obstacle(scene, {-0.05, -1, 0}, {0.05, -half, 1});
        add_obstacle(scene, {-0.05, half, 0}, {0.05, 1, 1});
        const Impl graph = graph_of(map_of(scene), robot, {.step = 0.125});  // a column is in the middle of the door
        CHECK(is_joined(graph, {-1, 0, 0}, {1, 0, 0}) == (more > 0));
    }
}

TEST_CASE("a ramp joins two floors up to the limit of slopes")
{
    const Robot robot = boxy({0.4, 0.3, 0.2});
    const double limit = StandLimits{}.max_slope, height = 0.8;
    for (const double more : {-0.5, 0.5}) {
        CAPTURE(more);
        const TestMap map = map_of(ramp(limit + rad(more), height));
        const Impl graph = graph_of(map, robot, {.step = 0.075});
        CHECK(is_joined(graph, {-1.5, 0, 0}, {map.bounds.max.x() - 0.5, 0, height}) == (more < 0));
    }
}

TEST_CASE("a crest that a robot passes joins two floors at any reach step", "[slow]")
{
    for (const Robot& robot : {boxy({0.8, 0.5, 0.3}), boxy({0.4, 0.3, 0.2})})
        for (const double angle : {10.0, 17.5, 24.0})
            for (double step = 0.1; step < 0.31; step += 0.023) {
                CAPTURE(robot.parts[0].shape.size.x(), angle, step);
                const TestMap map = map_of(ramp(rad(angle), 0.8));
                const Impl graph = graph_of(map, robot, {.step = step});
                CHECK(is_joined(graph, {-1.5, 0, 0}, {map.bounds.max.x() - 0.5, 0, 0.8}));
            }
}

TEST_CASE("a car turns around where it has room, and not in a corridor")
{
    // A corridor along x with an open end, between two walls.
    const auto corridor = [](double open) {
        Scene scene;
        add_block(scene, {-2, -2, -0.5}, {4, 2, 0});
        for (const double side : {-1.0, 1.0}) {
            const double near = 0.2 * side, far = 2 * side;
            add_obstacle(scene, {-2, std::min(near, far), 0}, {4 - open, std::max(near, far), 1});
        }
        return map_of(scene);
    };
    const Robot robot = boxy({0.4, 0.24, 0.2});
    const auto turns_around = [&](double open, Drive drive, double radius) {
        ReachOptions options{.drive = drive, .step = 0.1};
        if (drive == Drive::Car) options.turning_radius = radius;
        const Impl graph = graph_of(corridor(open), robot, options);
        std::optional<std::uint32_t> ahead, back;
        for_each_state(graph, [&](const slow::Reach::State& state, std::size_t place) {
            const Vec2 at(graph.grid.x_of(state[0]), graph.grid.y_of(state[1]));
            if (std::abs(at.x()) > 0.051 || std::abs(at.y()) > 0.051) return;
            if (state[3] == 0) ahead = island_at(graph, place, 0);
            if (state[3] == headings / 2) back = island_at(graph, place, headings / 2);
        });
        REQUIRE((ahead && back));
        return *ahead == *back;
    };
    CHECK(turns_around(2, Drive::Differential, 0));
    CHECK(!turns_around(0, Drive::Differential, 0));  // its diagonal is wider than the corridor
    CHECK(turns_around(2, Drive::Car, 0.5));
    CHECK(!turns_around(2, Drive::Car, 30));
    CHECK(!turns_around(0.1, Drive::Car, 0.5));
    CHECK(!turns_around(0, Drive::Car, 0.1));
}

TEST_CASE("how a robot drives is what was given, what its file says, or the default")
{
    Robot robot = boxy({0.4, 0.3, 0.2});
    CHECK(with_defaults({}, robot).drive == Drive::Differential);
    CHECK(with_defaults({}, robot).max_step == 0.03);
    CHECK(with_defaults({}, robot).step == Approx(0.075));
    robot.drive.wheel_radius = 0.2;
    CHECK(with_defaults({}, robot).max_step == Approx(0.05));
    robot.drive.max_step = 0.02;
    CHECK(with_defaults({}, robot).max_step == 0.02);
    CHECK(with_defaults({.max_step = 0.1}, robot).max_step == 0.1);
    robot.drive.kind = Drive::Car;
    CHECK_THROWS_WITH(
        with_defaults({}, robot),
        "ReachGraph: a car needs the smallest radius of its curves: --turning-radius, or turning_radius in "
        "robot.yaml, m");
    robot.drive.turning_radius = 3;
    CHECK(with_defaults({}, robot).turning_radius == 3);
    CHECK(with_defaults({.turning_radius = 4}, robot).turning_radius == 4);
    CHECK(!with_defaults({.drive = Drive::Omni}, robot).turning_radius);
    CHECK_THROWS_WITH(with_defaults({.drive = Drive::Omni, .turning_radius = 4}, robot),
                      "ReachGraph: turning_radius is only for a car; the drive is omni");
    CHECK_THROWS_WITH(with_defaults({.turning_radius = -1}, robot),
                      "ReachGraph: turning_radius is -1, needs > 0 m, at most 100 m");
    robot.drive = {.kind = Drive::Legged};
    CHECK_THROWS_WITH(with_defaults({}, robot),
                      "ReachGraph: a legged robot needs the largest step that it climbs: --max-step, or max_step in "
                      "robot.yaml, m");
    CHECK(with_defaults({.max_step = 0.2}, robot).max_step == 0.2);
}

TEST_CASE("a step joins two floors up to the limit of steps")
{
    for (const Robot& robot : {boxy({0.4, 0.3, 0.2}), wheeled()})
        for (const double more : {-1e-3, 1e-3}) {
            CAPTURE(robot.name, more);
            const double height = 0.05 + more;
            Scene scene;
            add_block(scene, {-2, -1, -0.5}, {0, 1, 0});
            add_block(scene, {0, -1, -0.5}, {2, 1, height});
            const Impl graph = graph_of(map_of(scene), robot, {.max_step = 0.05, .step = 0.15});
            CHECK(is_joined(graph, {-1.3, 0, 0}, {1.3, 0, height}) == (more < 0));
        }
}

TEST_CASE("a bridge is joined with the ground below it only by its ramps")
{
    const Robot robot = boxy({0.4, 0.3, 0.2});
    const double high = 0.8, half = 0.7, length = high / std::tan(rad(20));
    for (const bool has_ramps : {false, true}) {
        CAPTURE(has_ramps);
        Scene scene;
        add_block(scene, {-4, -1, -0.5}, {4, 1, 0});
        add_block(scene, {-half, -0.4, high - 0.1}, {half, 0.4, high});
        const std::vector<Vec3> corners{
            {half, -0.4, high}, {half, 0.4, high}, {half + length, -0.4, 0}, {half + length, 0.4, 0}};
        std::vector<Vec3> behind;
        for (const Vec3& corner : corners) behind.push_back({-corner.x(), corner.y(), corner.z()});
        if (has_ramps) {
            add_mesh(scene, "ramp", Label::Terrain, corners, {{0, 2, 1}, {1, 2, 3}});
            add_mesh(scene, "ramp behind", Label::Terrain, behind, {{0, 1, 2}, {1, 3, 2}});
        }
        // A step as high as the deck does not lead through it either: there, the robot has no room.
        const Impl graph = graph_of(map_of(scene), robot, {.max_step = 0.03, .step = 0.1});
        CHECK(is_joined(graph, {0, 0, 0}, {3.5, 0.5, 0}));
        CHECK(is_joined(graph, {0, 0, high}, {3.5, 0.5, 0}) == has_ramps);
    }
}

TEST_CASE("no step, however large, leads through a deck")
{
    Scene scene;  // a deck that is as wide as the map
    add_block(scene, {-1, -1, -0.5}, {1, 1, 0});
    add_block(scene, {-1, -1, 0.9}, {1, 1, 1});
    for (const double step : {0.03, 0.5, 1.0, 2.0}) {
        CAPTURE(step);
        const Impl graph = graph_of(map_of(scene), boxy({0.3, 0.3, 0.2}), {.max_step = step, .step = 0.1});
        CHECK(!is_joined(graph, {0, 0, 0}, {0, 0, 1}));
    }
}

TEST_CASE("a spiral ramp is one island over all its floors")
{
    const Impl graph = graph_of(map_of(spiral(2)), boxy({0.4, 0.3, 0.2}), {.step = 0.15});
    CHECK(graph.islands[0].low == 0);
    CHECK(graph.islands[0].high > 2.9);
    CHECK(is_joined(graph, {-2.5, 0, 0}, {-1.35, 0, 0.75}));
    CHECK(is_joined(graph, {-2.5, 0, 0}, {-1.35, 0, 2.25}));
}

TEST_CASE("a table and a shelf are islands of their own")
{
    Scene scene;
    add_block(scene, {-2, -1, -0.5}, {2, 1, 0});
    add_block(scene, {-1.5, -0.5, 0}, {-0.5, 0.5, 0.6});
    add_block(scene, {0.5, -0.4, 0.38}, {1.5, 0.4, 0.4});
    const Impl graph = graph_of(map_of(scene), boxy({0.3, 0.2, 0.2}), {.step = 0.1});
    REQUIRE(graph.islands.size() == 3);
    CHECK(graph.islands[0].high == 0);
    CHECK(graph.islands[1].low == Approx(0.6));
    CHECK(graph.islands[1].high == Approx(0.6));
    CHECK(graph.islands[2].low == Approx(0.4));
    CHECK(is_joined(graph, {1, 0, 0}, {-1.8, 0.8, 0}));  // below the shelf
    double shares = 0;
    for (const Island& island : graph.islands) {
        shares += island.share;
        CHECK(islands_near(graph, island.place).contains(std::uint32_t(&island - graph.islands.data())));
    }
    CHECK(shares == Approx(1));
}

TEST_CASE("a larger robot has no way that a smaller one does not have")
{
    std::size_t ways = 0, lost = 0;
    for (std::uint64_t seed = 1; seed <= (compare::scene_count() + 49) / 50; ++seed) {
        CAPTURE(seed);
        const Scene scene = walled(seed);
        const TestMap map = map_of(scene, 0.1, box_of({-1.5, -1.5, -1}, {1.5, 1.5, 1}));
        const ReachOptions options{.drive = Drive::Omni, .step = 0.15};
        const Impl small = graph_of(map, boxy({0.5, 0.3, 0.2}), options, {}, Impl::Keep::Ways),
                   large = graph_of(map, boxy({0.6, 0.4, 0.3}), options, {}, Impl::Keep::Ways);
        std::map<slow::Reach::State, std::size_t> places;
        std::map<std::uint32_t, std::uint32_t> islands;  // of the large robot: that of the small one there
        for_each_state(small, [&](const slow::Reach::State& state, std::size_t place) { places[state] = place; });
        for_each_state(large, [&](const slow::Reach::State& state, std::size_t place) {
            REQUIRE(places.contains(state));
            const std::size_t same = places.at(state);
            for (const Way way : {Way::Ahead, Way::Left, Way::Right, Way::Aside, Way::Turn})
                if (target_of(large, place, state[3], way)) {
                    ++ways;
                    CHECK(target_of(small, same, state[3], way));
                } else {
                    lost += target_of(small, same, state[3], way).has_value();
                }
            const std::uint32_t island = island_at(small, same, state[3]);
            CHECK(islands.emplace(island_at(large, place, state[3]), island).first->second == island);
        });
    }
    if (!compare::all_scenes()) return;
    CHECK(ways > 1000);
    CHECK(lost > 100);
}

TEST_CASE("mirroring the scene and the robot mirrors the islands")
{
    const auto flipped = [](int heading) { return lattice_heading(0, -heading); };
    for (std::uint64_t seed = 1; seed <= (compare::scene_count() + 49) / 50; ++seed) {
        CAPTURE(seed);
        Scene scene = walled(seed);
        add_block(scene, {-1.4, 0.3, 0}, {-0.2, 1.3, 0.025});  // a kerb
        scene = on_binary_lattice(scene);
        const Bounds bounds = box_of({-1.5, -1.5, -2}, {1.5, 1.5, 2});
        Robot robot = boxy({0.5, 0.3, 0.25}), other_robot = robot;
        // A mass in the middle is often exactly above the line between two ways to rest; a rule then chooses the side.
        robot.mass_center = Vec3(0.013, 0.007, 0.12);
        other_robot.mass_center = Vec3(0.013, -0.007, 0.12);
        const ReachOptions options{.step = 0.1875};
        const JudgeOptions limits{.stand = {.friction = 100}};  // the pyramids of friction are not symmetrical
        const Impl graph = graph_of(map_of(scene, 0.1, bounds), robot, options, limits),
                   other = graph_of(map_of(mirrored(scene), 0.1, bounds), other_robot, options, limits);
        std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
        std::size_t states = 0, other_states = 0;
        for_each_state(other, [&](const slow::Reach::State&, std::size_t) { ++other_states; });
        for_each_state(graph, [&](const slow::Reach::State& state, std::size_t place) {
            ++states;
            const std::size_t column = other.column_of(state[0], other.grid.rows - 1 - state[1]),
                              same = other.first[column] + std::size_t(state[2]);
            REQUIRE(same < other.first[column + 1]);
            REQUIRE(has_heading(other.valid[same], flipped(state[3])));
            pairs.emplace(island_at(graph, place, state[3]), island_at(other, same, flipped(state[3])));
        });
        CHECK(states == other_states);
        CHECK(graph.islands.size() == other.islands.size());
        CHECK(pairs.size() == graph.islands.size());
    }
}

TEST_CASE("the graph is the same with any number of threads, and with every state checked exactly")
{
    const TestMap map = map_of(furnished(3, 2), 0.1);
    const Judge judge(map, boxy({0.7, 0.5, 0.3}));
    const double step = compare::all_scenes() ? 0.125 : 0.25;  // m
    const Impl one(judge, {.step = step, .threads = 1}, Impl::Keep::Ways);
    const auto islands_of = [](const Impl& graph) {
        std::vector<std::uint32_t> out;
        for_each_state(graph, [&](const slow::Reach::State& state, std::size_t place) {
            out.push_back(island_at(graph, place, state[3]));
        });
        return out;
    };
    const auto is_same = [&](const Impl& other) {
        CHECK(one.first == other.first);
        CHECK(one.ground == other.ground);
        CHECK(one.valid == other.valid);
        if (other.keep == Impl::Keep::Ways) CHECK(one.ways == other.ways);
        CHECK(islands_of(one) == islands_of(other));
        REQUIRE(one.islands.size() == other.islands.size());
        for (std::size_t k = 0; k < one.islands.size(); ++k) {
            CHECK(one.islands[k].area == other.islands[k].area);
            CHECK(one.islands[k].place == other.islands[k].place);
        }
    };
    for (const Impl::Keep keep : {Impl::Keep::Ways, Impl::Keep::Islands}) {
        for (const int threads : {1, 2, 8}) is_same({judge, {.step = step, .threads = threads}, keep});
        is_same({without_mask(judge), {.step = step, .threads = 1}, keep});
    }
}

TEST_CASE("the island of a state is that of its settled pose")
{
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        CAPTURE(seed);
        const Judge judge(map_of(furnished(seed, 1), 0.1), boxy({0.5, 0.3, 0.25}));
        const Impl graph(judge, {.step = 0.16});
        for_each_state(graph, [&](const slow::Reach::State& state, std::size_t place) {
            const Vec3 at(graph.grid.x_of(state[0]), graph.grid.y_of(state[1]), graph.ground[place]);
            const auto island = graph.island_of(judge.settle(at, lattice_yaw(state[3])));
            REQUIRE(island);
            CHECK(*island == island_at(graph, place, state[3]));
        });
    }
}

TEST_CASE("the island of a pose between the columns is that of its room and its layer")
{
    Scene scene;  // two rooms of different sizes, a shelf in the larger one, and a closet between columns
    add_block(scene, {-2, -1, -0.5}, {2, 1, 0});
    add_obstacle(scene, {-0.75, -1, 0}, {-0.65, 1, 1});
    add_block(scene, {0.4, -0.6, 0.4}, {1.8, 0.6, 0.5});
    const Judge judge(map_of(scene), boxy({0.4, 0.3, 0.2}));
    const ReachGraph graph(judge, {.step = 0.1});
    Random random(5);
    std::array<int, 3> found{};
    for (int k = 0; k < 500; ++k) {
        const double x = random.between(-2, 2), y = random.between(-1, 1), z = random.chance(0.5) ? 0.2 : 0.7;
        const SettledPose pose = judge.settle({x, y, z}, random.between(-3, 3));
        const auto island = graph.island_of(pose);
        if (pose.verdict != Verdict::Valid) {
            CHECK(!island);
            continue;
        }
        if (!island || *island > 2) continue;  // near a wall, where the robot cannot turn
        const std::size_t expected = pose.ground->height > 0.4 ? 2 : x < -0.7 ? 1 : 0;
        CAPTURE(x, y, z);
        CHECK(*island == expected);
        ++found[expected];
    }
    for (const int count : found) CHECK(count >= 20);
}

TEST_CASE("a pose from which the robot can go nowhere has no island")
{
    Scene scene;  // in this closet, the robot stands between two columns only
    add_block(scene, {-1, -1, -0.5}, {1, 1, 0});
    for (const double side : {-1.0, 1.0}) {
        const Vec3 middle(0.25, 0.25, 0);
        add_obstacle(scene, middle + Vec3(side * 0.2 - 0.04, -0.24, 0), middle + Vec3(side * 0.2 + 0.04, 0.24, 1));
        add_obstacle(scene, middle + Vec3(-0.24, side * 0.2 - 0.04, 0), middle + Vec3(0.24, side * 0.2 + 0.04, 1));
    }
    const Judge judge(map_of(scene), boxy({0.3, 0.3, 0.2}));
    const ReachGraph graph(judge, {.step = 0.5});
    const SettledPose pose = judge.settle({0.25, 0.25, 0}, 0);
    CHECK(pose.verdict == Verdict::Valid);
    CHECK(!graph.island_of(pose));
}

TEST_CASE("a fault in the options of a drivable graph is named with its value and limit")
{
    const TestMap map = map_of(ramp(0.1, 0.2));
    const Robot robot = boxy({0.3, 0.2, 0.2});
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto make = [&](const ReachOptions& options) { return ReachGraph(Judge(map, robot), options); };
    CHECK_THROWS_WITH(make({.step = 0}), "ReachGraph: step is 0, needs > 0 m");
    CHECK_THROWS_WITH(make({.step = -0.5}), "ReachGraph: step is -0.5, needs > 0 m");
    CHECK_THROWS_WITH(make({.step = nan}), "ReachGraph: step is nan, needs > 0 m");
    CHECK_THROWS_WITH(make({.max_step = -1}), "ReachGraph: max_step is -1, needs >= 0 m");
    CHECK_THROWS_WITH(make({.max_step = nan}), "ReachGraph: max_step is nan, needs >= 0 m");
    CHECK_THROWS_WITH(make({.step = 1e-6}), Contains("columns"));
    const Judge voxels(make_map(map.scene, {}), robot, {.obstacles = Obstacles::Voxels});
    CHECK_THROWS_WITH(ReachGraph(voxels), Contains("voxels"));
}

TEST_CASE("info --islands lists the islands of a map, and needs a map and a robot")
{
    const Arena arena;
    const std::string robot = " --robot box:0.9,0.6,0.3 ";
    const ProgramRun run = arena("info map --islands --json --reach-step 0.4" + robot);
    REQUIRE(run.status == 0);
    const nlohmann::json reach = nlohmann::json::parse(run.out).at("reach");
    CHECK(reach.at("reach_step") == 0.4);
    CHECK(reach.at("islands").at(0).at("share").get<double>() > 0.9);
    CHECK_THAT(arena("info map --islands --reach-step 0.4" + robot).out, Contains("islands of box"));
    CHECK_THAT(arena("info map --islands").err, Contains("--islands requires --robot"));
    CHECK_THAT(arena("info map" + robot).err, Contains("--robot requires --islands"));
    CHECK_THAT(arena("info map --drive omni").err, Contains("--drive is only for --islands"));
    CHECK_THAT(arena("info " + training_scene + " --islands" + robot).err, Contains("--islands is only for maps"));
}

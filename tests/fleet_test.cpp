#include "catch.h"
#include "fcl_robots.h"
#include "rest_robots.h"
#include "test_map.h"

#include <spawnfield/fleet.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

using namespace spawnfield;
using rest_robots::add_block;
using rest_robots::boxy;

// Tests of fleets: several kinds of robots that do not overlap, formations, and as many robots as fit.

namespace {

using Form = Formation::Form;

Scene floor_of(double side)
{
    Scene scene;
    add_block(scene, {-side / 2, -side / 2, -0.5}, {side / 2, side / 2, 0});
    return scene;
}

Pose pose_of_robot(const FleetRobot& robot)
{
    const Spawn& spawn = robot.spawn;
    return {spawn.position, rotation_from_rpy(spawn.roll, spawn.pitch, spawn.yaw)};
}

FleetKind kind_of(const Map& map, const Robot& robot, std::optional<std::size_t> count,
                  const SampleOptions& spawns = {})
{
    FleetKind out{.name = robot.name, .judge = Judge(map, robot)};
    out.count = count;
    out.spawns = spawns;
    return out;
}

/// Rooms of 1.4 x 0.9 m without doors, in a row along x, between walls of 0.1 m.
Scene rooms(int count)
{
    Scene scene;
    const double width = 1.5 * count + 0.1;
    add_block(scene, {0, 0, -0.5}, {width, 1.1, 0});
    const auto wall = [&](const Vec3& low, const Vec3& high) {
        add_shape(scene, "wall", Label::Obstacle, box_shape(high - low, {(low + high) / 2}));
    };
    wall({0, 0, 0}, {width, 0.1, 1});
    wall({0, 1, 0}, {width, 1.1, 1});
    for (int k = 0; k <= count; ++k) wall({1.5 * k, 0, 0}, {1.5 * k + 0.1, 1.1, 1});
    return scene;
}

std::string text_of(const Fleet& fleet, std::span<const FleetKind> kinds) { return fleet_csv(fleet, kinds); }

/// Returns a robot for a random scene. Robots with round parts take long to settle there, so settled ones are boxes.
Robot robot_for(Stance stance, std::uint64_t seed)
{
    if (stance == Stance::Level) return random_robot(seed);
    Random random{seed};
    return boxy({random.between(0.2, 0.9), random.between(0.2, 0.9), random.between(0.1, 0.4)});
}

double distance(const FleetRobot& a, const FleetRobot& b) { return (a.spawn.position - b.spawn.position).norm(); }

void check_slot(const FormationSlot& slot, double x, double y, double yaw)
{
    CHECK(slot.x == Approx(x).margin(1e-12));
    CHECK(slot.y == Approx(y).margin(1e-12));
    CHECK(std::remainder(slot.yaw - yaw, 2 * rest_robots::pi) == Approx(0).margin(1e-12));
}

}  // namespace

TEST_CASE("a fleet that is stopped has the first robots of each kind, and formations complete or not at all")
{
    const TestMap map = map_of(floor_of(20));
    std::vector<FleetKind> kinds;
    kinds.push_back(kind_of(map, boxy({0.9, 0.9, 0.3}), 150, {.min_distance = 1.2, .random_yaw = true}));
    kinds.push_back(kind_of(map, boxy({0.3, 0.3, 0.3}), std::nullopt, {.min_distance = 1.5}));
    kinds.push_back(kind_of(map, boxy({0.4, 0.4, 0.3}), 12));
    kinds[2].formation = Formation{.form = Form::Circle, .spacing = 1};
    for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k].name = std::string(1, char('a' + k));
    FleetOptions options{.min_distance = 0.5, .seed = 7};
    const Fleet all = place_fleet(kinds, options);
    REQUIRE_FALSE(all.is_stopped);
    REQUIRE(all.kinds[2].found == 12);
    std::set<std::size_t> sizes;
    std::size_t stopped = 0;
    for (const long asked : {0L, 20L, 40L, 60L, 100L, 300L, 1000L, 2000L, 1000000L}) {
        CAPTURE(asked);
        std::atomic<long> left{asked};
        options.stop = [&] { return left.fetch_sub(1) <= 0; };
        options.threads = int(asked % 3 + 1);
        const Fleet part = place_fleet(kinds, options);
        CHECK((part.kinds[2].found == 0 || part.kinds[2].found == 12));
        sizes.insert(part.robots.size());
        stopped += part.is_stopped;
        if (!part.is_stopped) CHECK(text_of(part, kinds) == text_of(all, kinds));
        for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
            const auto of_kind = [&](const Fleet& fleet) {
                std::vector<FleetRobot> out;
                for (const FleetRobot& robot : fleet.robots)
                    if (robot.kind == kind) out.push_back(robot);
                return out;
            };
            const std::vector<FleetRobot> some = of_kind(part), whole = of_kind(all);
            REQUIRE(some.size() <= whole.size());
            for (std::size_t i = 0; i < some.size(); ++i) {
                CHECK(some[i].name == whole[i].name);
                CHECK(some[i].spawn.position == whole[i].spawn.position);
            }
            CHECK((part.is_stopped || part.kinds[kind].proof.has_value() == all.kinds[kind].proof.has_value()));
        }
    }
    CHECK(sizes.size() >= 4);
    CHECK(sizes.contains(0));
    CHECK((stopped >= 4 && stopped < 9));
}

TEST_CASE("rooms that hold one robot each hold exactly as many robots as there are rooms")
{
    const TestMap map = map_of(rooms(4));
    for (const Stance stance : {Stance::Settled, Stance::Level}) {
        const FleetKind kind = kind_of(map, boxy({1, 0.5, 0.3}), std::nullopt, {.stance = stance});
        const Fleet fleet = place_fleet(std::span(&kind, 1), {});
        CHECK(fleet.robots.size() == 4);
        REQUIRE(fleet.kinds[0].proof);
        CHECK(fleet.kinds[0].proof->valid > 0);
        FleetKind six = kind;
        six.count = 6;
        const Fleet short_of_two = place_fleet(std::span(&six, 1), {});
        CHECK(short_of_two.robots.size() == 4);
        CHECK(short_of_two.kinds[0].found == 4);
        CHECK(short_of_two.kinds[0].proof);
        FleetKind four = kind;
        four.count = 4;
        CHECK(place_fleet(std::span(&four, 1), {}).robots.size() == 4);
        CHECK_FALSE(place_fleet(std::span(&four, 1), {}).kinds[0].proof);
    }
}

TEST_CASE("robots of a fleet are valid, and apart for FCL, in random scenes")
{
    std::size_t placed = 0, close = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        const Stance stance = seed % 3 == 0 ? Stance::Settled : Stance::Level;
        std::vector<FleetKind> kinds;
        for (std::uint64_t k = 0; k < 3; ++k)
            kinds.push_back(kind_of(map, robot_for(stance, 10 * seed + k), k == 2 ? 40 : 8,
                                    {.random_yaw = true, .stance = stance, .bounds = {{-3, -3, 0}, {3, 3, 0}}}));
        for (FleetKind& kind : kinds) kind.fill_step = 1;
        const Fleet fleet = place_fleet(kinds, {.seed = seed});
        placed += fleet.robots.size();
        for (std::size_t i = 0; i < fleet.robots.size(); ++i) {
            const FleetRobot& robot = fleet.robots[i];
            const Robot& shape = kinds[robot.kind].judge.robot();
            if (stance == Stance::Level)
                CHECK(kinds[robot.kind].judge.check(pose_of_robot(robot)).verdict == Verdict::Valid);
            CHECK(CollisionChecker(map.geometry, shape).is_free(pose_of_robot(robot)));
            for (std::size_t j = 0; j < i; ++j) {
                const FleetRobot& other = fleet.robots[j];
                CAPTURE(seed, robot.name, other.name);
                CHECK_FALSE(fcl_robots_meet(shape, pose_of_robot(robot), kinds[other.kind].judge.robot(),
                                            pose_of_robot(other)));
                close += distance(robot, other) < 1.5;
            }
        }
    }
    CHECK(placed > 200);
    CHECK(close > 300);  // otherwise, the robots are so far apart that the test says nothing
}

TEST_CASE("two robots overlap if and only if FCL says so for their parts, or one is in the other")
{
    Random random{5};
    int meets = 0, apart = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const Robot a = random_robot(seed), b = random_robot(seed + 1000);
        for (int k = 0; k < 10; ++k) {
            const auto pose = [&](double reach) {
                return Pose{{random.between(-reach, reach), random.between(-reach, reach), random.between(-0.5, 0.5)},
                            rotation_from_rpy(random.between(-1, 1), random.between(-1, 1), random.between(-3, 3))};
            };
            const Pose of_a = pose(100), of_b = of_a * pose(0.6);
            const bool expected = fcl_robots_meet(a, of_a, b, of_b);
            CAPTURE(seed, k);
            CHECK(robots_overlap(a, of_a, b, of_b) == expected);
            CHECK(robots_overlap(b, of_b, a, of_a) == expected);
            (expected ? meets : apart)++;
        }
    }
    CHECK(meets > 50);
    CHECK(apart > 50);
    // Touching counts, and so does a robot that is inside another one.
    const Robot cube = boxy({1, 1, 1}), small = boxy({0.2, 0.2, 0.2});
    CHECK(robots_overlap(cube, {}, cube, {{1, 0, 0}}));
    CHECK_FALSE(robots_overlap(cube, {}, cube, {{1 + 1e-5, 0, 0}}));
    CHECK(robots_overlap(cube, {}, small, {{0, 0, 0.4}}));
    CHECK(robots_overlap(small, {{0, 0, 0.4}}, cube, {}));
}

TEST_CASE("robots keep the distances of the fleet, of their kind and between kinds")
{
    const TestMap map = map_of(floor_of(12));
    std::vector<FleetKind> kinds{kind_of(map, boxy({0.4, 0.4, 0.2}), 8, {.min_distance = 2}),
                                 kind_of(map, boxy({0.2, 0.2, 0.2}), 12)};
    kinds[1].name = "small";
    const Fleet fleet = place_fleet(kinds, {.min_distance = 0.5, .between = {{1, 0, 1.2}}, .seed = 3});
    REQUIRE(fleet.robots.size() == 20);
    CHECK(fleet.robots[0].name == "boxy_1");
    CHECK(fleet.robots[19].name == "small_12");
    double closest[2][2] = {{9, 9}, {9, 9}};
    for (const FleetRobot& a : fleet.robots)
        for (const FleetRobot& b : fleet.robots)
            if (&a != &b) closest[a.kind][b.kind] = std::min(closest[a.kind][b.kind], distance(a, b));
    CHECK(closest[0][0] >= 2);
    CHECK(closest[0][1] >= 1.2);
    CHECK(closest[1][1] >= 0.5);
    CHECK(closest[1][1] < 1.2);  // no other distance applies to it
}

TEST_CASE("after a fill, each valid pose of the raster is too near to a robot or overlaps one", "[slow]")
{
    std::uint64_t all = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        const Stance stance = seed % 2 == 0 ? Stance::Level : Stance::Settled;
        const Robot robot = robot_for(stance, seed + 50);
        FleetKind kind = kind_of(
            map, robot, std::nullopt,
            {.min_distance = seed % 3 == 0 ? 0.0 : 1.5, .stance = stance, .bounds = {{-4, -3, 0}, {3, 4, 0}}});
        kind.fill_step = 0.5;
        kind.spawns.heading = stance == Stance::Settled ? std::optional(HeadingRule{.count = 3}) : std::nullopt;
        const Fleet fleet = place_fleet(std::span(&kind, 1), {.seed = seed});
        REQUIRE(fleet.kinds[0].proof);
        CHECK(fleet.kinds[0].proof->step == 0.5);
        CHECK(fleet.kinds[0].proof->headings == (stance == Stance::Settled ? 3 : 1));
        // The same raster, pose by pose, without the mask.
        const Judge slow = without_mask(kind.judge);
        std::uint64_t valid = 0, free = 0;
        const auto look = [&](const Spawn& spawn) {
            ++valid;
            const Pose pose{spawn.position, rotation_from_rpy(spawn.roll, spawn.pitch, spawn.yaw)};
            free += std::ranges::none_of(fleet.robots, [&](const FleetRobot& other) {
                return (other.spawn.position - pose.position).norm() < kind.spawns.min_distance ||
                       fcl_robots_meet(robot, pose, robot, pose_of_robot(other));
            });
        };
        for (int i = 0; i <= 14; ++i)
            for (int j = 0; j <= 14; ++j) {
                const double x = -4 + i * 0.5, y = -3 + j * 0.5;
                if (!map.bounds.contains_xy(x, y, 0)) continue;
                for (const double layer : column_at(map.geometry, x, y).layers) {
                    if (stance == Stance::Level) {
                        const Pose pose{{x, y, layer + auto_offset(robot)}};
                        if (verdict_in_raster(slow, pose) == Verdict::Valid) look({.position = pose.position});
                        continue;
                    }
                    for (int k = 0; k < 3; ++k) {
                        const SettledPose pose = slow.settle({x, y, layer}, heading_of(k, 3));
                        if (pose.verdict == Verdict::Valid)
                            look({pose.lifted(0.02).position, pose.yaw, pose.roll, pose.pitch});
                    }
                }
            }
        CAPTURE(seed);
        CHECK(free == 0);
        CHECK(fleet.kinds[0].proof->valid == valid);
        all += valid;
    }
    CHECK(all > 100);
}

TEST_CASE("fleets are the same at any number of threads, and differ between seeds")
{
    const TestMap map = training_map();
    std::vector<FleetKind> kinds{kind_of(map, husky(), 5, {.random_yaw = true}), kind_of(map, boxy({0.4, 0.3, 0.2}), 6),
                                 kind_of(map, boxy({1, 1, 1}), std::nullopt)};
    kinds[1].formation = Formation{.form = Form::Grid, .spacing = 1};
    kinds[1].name = "grid";
    kinds[2].spawns.min_distance = 3;
    const auto text = [&](int threads, std::uint64_t seed) {
        return text_of(place_fleet(kinds, {.min_distance = 0.5, .seed = seed, .threads = threads}), kinds);
    };
    const std::string one = text(1, 4);
    CHECK(one == text(2, 4));
    CHECK(one == text(8, 4));
    CHECK(one != text(1, 5));
}

TEST_CASE("slots of formations are where geometry puts them")
{
    const StartPlace at{1, 2, {}};
    const auto line = formation_slots({.spacing = 2}, 3, at, 0);
    check_slot(line[0], 1, 4, 0);  // the first one is on the left
    check_slot(line[1], 1, 2, 0);
    check_slot(line[2], 1, 0, 0);
    const auto turned = formation_slots({.spacing = 2}, 3, at, rest_robots::pi / 2);
    check_slot(turned[0], -1, 2, rest_robots::pi / 2);
    const auto grid = formation_slots({.form = Form::Grid, .spacing = 1}, 5, at, 0);
    check_slot(grid[0], 1, 3, 0);
    check_slot(grid[2], 1, 1, 0);
    check_slot(grid[4], 0, 2, 0);
    const auto pairs = formation_slots({.form = Form::Grid, .spacing = 1, .columns = 2}, 5, at, 0);
    check_slot(pairs[4], -1, 2.5, 0);
    const auto circle = formation_slots({.form = Form::Circle, .spacing = 1}, 6, at, 0);
    check_slot(circle[0], 2, 2, rest_robots::pi);  // a hexagon: its radius is its side
    check_slot(circle[3], 0, 2, 0);
    for (std::size_t i = 0; i < 6; ++i)
        CHECK(std::hypot(circle[i].x - circle[(i + 1) % 6].x, circle[i].y - circle[(i + 1) % 6].y) == Approx(1));
    const double none = std::nan("");
    const Formation convoy{.form = Form::Convoy, .spacing = 2, .path = {{0, 0, none}, {3, 0, 1}, {3, 0, 2}, {3, 4, 3}}};
    CHECK(path_length(convoy) == 7);
    const auto cars = convoy_slots(convoy, 3, 0.5);
    REQUIRE(cars.size() == 3);
    check_slot(cars[2], 0.5, 0, 0);
    check_slot(cars[1], 2.5, 0, 0);
    check_slot(cars[0], 3, 1.5, rest_robots::pi / 2);
    CHECK_FALSE(cars[2].z);
    CHECK(cars[0].z == Approx(1 + 1.5 / 4 * 2));
    CHECK(convoy_slots(convoy, 5, 0).empty());
    CHECK(convoy_slots(convoy, 4, 1).size() == 4);
    CHECK(convoy_slots(convoy, 4, 1.01).empty());
    CHECK_THROWS_WITH(formation_slots({.spacing = 0}, 2, at, 0), Contains("spacing") && Contains("> 0"));
    CHECK_THROWS_WITH(convoy_slots({.form = Form::Convoy}, 2, 0), Contains("two corners"));
}

TEST_CASE("a formation follows the ground, and is complete or missing")
{
    const TestMap map = map_of(rest_robots::slope(0.2));
    FleetKind kind = kind_of(map, boxy({0.4, 0.4, 0.2}), 4);
    kind.formation = Formation{.spacing = 1, .at = StartPlace{0, 0, {}}, .heading = rest_robots::pi / 2};
    const Fleet fleet = place_fleet(std::span(&kind, 1), {});
    REQUIRE(fleet.robots.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        const Spawn& spawn = fleet.robots[i].spawn;
        CHECK(spawn.position.x() == Approx(double(i) - 1.5));
        CHECK(spawn.position.z() == Approx(0.02 + std::tan(0.2) * spawn.position.x()).margin(1e-6));
        CHECK(spawn.roll == Approx(-0.2).margin(1e-6));  // it looks along y, the ground rises along x
        CHECK(std::abs(spawn.pitch) < 1e-6);
    }
    // The second of the two kinds has a formation whose third robot would overlap one of the first kind.
    std::vector<FleetKind> kinds{kind, kind};
    kinds[0].name = "first";
    kinds[1].name = "second";
    kinds[1].formation->at = StartPlace{0.7, 0.3, {}};
    const Fleet two = place_fleet(kinds, {});
    CHECK(two.kinds[0].found == 4);
    CHECK(two.kinds[1].found == 0);
    CHECK_THAT(two.kinds[1].why, Contains("second_1 has no place at -0.8, 0.3: it overlaps another robot"));
    kinds[1].formation->at = StartPlace{8, 0, {}};
    CHECK_THAT(place_fleet(kinds, {}).kinds[1].why, Contains("off the map"));
    CHECK_THAT(place_fleet(std::span(&kind, 1), {.min_distance = 1.1}).kinds[0].why,
               Contains("another robot is nearer than the distance"));
}

TEST_CASE("a formation without a place finds the one gap that is large enough")
{
    // Rooms of 1.4 m, and one of 4.4 m, in which three robots in a line have room.
    Scene scene = rooms(3);
    const auto gap = std::ranges::find_if(scene.parts, [](const Part& part) { return part.name == "wall"; });
    REQUIRE(gap != scene.parts.end());
    add_block(scene, {10, 0, -0.5}, {14.4, 1.1, 0});
    const TestMap map = map_of(std::move(scene));
    FleetKind kind = kind_of(map, boxy({0.5, 1, 0.3}), 3);
    kind.formation = Formation{.spacing = 1.4};
    const Fleet fleet = place_fleet(std::span(&kind, 1), {.seed = 2});
    REQUIRE(fleet.robots.size() == 3);
    for (const FleetRobot& robot : fleet.robots) CHECK(robot.spawn.position.x() > 10);
    CHECK(distance(fleet.robots[0], fleet.robots[1]) == Approx(1.4));
    CHECK(distance(fleet.robots[1], fleet.robots[2]) == Approx(1.4));
    kind.count = 5;
    const Fleet none = place_fleet(std::span(&kind, 1), {});
    CHECK(none.robots.empty());
    REQUIRE(none.kinds[0].proof);
    CHECK(none.kinds[0].proof->headings == 16);
    CHECK_THAT(none.kinds[0].why, Contains("room at none of the") && Contains("16 headings"));
}

TEST_CASE("a convoy drives along the path that the robot finds around a wall")
{
    Scene scene = floor_of(8);
    add_shape(scene, "wall", Label::Obstacle, box_shape({0.2, 6, 1}, {{0, -1, 0.5}}));
    const TestMap map = map_of(std::move(scene));
    FleetKind kind = kind_of(map, boxy({0.4, 0.3, 0.2}), 6);
    const ReachGraph graph(kind.judge, {.step = 0.2, .keep_ways = true});
    kind.formation = Formation{
        .form = Form::Convoy, .spacing = 1, .path = drivable_path(kind.judge, graph, {-2, -2, {}}, {2, -2, {}})};
    CHECK(path_length(*kind.formation) > 8);  // 4 m in a straight line; the gap is at y > 2
    const Fleet fleet = place_fleet(std::span(&kind, 1), {});
    REQUIRE(fleet.robots.size() == 6);
    CHECK(fleet.robots[5].spawn.position.head<2>().isApprox(Eigen::Vector2d(-2, -2), 1e-6));
    CHECK(std::ranges::any_of(fleet.robots, [](const FleetRobot& robot) { return robot.spawn.position.y() > 1.5; }));
    CHECK_THROWS_WITH(drivable_path(kind.judge, graph, {-2, -2, {}}, {0, -2, {}}), Contains("at none of 16"));
    kind.count = 40;
    CHECK_THAT(place_fleet(std::span(&kind, 1), {}).kinds[0].why, Contains("40 robots need 39 m"));
}

TEST_CASE("islands of two kinds are linked if they have ground in common")
{
    Scene scene = floor_of(6);
    const auto wall = [&](double low, double high) {
        add_shape(scene, "wall", Label::Obstacle, box_shape({0.2, high - low, 1}, {{0.5, (low + high) / 2, 0.5}}));
    };
    wall(-3, -0.4);  // the gap of 0.8 m is too narrow for the large robot
    wall(0.4, 3);
    const TestMap map = map_of(std::move(scene));
    const Judge large(map, boxy({1, 1, 0.3})), small(map, boxy({0.3, 0.3, 0.3}));
    const ReachGraph of_large(large, {.step = 0.25}), of_small(small, {.step = 0.1});
    REQUIRE(of_large.islands().size() >= 2);
    CHECK(linked_island(of_small, of_large, 0) == 0u);
    CHECK(linked_island(of_small, of_large, 1) == 0u);
    CHECK(linked_island(of_large, of_small, 0) == 0u);
    CHECK(linked_island(of_large, of_large, 1) == 1u);
    CHECK_THROWS_WITH(linked_island(of_small, of_large, 99), Contains("99"));
    const TestMap other = map_of([] {
        Scene far;
        add_block(far, {20, 20, -0.5}, {26, 26, 0});
        return far;
    }());
    CHECK_FALSE(linked_island(ReachGraph(Judge(other, boxy({1, 1, 0.3})), {.step = 0.5}), of_large, 0));
}

TEST_CASE("faults in the options of a fleet are named")
{
    const TestMap map = map_of(floor_of(4));
    const FleetKind kind = kind_of(map, boxy({0.4, 0.4, 0.2}), 2);
    const auto run = [](FleetKind one, const FleetOptions& options = {}) {
        return place_fleet(std::span(&one, 1), options);
    };
    CHECK_THROWS_WITH(place_fleet({}, {}), Contains("kinds is empty"));
    CHECK_THROWS_WITH(run(kind, {.min_distance = -1}), Contains("min_distance") && Contains("-1"));
    CHECK_THROWS_WITH(run(kind, {.between = {{0, 3, 1}}}), Contains("kind that does not exist"));
    CHECK_THROWS_WITH(run(kind, {.between = {{0, 0, NAN}}}), Contains("between"));
    FleetKind wrong = kind;
    wrong.count = 0;
    CHECK_THROWS_WITH(run(wrong), Contains("count of kind \"boxy\""));
    wrong = kind;
    wrong.fill_step = 0;
    CHECK_THROWS_WITH(run(wrong), Contains("fill_step"));
    wrong = kind;
    wrong.spawns.place.clearance = 1;
    CHECK_THROWS_WITH(run(wrong), Contains("rules of place"));
    wrong = kind;
    wrong.count.reset();
    wrong.formation = Formation{};
    CHECK_THROWS_WITH(run(wrong), Contains("a formation needs it"));
    wrong = kind;
    wrong.formation = Formation{};
    CHECK_THROWS_WITH(run(wrong, {.formation = Formation{}}), Contains("the whole fleet has one"));
}

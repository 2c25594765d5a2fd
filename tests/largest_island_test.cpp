#include "catch.h"
#include "shared_scenes.h"
#include "test_map.h"

#include <spawnfield/island_choice.h>

#include <array>
#include <cmath>
#include <functional>
#include <set>

using namespace spawnfield;

// On the largest island of real scenes, robots stand on floors to which they can drive, and not on desks, shelves, wall
// tops, roofs or ceilings.

namespace {

/// A scene whose floors are known, and how a robot stands there.
struct FloorScene {
    std::string file;
    Robot robot;
    double reach_step;  ///< m: coarse, so that the test does not take long
    /// Returns whether ground (m) is one of the floors on which the robot may stand.
    std::function<bool(const Vec3&)> is_floor;
    std::size_t heights;     ///< at least so many floors of 1 m are used
    Bounds bounds = {};      ///< empty: those of the scene
    bool has_others = true;  ///< the robot can also stand on other things
};

std::function<bool(const Vec3&)> between(double low, double high)
{
    return [=](const Vec3& ground) { return ground.z() >= low && ground.z() <= high; };
}

/// Decks (SOURCE.md), and the ramps in the middle of the garage.
bool is_in_garage(const Vec3& ground)
{
    constexpr std::array decks{0.23, 5.79, 11.35, 16.92, 22.48, 28.03, 33.59, 39.14};
    const bool is_on_ramp = std::abs(ground.x()) < 5.5 && std::abs(ground.y()) < 9 && ground.z() < 39.14;
    return is_on_ramp ||
           std::any_of(decks.begin(), decks.end(), [&](double deck) { return std::abs(ground.z() - deck) < 0.02; });
}

std::vector<FloorScene> scenes()
{
    const Robot small = load_robot("box:0.3,0.3,0.2"), large = husky();
    const Bounds block{{-60, -60, -5}, {-10, -10, 30}};
    return {
        {"warehouse/worlds/small_warehouse.world", large, 0.25, between(0, 0.05), 1, {}, false},
        // Some voxels of the scanned floor are one higher or lower. The ceiling is at 2.7 m, desks are at 0.7 m.
        {"octomap/scene.yaml", small, 0.25, between(-0.13, 0.13), 1},
        {"mine/scene.yaml", large, 1, between(0, 0.18), 1},
        // The halls and stairs are below 17 m, and the tops of walls and towers above 20 m.
        {"dungeon/scene.yaml", large, 0.6, between(-0.1, 17), 10},
        {"parking_garage/scene.yaml", large, 1, is_in_garage, 7},
        // Streets and the open ground beside them; sidewalks are 0.1 m higher.
        {"city/worlds/simple_city.world", large, 0.5, between(5, 5.15), 1, block},
    };
}

}  // namespace

TEST_CASE("on the largest islands of real scenes, robots stand on floors only", "[slow]")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    for (const FloorScene& real : scenes()) {
        CAPTURE(real.file);
        Scene scene = load_scene(*folder / real.file, {.allow_missing = true, .bounds = real.bounds});
        const TestMap map = map_of(std::move(scene), 0.1, real.bounds);
        const Judge judge(map, real.robot);
        const ReachGraph graph(judge, {.step = real.reach_step});
        REQUIRE(graph.islands().size() > 1);
        std::size_t others = 0;
        std::set<int> heights;
        for (const ReachPlace& place : graph.places()) {
            const Vec3 ground(place.x, place.y, place.ground);
            if (place.island != 0) {
                others += !real.is_floor(ground);
                continue;
            }
            CAPTURE(ground.transpose());
            CHECK(real.is_floor(ground));
            heights.insert(int(std::floor(ground.z() + 0.5)));
        }
        CHECK((others > 0) == real.has_others);
        CHECK(heights.size() >= real.heights);
        const std::vector<std::size_t> islands = chosen_islands(graph, judge, {.largest = true});
        const ReachFilter filter = on_islands(graph, islands);
        const SpawnList list = sample(judge, {.count = 100, .random_yaw = true, .is_reachable = filter});
        CHECK(list.spawns.size() == 100);
        for (const Spawn& spawn : list.spawns) {
            CAPTURE(spawn.position.transpose());
            const Column column = column_at(map.geometry, spawn.position.x(), spawn.position.y());
            const auto ground = ground_below(column, spawn.position.z());
            REQUIRE(ground.has_value());
            CHECK(real.is_floor({spawn.position.x(), spawn.position.y(), ground->height}));
        }
    }
}

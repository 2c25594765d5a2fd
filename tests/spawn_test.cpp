#include "catch.h"
#include "hand_scene.h"
#include "test_map.h"

#include "query/draw.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>

#include <numbers>

using namespace spawnfield;

namespace {

Verdict judged(const Map& map, const CollisionChecker& checker, const Spawn& spawn, double max_height)
{
    QueryOptions options;
    options.max_height = max_height;
    const Vec3& p = spawn.position;
    return judge(map, checker, column_at(map.geometry, p.x(), p.y()), {p, rotation_from_rpy(0, 0, spawn.yaw)}, options).verdict;
}

double smallest_distance(const std::vector<Spawn>& spawns)
{
    double smallest = 1e9;
    for (std::size_t i = 0; i < spawns.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) smallest = std::min(smallest, (spawns[i].position - spawns[j].position).norm());
    return smallest;
}

SampleOptions sample_options(std::size_t count, double min_distance)
{
    SampleOptions options;
    options.count = count;
    options.min_distance = min_distance;
    options.random_yaw = true;
    options.seed = 11;
    return options;
}

/// Search by its definition: one draw after the other, all distances.
std::vector<Vec3> slow_search(const Map& map, const CollisionChecker& checker, const SearchOptions& options)
{
    std::vector<Vec3> checked, found;
    std::uint64_t failures = 0;
    for (std::uint64_t index = 0; found.size() < options.count && failures < options.max_failures; ++index) {
        Draw draw(options.seed, index);
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = draw.uniform(map.bounds.min[axis], map.bounds.max[axis]);
        ++failures;
        bool clear = true;
        for (const Vec3& other : checked) clear = clear && (other - p).norm() >= options.min_distance;
        if (!clear) continue;
        checked.push_back(p);
        if (judged(map, checker, {p, 0}, options.max_height) != Verdict::Valid) continue;
        found.push_back(p);
        failures = 0;
    }
    return found;
}

}  // namespace

TEST_CASE("every sample is valid by check and keeps its distance")
{
    std::size_t found = 0;
    for (std::uint64_t seed = 0; seed <= 8; ++seed) {
        const Map map = seed == 0 ? training_map() : map_of(random_scene(seed));
        const CollisionChecker checker = checker_of(map, seed == 0 ? husky() : random_robot(seed));
        const SpawnList list = sample(map, checker, sample_options(60, 0.8));
        CAPTURE(seed);
        found += list.spawns.size();
        CHECK(smallest_distance(list.spawns) >= 0.8);
        for (const Spawn& spawn : list.spawns) CHECK(judged(map, checker, spawn, 1e9) == Verdict::Valid);
    }
    CHECK(found > 300);
}

TEST_CASE("search is its definition, draw by draw")
{
    const TestMap map = training_map();
    const CollisionChecker checker = checker_of(map, husky());
    for (const double distance : {0.0, 1.5}) {
        SearchOptions options;
        options.count = 40;
        options.min_distance = distance;
        options.seed = 3;
        options.max_failures = 500;
        const SpawnList list = search(map, checker, options);
        const std::vector<Vec3> slow = slow_search(map, checker, options);
        REQUIRE(list.spawns.size() == slow.size());
        for (std::size_t i = 0; i < slow.size(); ++i) CHECK(list.spawns[i].position == slow[i]);
        if (distance > 0) CHECK(smallest_distance(list.spawns) >= distance);
        CHECK(list.counts[std::size_t(Verdict::Valid)] == slow.size());
    }
}

TEST_CASE("search stops after the failures in a row that it is given")
{
    const TestMap map = training_map();
    const CollisionChecker checker = checker_of(map, load_robot("box:30,30,30"));
    SearchOptions options;
    options.count = 3;
    options.max_failures = 777;
    const SpawnList list = search(map, checker, options);
    CHECK(list.spawns.empty());
    CHECK(list.draws == 777);
}

TEST_CASE("the same seed gives the same bytes at any thread count, another seed others")
{
    const TestMap map = map_of(random_scene(6));
    const CollisionChecker checker = checker_of(map, random_robot(6));
    const auto sampled = [&](int threads, std::uint64_t seed) {
        SampleOptions options = sample_options(200, 0.2);
        options.threads = threads;
        options.seed = seed;
        return spawns_csv(sample(map, checker, options));
    };
    const auto searched = [&](int threads) {
        SearchOptions options;
        options.count = 50;
        options.min_distance = 0.5;
        options.threads = threads;
        return spawns_csv(search(map, checker, options));
    };
    const std::string sample_1 = sampled(1, 5), search_1 = searched(1);
    for (const int threads : {2, 8}) {
        CHECK(sampled(threads, 5) == sample_1);
        CHECK(searched(threads) == search_1);
    }
    CHECK(sampled(1, 6) != sample_1);
}

TEST_CASE("20,000 samples are uniform by area over the feasible region")
{
    // Two storeys over each other, a slope of twice its horizontal area, and a gap: by horizontal area 36 + 9 + 18 m2.
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(6, 6));
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(3, 3), {{0, 0, 2}, Mat3::Identity()}));
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(6, 6), {{8, 0, 4}, rotation_from_rpy(0, 1.0471975511965976, 0)}));
    const TestMap map = map_of(scene);
    const CollisionChecker checker = checker_of(map, load_robot("box:0.001,0.001,0.001@0,0,0"));
    SampleOptions options = sample_options(20000, 0);
    const SpawnList list = sample(map, checker, options);
    REQUIRE(list.spawns.size() == 20000);
    std::vector<double> observed(63, 0);  // cells of 1 x 1 m; those of the slope are 0.5 m wide and 2 m deep
    for (const Spawn& spawn : list.spawns) {
        const Vec3& p = spawn.position;
        std::size_t bin = 0;
        if (p.x() > 6) bin = 45 + std::size_t((p.x() - 6.5) / 0.5) * 3 + std::size_t((p.y() + 3) / 2);
        else if (p.z() > 1.5) bin = 36 + std::size_t(p.x() + 1.5) * 3 + std::size_t(p.y() + 1.5);
        else bin = std::size_t(p.x() + 3) * 6 + std::size_t(p.y() + 3);
        REQUIRE(bin < observed.size());
        observed[bin] += 1;
    }
    double chi_square = 0;
    const double expected = 20000.0 / 63;
    for (const double n : observed) chi_square += (n - expected) * (n - expected) / expected;
    CHECK(chi_square < 103.4);  // 62 degrees of freedom: 0.1 % of honest runs are above; 0.1 % below 31.7
    CHECK(chi_square > 31.7);
}

TEST_CASE("random yaw is uniform and a fixed yaw is kept")
{
    const TestMap map = training_map();
    const CollisionChecker checker = checker_of(map, load_robot("box:0.1,0.1,0.1"));
    SampleOptions options = sample_options(4000, 0);
    std::vector<int> bins(8, 0);
    for (const Spawn& spawn : sample(map, checker, options).spawns) ++bins[std::size_t((spawn.yaw + std::numbers::pi) / (std::numbers::pi / 4))];
    for (const int n : bins) CHECK(std::abs(n - 500) < 100);
    options.random_yaw = false;
    options.yaw = 0.7;
    for (const Spawn& spawn : sample(map, checker, options).spawns) CHECK(spawn.yaw == 0.7);
}

TEST_CASE("a region narrows a sample and layers choose a storey")
{
    const TestMap map = training_map();
    const CollisionChecker checker = checker_of(map, husky());
    SampleOptions options = sample_options(100, 0);
    options.bounds = {Vec3(-3, 5, 0), Vec3(0, 9, 0)};
    options.layers = {LayerChoice::Kind::Top, 0};
    for (const Spawn& spawn : sample(map, checker, options).spawns) {
        CHECK(spawn.position.z() == Approx(0.93 + 0.1));  // on the platform
        CHECK((spawn.position.x() >= -3 && spawn.position.x() <= 0 && spawn.position.y() >= 5 && spawn.position.y() <= 9));
    }
}

TEST_CASE("a sample that does not fit gives what it found")
{
    const TestMap map = training_map();
    const CollisionChecker checker = checker_of(map, husky());
    const SpawnList list = sample(map, checker, sample_options(100, 6));
    CHECK(list.spawns.size() >= 4);
    CHECK(list.spawns.size() < 20);
    CHECK(smallest_distance(list.spawns) >= 6);
}

TEST_CASE("counts and distances out of their limits are refused")
{
    const TestMap map = training_map();
    const CollisionChecker checker = checker_of(map, husky());
    CHECK_THROWS_WITH(sample(map, checker, sample_options(0, 1)), "sample: count is 0, needs >= 1");
    CHECK_THROWS_WITH(sample(map, checker, sample_options(99999999999, 1)), "sample: count is 99999999999, needs at most 100000000");
    CHECK_THROWS_WITH(sample(map, checker, sample_options(1, -1)), "sample: min_distance is -1, needs >= 0 m");
    SearchOptions options;
    options.max_failures = 0;
    CHECK_THROWS_WITH(search(map, checker, options), "search: max_failures is 0, needs >= 1");
}

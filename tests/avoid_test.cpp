#include "catch.h"
#include "compare.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include "query/draw.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>

#include <numbers>

using namespace spawnfield;

namespace {

SampleOptions sample_options(std::size_t count, double min_distance)
{
    return {.count = count, .min_distance = min_distance, .random_yaw = true, .seed = 5, .stance = Stance::Level};
}

Verdict judged(const Judge& judge, const Spawn& spawn)
{
    return judge.check({spawn.position, rotation_from_rpy(0, 0, spawn.yaw)}).verdict;
}

bool is_clear(const std::vector<AvoidedPoints>& avoid, const Vec3& p)
{
    for (const AvoidedPoints& group : avoid)
        for (const Vec3& point : group.points)
            if ((point - p).norm() < group.distance) return false;
    return true;
}

bool is_clear(const std::vector<Vec3>& points, double distance, const Vec3& p)
{
    return is_clear({{"", points, distance}}, p);
}

/// Returns two groups of points, anywhere in the map and slightly beyond it.
std::vector<AvoidedPoints> random_avoided(const Bounds& bounds, Random& random)
{
    std::vector<AvoidedPoints> out;
    for (const int count : {25, 6}) {
        AvoidedPoints& group = out.emplace_back();
        group.distance = count == 25 ? random.between(0.3, 1.5) : random.between(1, 4);
        for (int n = 0; n < count; ++n) {
            Vec3 p;
            for (int axis = 0; axis < 3; ++axis) p[axis] = random.between(bounds.min[axis] - 1, bounds.max[axis] + 1);
            group.points.push_back(p);
        }
    }
    return out;
}

/// A list of spawns with the numbers of rejected draws, computed from the definitions: one draw after the other, with
/// all distances.
struct SlowList {
    std::vector<Vec3> found;
    std::uint64_t draws = 0, near_avoided = 0, too_close = 0;
    bool gave_up = false;  ///< then sample continues with cells, which this list does not cover
};

SlowList slow_search(const Judge& judge, const SearchOptions& options)
{
    const Judge exhaustive = without_mask(judge);
    const Map& map = judge.map();
    SlowList out;
    std::vector<Vec3> checked;
    for (std::uint64_t index = 0, failures = 0; out.found.size() < options.count && failures < options.max_failures;
         ++index) {
        Draw draw(options.seed, index);
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = draw.uniform(map.bounds.min[axis], map.bounds.max[axis]);
        ++out.draws;
        ++failures;
        const bool near = !is_clear(options.avoid, p), close = !near && !is_clear(checked, options.min_distance, p);
        out.near_avoided += near;
        out.too_close += close;
        if (near || close) continue;
        checked.push_back(p);
        if (judged(exhaustive, {p, options.yaw}) != Verdict::Valid) continue;
        out.found.push_back(p);
        failures = 0;
    }
    return out;
}

/// Returns the draws before sample starts to use cells. `slots` must be at least the number of layers of any column.
SlowList slow_sample(const Judge& judge, const SampleOptions& options, int slots)
{
    const Judge exhaustive = at_any_height(judge);
    const Map& map = judge.map();
    SlowList out;
    for (std::uint64_t index = 0, failures = 0; out.found.size() < options.count; ++index) {
        out.gave_up = failures++ >= 2000;
        if (out.gave_up) return out;
        Draw draw(options.seed, index);
        const double x = draw.uniform(map.bounds.min.x(), map.bounds.max.x()),
                     y = draw.uniform(map.bounds.min.y(), map.bounds.max.y());
        const double slot = draw.uniform(0, slots), yaw = draw.uniform(-std::numbers::pi, std::numbers::pi);
        ++out.draws;
        const std::vector<double> layers = column_at(map.geometry, x, y).layers;
        if (slot >= double(layers.size())) continue;
        const Vec3 p(x, y, layers[std::size_t(slot)] + options.offset.value_or(auto_offset(judge.robot())));
        const bool near = !is_clear(options.avoid, p), close = !near && !is_clear(out.found, options.min_distance, p);
        out.near_avoided += near;
        out.too_close += close;
        if (near || close || judged(exhaustive, {p, yaw}) != Verdict::Valid) continue;
        out.found.push_back(p);
        failures = 0;
    }
    return out;
}

void check_same(const SpawnList& list, const SlowList& slow)
{
    REQUIRE(list.spawns.size() >= slow.found.size());
    for (std::size_t i = 0; i < slow.found.size(); ++i) CHECK(list.spawns[i].position == slow.found[i]);
    if (slow.gave_up) return;
    CHECK(list.spawns.size() == slow.found.size());
    CHECK(list.draws == slow.draws);
    CHECK(list.near_avoided == slow.near_avoided);
    CHECK(list.too_close == slow.too_close);
}

/// Returns the number of grid positions at which a spawn could still be added.
std::size_t room_left(const Judge& judge, const SampleOptions& options, const SpawnList& list, int cells)
{
    const Judge exhaustive = at_any_height(judge);
    const Map& map = judge.map();
    std::vector<Vec3> taken;
    for (const Spawn& spawn : list.spawns) taken.push_back(spawn.position);
    Random random{1};
    std::size_t count = 0;
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j) {
            const Vec3 p =
                map.bounds.min +
                (map.bounds.max - map.bounds.min).cwiseProduct(Vec3(double(i) / cells, double(j) / cells, 0));
            for (const double layer : column_at(map.geometry, p.x(), p.y()).layers) {
                const Vec3 at(p.x(), p.y(), layer + options.offset.value_or(auto_offset(judge.robot())));
                if (!is_clear(options.avoid, at) || !is_clear(taken, options.min_distance, at)) continue;
                count += judged(exhaustive, {at, random.between(-M_PI, M_PI)}) == Verdict::Valid;
            }
        }
    return count;
}

/// Returns a room of 8 x 6 m: a floor of one kind (sheet, box, closed mesh), and walls around it.
Scene room(int kind)
{
    Scene scene;
    if (kind == 0) hand::add_mesh(scene, Label::Terrain, hand::rectangle(8, 6));
    if (kind == 1)
        hand::add_shape(scene, Label::Terrain, {ShapeKind::Box, {8, 6, 0.5}, {{0, 0, -0.25}, Mat3::Identity()}});
    if (kind == 2)
        hand::add_mesh(scene, Label::Terrain, hand::moved(hand::box({8, 6, 0.5}), {{0, 0, -0.25}, Mat3::Identity()}));
    for (const double side : {-1.0, 1.0}) {
        hand::add_shape(scene, Label::Obstacle, {ShapeKind::Box, {0.2, 6, 2}, {{3.9 * side, 0, 1}, Mat3::Identity()}});
        hand::add_shape(scene, Label::Obstacle, {ShapeKind::Box, {8, 0.2, 2}, {{0, 2.9 * side, 1}, Mat3::Identity()}});
    }
    return scene;
}

/// Returns points all over the room, `step` apart, except in a disc of 1.2 m around the gap.
std::vector<Vec3> grid_points(double step, const Vec3& gap)
{
    std::vector<Vec3> out;
    for (double x = -4; x <= 4.001; x += step)
        for (double y = -3; y <= 3.001; y += step)
            if ((Vec3(x, y, 0.1) - gap).norm() > 1.2) out.emplace_back(x, y, 0.1);
    return out;
}

const Vec3 nowhere(100, 100, 0);

}  // namespace

TEST_CASE("no spawn is nearer to an avoided point than its distance, in random scenes")
{
    std::size_t sampled = 0, searched = 0, near = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        CAPTURE(seed);
        const TestMap map = map_of(random_scene(seed));
        const Judge judge(map, random_robot(seed));
        Random random{seed};
        SampleOptions options = sample_options(60, 0.4);
        options.avoid = random_avoided(map.bounds, random);
        const SpawnList list = sample(judge, options);
        for (const Spawn& spawn : list.spawns) {
            CHECK(is_clear(options.avoid, spawn.position));
            CHECK(judged(at_any_height(judge), spawn) == Verdict::Valid);
        }
        SearchOptions search_options{.count = 20, .avoid = options.avoid, .max_failures = 3000};
        const SpawnList other = search(judge, search_options);
        for (const Spawn& spawn : other.spawns) CHECK(is_clear(options.avoid, spawn.position));
        sampled += list.spawns.size();
        searched += other.spawns.size();
        near += list.near_avoided + other.near_avoided;
    }
    CHECK(sampled > 300);
    CHECK(searched > 50);
    CHECK(near > 300);
}

TEST_CASE("search and sample with avoided points follow their definitions, draw by draw")
{
    std::size_t found = 0, near = 0, close = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        CAPTURE(seed);
        TestMap map = map_of(random_scene(seed));
        map.layers = 16;  // at least as many as in any column, so that sample never starts again
        const Judge judge(map, random_robot(seed));
        Random random{seed + 50};
        SearchOptions options{
            .count = 15, .min_distance = 0.5, .avoid = random_avoided(map.bounds, random), .max_failures = 1500};
        const SlowList slow = slow_search(judge, options);
        check_same(search(judge, options), slow);
        SampleOptions sampling = sample_options(8, 0.3);
        sampling.avoid = options.avoid;
        sampling.avoid[1].points.resize(2);
        const SlowList slow_samples = slow_sample(judge, sampling, 16);
        check_same(sample(judge, sampling), slow_samples);
        found += slow.found.size() + slow_samples.found.size();
        near += slow.near_avoided + slow_samples.near_avoided;
        close += slow.too_close + slow_samples.too_close;
    }
    CHECK(found > 100);
    CHECK(near > 200);
    CHECK(close > 5);
}

TEST_CASE("a room that avoided points cover is proven full at once")
{
    const int kind = GENERATE(0, 1, 2);
    const double min_distance = GENERATE(0.0, 0.5);
    CAPTURE(kind, min_distance);
    const TestMap map = map_of(room(kind));
    const Judge judge(map, load_robot("box:0.3,0.2,0.2"));
    SampleOptions options = sample_options(10, min_distance);
    options.avoid = {{"", grid_points(0.5, nowhere), 0.6}};
    const SpawnList list = sample(judge, options);
    CHECK(list.spawns.empty());
    CHECK(list.is_full);
    CHECK(list.undecided_area == 0);
    CHECK(list.draws < 5000);
    CHECK(list.near_avoided > 0);
}

TEST_CASE("the gap between avoided points is filled, and then proven full")
{
    const int kind = GENERATE(0, 1, 2);
    const double min_distance = GENERATE(0.15, 0.3);
    CAPTURE(kind, min_distance);
    const TestMap map = map_of(room(kind));
    const Judge judge(map, load_robot("box:0.3,0.2,0.2"));
    const Vec3 gap(1.3, -0.4, 0.1);
    SampleOptions options = sample_options(1000, min_distance);
    options.avoid = {{"", grid_points(0.25, gap), 0.7}};
    const SpawnList list = sample(judge, options);
    CHECK(list.spawns.size() >= 3);
    for (const Spawn& spawn : list.spawns)
        CHECK(((spawn.position - gap).norm() < 0.8 && is_clear(options.avoid, spawn.position)));
    CHECK(list.is_full);
    CHECK(list.undecided_area == 0);
    CHECK(room_left(judge, options, list, 400) == 0);
    CHECK(spawns_csv(sample(without_mask(judge), options)) == spawns_csv(list));
}

TEST_CASE("a second robot finds no room where the first has filled the map, and some with a smaller distance")
{
    const TestMap map = map_of(room(1));
    const Judge judge(map, load_robot("box:0.3,0.2,0.2"));
    const SpawnList first = sample(judge, sample_options(1000, 0.8));
    REQUIRE(first.is_full);
    SampleOptions options = sample_options(1000, 0);
    options.seed = 6;
    AvoidedPoints& taken = options.avoid.emplace_back();
    for (const Spawn& spawn : first.spawns) taken.points.push_back(spawn.position);
    taken.distance = 0.8;
    const SpawnList none = sample(judge, options);
    CHECK((none.spawns.empty() && none.is_full && none.undecided_area == 0));
    taken.distance = 0.4;
    options.min_distance = 0.5;
    const SpawnList second = sample(judge, options);
    CHECK(second.spawns.size() > 20);
    CHECK((second.is_full || second.undecided_area < 0.01));
    for (const Spawn& spawn : second.spawns) CHECK(is_clear(options.avoid, spawn.position));
    CHECK(room_left(judge, options, second, 300) == 0);
}

TEST_CASE("avoided points with distance 0, or far away, change no byte")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    SampleOptions options = sample_options(1000, 1.5);
    SearchOptions searching{.count = 30, .min_distance = 1, .max_failures = 2000};
    const SpawnList sampled = sample(judge, options), searched = search(judge, searching);
    for (const AvoidedPoints& group : {AvoidedPoints{"", {Vec3(0, 0, 0), Vec3(1, 2, 0.1)}, 0}, AvoidedPoints{"", {}, 3},
                                       AvoidedPoints{"", {Vec3(500, 0, 0)}, 2}}) {
        options.avoid = searching.avoid = {group};
        const SpawnList list = sample(judge, options);
        CHECK(spawns_csv(list) == spawns_csv(sampled));
        CHECK((list.draws == sampled.draws && list.undecided_area == sampled.undecided_area && list.near_avoided == 0));
        CHECK(spawns_csv(search(judge, searching)) == spawns_csv(searched));
    }
}

TEST_CASE("avoided points give the same bytes with any number of threads")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    SampleOptions options = sample_options(100000, 1.1);
    Random random{3};
    options.avoid = random_avoided(map.bounds, random);
    options.threads = 1;
    const SpawnList one = sample(judge, options);
    CHECK(one.near_avoided > 0);
    options.threads = 7;
    const SpawnList many = sample(judge, options);
    CHECK(spawns_csv(many) == spawns_csv(one));
    CHECK((many.draws == one.draws && many.near_avoided == one.near_avoided &&
           many.undecided_area == one.undecided_area));
}

TEST_CASE("distances and points that are not numbers are refused")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    SampleOptions options = sample_options(1, 0);
    options.avoid = {{"", {}, -1}};
    CHECK_THROWS_WITH(sample(judge, options), "sample: avoid.distance is -1, needs >= 0 m");
    SearchOptions searching{.avoid = {{"", {Vec3(0, std::nan(""), 0)}, 1}}};
    CHECK_THROWS_WITH(search(judge, searching), "search: avoid.points is nan, needs finite numbers, m");
}

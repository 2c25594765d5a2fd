#include "catch.h"
#include "compare.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include "query/cell_proofs.h"
#include "query/draw.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>

#include <atomic>
#include <chrono>
#include <numbers>
#include <set>
#include <thread>

using namespace spawnfield;

namespace {

Verdict judged(const Judge& judge, const Spawn& spawn)
{
    return judge.check({spawn.position, rotation_from_rpy(0, 0, spawn.yaw)}).verdict;
}

double smallest_distance(const std::vector<Spawn>& spawns)
{
    double smallest = 1e9;
    for (std::size_t i = 0; i < spawns.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            smallest = std::min(smallest, (spawns[i].position - spawns[j].position).norm());
    return smallest;
}

SampleOptions sample_options(std::size_t count, double min_distance)
{
    return {.count = count,
            .min_distance = min_distance,
            .random_yaw = true,
            .seed = 11,
            .stance = Stance::Level,
            .offset = 0.1};
}

/// Returns the result of search by its definition: one draw after the other, with all distances.
std::vector<Vec3> slow_search(const Judge& judge, const SearchOptions& options)
{
    const Judge exhaustive = without_mask(judge);
    const Map& map = judge.map();
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
        if (judged(exhaustive, {p, 0}) != Verdict::Valid) continue;
        found.push_back(p);
        failures = 0;
    }
    return found;
}

/// Returns a valid pose in one of the chosen layers at (x, y); NaN if there is none.
Spawn valid_at(const Judge& judge, const SampleOptions& options, double x, double y, Random& random)
{
    const Column column = column_at(judge.map().geometry, x, y);
    const int count = int(column.layers.size());
    for (int layer = 0; layer < count; ++layer) {
        if (!options.layers.includes(layer, count)) continue;
        const Spawn spawn{{x, y, column.layers[std::size_t(layer)] + *options.offset},
                          options.random_yaw ? random.between(-M_PI, M_PI) : options.yaw};
        if (judged(judge, spawn) == Verdict::Valid) return spawn;
    }
    return {Vec3::Constant(std::nan("")), 0};
}

/// Returns how many points of a grid could still be added.
std::size_t room_left(const Judge& judge, const SampleOptions& options, const SpawnList& list, int cells)
{
    const Judge exhaustive = at_any_height(judge);
    const Map& map = judge.map();
    Random random{1};
    std::size_t count = 0;
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j) {
            const Vec3 p =
                map.bounds.min +
                (map.bounds.max - map.bounds.min).cwiseProduct(Vec3(double(i) / cells, double(j) / cells, 0));
            for (const double layer : column_at(map.geometry, p.x(), p.y()).layers) {
                const Vec3 at(p.x(), p.y(), layer + *options.offset);
                const bool clear = std::all_of(list.spawns.begin(), list.spawns.end(), [&](const Spawn& s) {
                    return (s.position - at).norm() >= options.min_distance;
                });
                if (clear && judged(exhaustive, {at, random.between(-M_PI, M_PI)}) == Verdict::Valid) ++count;
            }
        }
    return count;
}

/// Returns a raster with a pose on each layer and columns `step` m apart.
RasterResult raster_of_tops(const Judge& judge, double step)
{
    RasterOptions options{.step = step};
    return raster(judge, options);
}

/// Returns a floor of 10 x 10 m (a sheet, a box or a closed mesh) with a ramp that has things on it and inside it.
Scene floor_scene(int kind)
{
    Scene scene;
    if (kind == 0) hand::add_mesh(scene, Label::Terrain, hand::rectangle(10, 10));
    if (kind == 1)
        hand::add_shape(scene, Label::Terrain, {ShapeKind::Box, {10, 10, 0.5}, {{0, 0, -0.25}, Mat3::Identity()}});
    if (kind == 2)
        hand::add_mesh(scene, Label::Terrain, hand::moved(hand::box({10, 10, 0.5}), {{0, 0, -0.25}, Mat3::Identity()}));
    if (kind == 3) {
        hand::add_mesh(scene, Label::Terrain,
                       hand::moved(hand::rectangle(10, 10), {{0, 0, 0}, rotation_from_rpy(0, 0.2, 0)}));
        hand::add_shape(scene, Label::Obstacle, {ShapeKind::Box, {2, 3, 4}, {{2, 2, 0}, rotation_from_rpy(0, 0, 0.5)}});
        hand::add_shape(scene, Label::Obstacle, {ShapeKind::Cylinder, {0.5, 6, 0}, {{-2, -2, 0}, Mat3::Identity()}});
    }
    return scene;
}

}  // namespace

TEST_CASE("every sample is valid by check and keeps its distance")
{
    std::size_t found = 0;
    for (std::uint64_t seed = 0; seed <= 8; ++seed) {
        const Map map = seed == 0 ? training_map() : map_of(random_scene(seed));
        const Judge judge(map, seed == 0 ? husky() : random_robot(seed));
        const SpawnList list = sample(judge, sample_options(60, 0.8));
        CAPTURE(seed);
        found += list.spawns.size();
        CHECK(smallest_distance(list.spawns) >= 0.8);
        const Judge exhaustive = at_any_height(judge);
        for (const Spawn& spawn : list.spawns) CHECK(judged(exhaustive, spawn) == Verdict::Valid);
    }
    CHECK(found > 300);
}

TEST_CASE("search follows its definition, draw by draw")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    for (const double distance : {0.0, 1.5}) {
        SearchOptions options{.count = 40, .min_distance = distance, .seed = 3, .max_failures = 500};
        const SpawnList list = search(judge, options);
        const std::vector<Vec3> slow = slow_search(judge, options);
        REQUIRE(list.spawns.size() == slow.size());
        for (std::size_t i = 0; i < slow.size(); ++i) CHECK(list.spawns[i].position == slow[i]);
        if (distance > 0) CHECK(smallest_distance(list.spawns) >= distance);
        CHECK(list.counts[Verdict::Valid] == slow.size());
    }
}

TEST_CASE("search of settled robots follows its definition, draw by draw, and its spawns are valid")
{
    const TestMap map = training_map();
    const Judge judge(map, husky()), exhaustive = without_mask(judge);
    const double lift = judge.options().stand.lift;
    for (const double distance : {0.0, 1.5}) {
        SearchOptions options{.count = 40,
                              .min_distance = distance,
                              .random_yaw = true,
                              .seed = 3,
                              .stance = Stance::Settled,
                              .max_failures = 500};
        const SpawnList list = search(judge, options);
        std::vector<Vec3> checked;
        std::size_t found = 0;
        for (std::uint64_t index = 0; index < list.draws; ++index) {
            Draw draw(options.seed, index);
            Vec3 place;
            for (int axis = 0; axis < 3; ++axis) place[axis] = draw.uniform(map.bounds.min[axis], map.bounds.max[axis]);
            const SettledPose pose = exhaustive.settle(place, draw.uniform(-M_PI, M_PI));
            const Vec3 at = pose.has_pose ? pose.lifted(lift).position : place;
            const bool clear = std::all_of(checked.begin(), checked.end(),
                                           [&](const Vec3& other) { return (other - at).norm() >= distance; });
            if (!clear) continue;
            checked.push_back(at);
            if (pose.verdict != Verdict::Valid) continue;
            REQUIRE(found < list.spawns.size());
            const Spawn& spawn = list.spawns[found++];
            CHECK(spawn.position == at);
            CHECK(spawn.yaw == pose.yaw);
            CHECK(spawn.roll == pose.roll);
            CHECK(spawn.pitch == pose.pitch);
            CHECK(judge.is_valid(pose.lifted(lift)));
        }
        CHECK(found == list.spawns.size());
        CHECK(list.counts.total() == checked.size());
        CHECK(found >= 30);
        if (distance > 0) CHECK(smallest_distance(list.spawns) >= distance);
        const auto is_tilted = [](const Spawn& spawn) { return std::abs(spawn.roll) + std::abs(spawn.pitch) > 0.1; };
        CHECK(std::count_if(list.spawns.begin(), list.spawns.end(), is_tilted) > 0);
        for (const int threads : {1, 8}) {
            options.threads = threads;
            CHECK(spawns_csv(search(judge, options)) == spawns_csv(list));
            CHECK(spawns_csv(search(exhaustive, options)) == spawns_csv(list));
        }
    }
}

TEST_CASE("a search of settled robots keeps to the heights of its box and to its region, also with the ground")
{
    Scene scene;  // two storeys, 2 m apart
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(6, 6));
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(6, 6), {{0, 0, 2}, Mat3::Identity()}));
    const Judge judge(map_of(scene, 0.1, {{-3, -3, 0}, {3, 3, 3}}), load_robot("box:0.5,0.4,0.3"));
    SearchOptions options{.count = 30, .stance = Stance::Settled, .max_failures = 2000};
    const auto storeys = [&] {
        std::set<double> out;
        for (const Spawn& spawn : search(judge, options).spawns) out.insert(std::round(spawn.position.z()));
        return out;
    };
    CHECK(storeys() == std::set{0.0, 2.0});
    options.bounds = {{-3, -3, 0.1}, {3, 3, 3}};  // draws above the lower storey, but its ground is below the box
    CHECK(storeys() == std::set{2.0});
    CHECK(search(judge, options).off_area > 0);
    options.bounds = {{-3, -3, 0}, {3, 3, 1}};
    CHECK(storeys() == std::set{0.0});
    options.bounds = {};
    options.area.within = {box_region(-1, -1, 1, 1, {0.1, 3})};
    const SpawnList list = search(judge, options);
    CHECK(list.spawns.size() == 30);
    CHECK(list.off_area > 0);
    for (const Spawn& spawn : list.spawns) {
        CHECK(spawn.position.z() > 1.9);
        CHECK(spawn.position.head<2>().cwiseAbs().maxCoeff() <= 1);
    }
}

TEST_CASE("search stops after the given number of failures in a row")
{
    const TestMap map = training_map();
    const Judge judge(map, load_robot("box:30,30,30"));
    SearchOptions options{.count = 3, .max_failures = 777};
    const SpawnList list = search(judge, options);
    CHECK(list.spawns.empty());
    CHECK(list.draws == 777);
}

TEST_CASE("the same seed gives the same bytes with any number of threads, another seed gives others")
{
    const TestMap map = map_of(random_scene(6));
    const Judge judge(map, random_robot(6));
    const auto sampled = [&](int threads, std::uint64_t seed) {
        SampleOptions options = sample_options(200, 0.2);
        options.threads = threads;
        options.seed = seed;
        return spawns_csv(sample(judge, options));
    };
    const auto searched = [&](int threads) {
        SearchOptions options{.count = 50, .min_distance = 0.5, .threads = threads};
        return spawns_csv(search(judge, options));
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
    // Two storeys above each other, a slope with twice its horizontal area, and a gap. The horizontal areas are 36 + 9
    // + 18 m2.
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(6, 6));
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(3, 3), {{0, 0, 2}, Mat3::Identity()}));
    hand::add_mesh(scene, Label::Terrain,
                   hand::moved(hand::rectangle(6, 6), {{8, 0, 4}, rotation_from_rpy(0, 1.0471975511965976, 0)}));
    const TestMap map = map_of(scene);
    const Judge judge(map, load_robot("box:0.001,0.001,0.001@0,0,0"));
    SampleOptions options = sample_options(20000, 0);
    const SpawnList list = sample(judge, options);
    REQUIRE(list.spawns.size() == 20000);
    std::vector<double> observed(63, 0);  // cells of 1 x 1 m; those of the slope are 0.5 m wide and 2 m deep
    for (const Spawn& spawn : list.spawns) {
        const Vec3& p = spawn.position;
        std::size_t bin = 0;
        if (p.x() > 6)
            bin = 45 + std::size_t((p.x() - 6.5) / 0.5) * 3 + std::size_t((p.y() + 3) / 2);
        else if (p.z() > 1.5)
            bin = 36 + std::size_t(p.x() + 1.5) * 3 + std::size_t(p.y() + 1.5);
        else
            bin = std::size_t(p.x() + 3) * 6 + std::size_t(p.y() + 3);
        REQUIRE(bin < observed.size());
        observed[bin] += 1;
    }
    double chi_square = 0;
    const double expected = 20000.0 / 63;
    for (const double n : observed) chi_square += (n - expected) * (n - expected) / expected;
    CHECK(chi_square < 103.4);  // 62 degrees of freedom: 0.1 % of correct runs are above, 0.1 % below 31.7
    CHECK(chi_square > 31.7);
}

TEST_CASE("random yaw is uniform and a fixed yaw is kept")
{
    const TestMap map = training_map();
    const Judge judge(map, load_robot("box:0.1,0.1,0.1"));
    SampleOptions options = sample_options(4000, 0);
    std::vector<int> bins(8, 0);
    for (const Spawn& spawn : sample(judge, options).spawns)
        ++bins[std::size_t((spawn.yaw + std::numbers::pi) / (std::numbers::pi / 4))];
    for (const int n : bins) CHECK(std::abs(n - 500) < 100);
    options.random_yaw = false;
    options.yaw = 0.7;
    for (const Spawn& spawn : sample(judge, options).spawns) CHECK(spawn.yaw == 0.7);
}

TEST_CASE("a region restricts a sample, and layers select a storey")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    SampleOptions options = sample_options(100, 0);
    options.bounds = {Vec3(-3, 5, 0), Vec3(0, 9, 0)};
    options.layers = {LayerChoice::Kind::Top, 0};
    for (const Spawn& spawn : sample(judge, options).spawns) {
        CHECK(spawn.position.z() == Approx(0.93 + 0.1));  // on the platform
        CHECK((spawn.position.x() >= -3 && spawn.position.x() <= 0 && spawn.position.y() >= 5 &&
               spawn.position.y() <= 9));
    }
}

TEST_CASE("if not all spawns fit, sample returns those it found")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const SpawnList list = sample(judge, sample_options(100, 6));
    CHECK(list.spawns.size() >= 4);
    CHECK(list.spawns.size() < 20);
    CHECK(smallest_distance(list.spawns) >= 6);
}

TEST_CASE("a full region is proven full, and dense probing shows that nothing can be added")
{
    const int kind = GENERATE(0, 1, 2, 3);
    CAPTURE(kind);
    const TestMap map = map_of(floor_scene(kind));
    const Judge judge(map, load_robot("box:0.3,0.2,0.2"));
    const SampleOptions options = sample_options(10000, 1);
    const SpawnList list = sample(judge, options);
    CHECK(list.is_full);
    CHECK(list.undecided_area == 0);
    CHECK(list.spawns.size() > 60);
    CHECK(list.spawns.size() < 130);
    CHECK(smallest_distance(list.spawns) >= 1);
    CHECK(room_left(judge, options, list, 250) == 0);
}

TEST_CASE("as many spawns as fit are found on request; one more is too many")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    SampleOptions options = sample_options(100000, 1.2);
    options.random_yaw = false;
    const SpawnList all = sample(judge, options);
    CHECK(all.undecided_area < 0.01);
    CHECK(all.spawns.size() > 50);
    options.count = all.spawns.size();
    const SpawnList exact = sample(judge, options);
    CHECK(spawns_csv(exact) == spawns_csv(all));
    CHECK_FALSE(exact.is_full);
    ++options.count;
    CHECK(spawns_csv(sample(judge, options)) == spawns_csv(all));
}

TEST_CASE("a query that is stopped returns the first spawns of the whole list")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const auto is_start_of = [](const SpawnList& part, const SpawnList& all) {
        REQUIRE(part.spawns.size() <= all.spawns.size());
        for (std::size_t i = 0; i < part.spawns.size(); ++i)
            if (part.spawns[i].position != all.spawns[i].position || part.spawns[i].yaw != all.spawns[i].yaw)
                return false;
        return true;
    };
    for (const Stance stance : {Stance::Level, Stance::Settled}) {
        SampleOptions options = sample_options(100000, 1.2);  // more than fit, so that level ones are also filled
        options.stance = stance;
        if (stance == Stance::Settled) {
            options.count = 3000;
            options.min_distance = 0;
            options.offset.reset();
        }
        const SpawnList all = sample(judge, options);
        CHECK_FALSE(all.is_stopped);
        std::set<std::size_t> sizes;
        for (const long asked : {0L, 1L, 10L, 50L, 100L, 200L, 20000L}) {
            std::atomic<long> left{asked};
            options.stop = [&] { return left.fetch_sub(1) <= 0; };
            options.threads = int(asked % 3 + 1);
            const SpawnList part = sample(judge, options);
            CHECK(is_start_of(part, all));
            CHECK(part.is_stopped == (part.spawns.size() < options.count && left < 0));
            CHECK_FALSE((part.is_stopped && part.is_full));
            CHECK(std::isnan(part.undecided_area) == part.is_stopped);
            sizes.insert(part.spawns.size());
        }
        CHECK(sizes.contains(0));
        CHECK(sizes.size() >= 3);
    }
    SearchOptions options{.count = 1000, .min_distance = 0.5, .seed = 4};
    const SpawnList all = search(judge, options);
    std::atomic<long> left{20};
    options.stop = [&] { return left.fetch_sub(1) <= 0; };
    const SpawnList part = search(judge, options);
    CHECK(part.is_stopped);
    CHECK(is_start_of(part, all));
}

TEST_CASE("a stop loses less than a block of draws that were judged")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const int threads = GENERATE(1, 4);
    CAPTURE(threads);
    SampleOptions options{.count = 1000000, .threads = threads};
    std::atomic<long> chunks{9000};
    SECTION("of level robots")
    {
        options.stop = [&] { return chunks.fetch_sub(1) <= 0; };
        const SpawnList part = sample(judge, options);
        REQUIRE(part.is_stopped);
        // A chunk of 64 draws is judged whenever `stop` has returned false. It is also asked between batches.
        CHECK(double(part.draws) > 64 * (8980.0 - threads) - 262144);
    }
    SECTION("of settled robots, which take long here: half a second is lost")
    {
        constexpr std::chrono::microseconds draw_time(100);
        std::atomic<bool> is_time{false};
        std::atomic<long> judged{0};
        options.stance = Stance::Settled;
        options.is_reachable = [&](const SettledPose&) {
            std::this_thread::sleep_for(draw_time);
            if (++judged == 12000 * threads) is_time = true;  // in the middle of a batch
            return true;
        };
        options.stop = [&] { return is_time.load(); };
        const SpawnList part = sample(judge, options);
        REQUIRE(part.is_stopped);
        const double lost = threads * (0.5 / std::chrono::duration<double>(draw_time).count() + 64);
        CHECK(double(part.draws) > double(judged) - lost);
    }
}

TEST_CASE("filling a region gives the same bytes with any number of threads, and exhaustively")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    SampleOptions options = sample_options(100000, 1.1);
    options.threads = 1;
    const SpawnList one = sample(judge, options);
    for (const int threads : {2, 8}) {
        options.threads = threads;
        const SpawnList many = sample(judge, options);
        CHECK(spawns_csv(many) == spawns_csv(one));
        CHECK((many.draws == one.draws && many.undecided_area == one.undecided_area && many.counts == one.counts));
    }
    const SpawnList slow = sample(without_mask(judge), options);
    CHECK(spawns_csv(slow) == spawns_csv(one));
    CHECK((slow.draws == one.draws && slow.undecided_area == one.undecided_area && slow.counts == one.counts));
}

TEST_CASE("a small island in a large map is found")
{
    Scene scene;
    const int around = GENERATE(0, 1, 2);
    CAPTURE(around);
    const Vec3 place(123.4, -77.7, 1);
    const auto add = [&](Label label, const Vec3& size, const Vec3& centre) {
        hand::add_shape(scene, label, {ShapeKind::Box, size, {centre, Mat3::Identity()}});
    };
    add(Label::Terrain, {2, 2, 2}, place - Vec3(0, 0, 1));  // its top is at 1 m
    if (around > 0) add(Label::Terrain, {500, 500, 1}, {0, 0, -0.5});
    if (around == 1)
        hand::add_mesh(scene, Label::Water, hand::moved(hand::rectangle(500, 500), {{0, 0, 0.5}, Mat3::Identity()}));
    if (around == 2) {  // a slab over everything except the island
        add(Label::Obstacle, {250 + place.x() - 1, 500, 3}, {(place.x() - 1 - 250) / 2, 0, 1.5});
        add(Label::Obstacle, {250 - place.x() - 1, 500, 3}, {(place.x() + 1 + 250) / 2, 0, 1.5});
        add(Label::Obstacle, {2, 250 + place.y() - 1, 3}, {place.x(), (place.y() - 1 - 250) / 2, 1.5});
        add(Label::Obstacle, {2, 250 - place.y() - 1, 3}, {place.x(), (place.y() + 1 + 250) / 2, 1.5});
    }
    const TestMap map = map_of(scene, 1.0, {Vec3(-250, -250, -1), Vec3(250, 250, 4)});
    const Judge judge(map, load_robot("box:0.3,0.3,0.3"));
    for (const double distance : {0.0, 0.3}) {
        const SampleOptions options = sample_options(12, distance);
        const SpawnList list = sample(judge, options);
        CHECK(list.spawns.size() == 12);
        CAPTURE(distance, list.draws);
        CHECK(list.draws < 400000);
        for (const Spawn& spawn : list.spawns) CHECK((spawn.position - place).cwiseAbs().maxCoeff() <= 1.0);
    }
    const SpawnList full = sample(judge, sample_options(1000, 0.5));
    CAPTURE(full.spawns.size(), full.draws, full.undecided_area);
    CHECK(full.is_full);
    CHECK(full.spawns.size() >= 5);
}

TEST_CASE("if no pose is valid, sample proves it")
{
    Scene scene;
    hand::add_shape(scene, Label::Terrain, {ShapeKind::Box, {20, 20, 1}, {{0, 0, -0.5}, Mat3::Identity()}});
    hand::add_shape(scene, Label::Obstacle, {ShapeKind::Box, {21, 21, 1}, {{0, 0, 0.5}, Mat3::Identity()}});
    const TestMap map = map_of(scene);
    const SpawnList list = sample(Judge(map, husky()), sample_options(5, 0));
    CHECK(list.spawns.empty());
    CHECK(list.is_full);
    CHECK(list.draws < 10000);
}

TEST_CASE("two floors above each other are filled equally")
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(12, 12));
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(12, 12), {{0, 0, 2.5}, Mat3::Identity()}));
    const TestMap map = map_of(scene);
    const Judge judge(map, load_robot("box:0.2,0.2,0.2"));
    const SampleOptions options = sample_options(10000, 0.6);
    const SpawnList list = sample(judge, options);
    CHECK(list.is_full);
    const auto upper = double(
        std::count_if(list.spawns.begin(), list.spawns.end(), [](const Spawn& s) { return s.position.z() > 2; }));
    CHECK(upper == Approx(double(list.spawns.size()) / 2).epsilon(0.06));
    CHECK(room_left(judge, options, list, 200) == 0);
}

TEST_CASE("cells that are proven closed contain no valid pose, in hard scenes", "[slow]")
{
    std::size_t closed = 0, open = 0, valid = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const HardCase hard = hard_case(seed);
        const TestMap map = map_at(hard.scene, hard.resolution, hard.map_bounds);
        Random random{seed};
        SampleOptions options = sample_options(1, random.between(0.1, 1));
        options.random_yaw = random.chance(0.5);
        options.yaw = hard.yaws[0];
        options.offset = hard.offset;
        JudgeOptions limits{.max_height = std::max(1.0, hard.offset)};
        if (random.chance(0.2)) limits.max_water_depth = random.between(0, 0.5);
        const Judge judge(map, hard.robot, limits), exhaustive = at_any_height(judge);
        if (random.chance(0.2)) options.layers.kind = LayerChoice::Kind::Top;
        SpacedPoints taken(options.min_distance);
        AvoidedPoints& group = options.avoid.emplace_back();
        group.distance = random.between(0.1, 2);
        for (const RasterPose& pose : raster_of_tops(judge, 1.5).poses)
            if (random.chance(0.1)) group.points.emplace_back(pose.x, pose.y, pose.z);
        const AvoidIndex avoided(options.avoid, map.bounds);
        const AreaIndex everywhere{Area{}};
        CellProofs proofs(judge.impl(), options, everywhere, taken, avoided);
        for (int n = 0; n < 60; ++n) {
            const double side = 2 * std::pow(0.5, random.below(8));
            const Bounds crop = compare::crop_near(map, random, side, 2);
            const Rect cell{crop.min.x(), crop.min.y(), crop.min.x() + side, crop.min.y() + side};
            proofs.set_half_cell(side / 2, side / 2);
            const bool is_closed = proofs.is_closed(cell);
            ++(is_closed ? closed : open);
            for (int k = 0; k < 12; ++k) {
                const double x = random.between(cell.low_x, cell.high_x), y = random.between(cell.low_y, cell.high_y);
                const Spawn spawn = valid_at(exhaustive, options, x, y, random);
                if (!spawn.position.allFinite() || !taken.is_clear(spawn.position)) continue;
                if (!std::all_of(group.points.begin(), group.points.end(),
                                 [&](const Vec3& p) { return (p - spawn.position).norm() >= group.distance; }))
                    continue;
                ++valid;
                CAPTURE(seed, n, x, y, side);
                CHECK_FALSE(is_closed);
                if (k == 11) taken.add(spawn.position);
            }
        }
    }
    CHECK(closed > 500);
    CHECK(open > 500);
    CHECK(valid > 1000);
}

TEST_CASE("counts and distances beyond their limits are refused")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    CHECK_THROWS_WITH(sample(judge, sample_options(0, 1)), "sample: count is 0, needs >= 1");
    CHECK_THROWS_WITH(sample(judge, sample_options(99999999999, 1)),
                      "sample: count is 99999999999, needs at most 100000000");
    CHECK_THROWS_WITH(sample(judge, sample_options(1, -1)), "sample: min_distance is -1, needs >= 0 m");
    SearchOptions options{.max_failures = 0};
    CHECK_THROWS_WITH(search(judge, options), "search: max_failures is 0, needs >= 1");
}

TEST_CASE("few spawns in a map of many tiles are the exhaustive ones, with coarse cells and more exact checks",
          "[slow]")
{
    const TestMap fine = map_of(load_scene(source_folder() + "/maps/training/scene.yaml"), 0.02),
                  coarse = map_of(load_scene(source_folder() + "/maps/training/scene.yaml"), 0.1);
    const Judge judge(fine, husky());
    REQUIRE(judge.impl().is_sparse(256));  // the first batch of draws
    CHECK_FALSE(judge.impl().is_sparse(1000000));
    CHECK_FALSE(Judge(coarse, husky()).impl().is_sparse(256));
    CHECK_FALSE(Judge(fine, load_robot("box:90,90,1")).impl().is_sparse(256));  // meets too many elements
    const SampleOptions options{.count = 100, .random_yaw = true, .seed = 5, .stance = Stance::Level};
    const SpawnList fast = sample(judge, options), slow = sample(without_mask(judge), options),
                    all_cells = sample(Judge(coarse, husky()), options);
    REQUIRE(fast.spawns.size() == 100);
    REQUIRE(slow.spawns.size() == 100);
    for (std::size_t k = 0; k < 100; ++k) {
        CHECK(fast.spawns[k].position == slow.spawns[k].position);
        CHECK(fast.spawns[k].yaw == slow.spawns[k].yaw);
    }
    CHECK(fast.exact_checks > all_cells.exact_checks);
    CHECK(fast.exact_checks < slow.exact_checks);
}

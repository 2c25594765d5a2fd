#include "catch.h"
#include "test_map.h"

#include <spawnfield/poses.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <thread>

using namespace spawnfield;

TEST_CASE("any number of threads may ask one judge at the same time, pose by pose")
{
    const TestMap map = map_of(random_scene(5));
    const Judge judge(map, random_robot(5), {.max_slope = 0.5});
    const std::vector<Pose> poses = random_poses(map.scene, 5, 400);
    const std::vector<Judgement> expected = judge.check(poses, {.threads = 1});
    std::atomic<std::size_t> wrong{0};
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < 4; ++t)
        threads.emplace_back([&, own = judge, t] {  // a copy shares its parts
            for (std::size_t i = 0; i < poses.size(); ++i) {
                const std::size_t p = (i + t * 100) % poses.size();
                const Verdict verdict = own.check(poses[p]).verdict;
                wrong += verdict != expected[p].verdict || own.is_valid(poses[p]) != (verdict == Verdict::Valid);
            }
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(wrong == 0);
}

TEST_CASE("queries with different numbers of threads run at the same time and leave the rest of the process alone")
{
    const TestMap map = map_of(random_scene(6));
    const Judge judge(map, random_robot(6));
    const auto allowed = [] { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); };
    const std::size_t before = allowed();
    std::atomic<std::size_t> changed{0};
    const auto run = [&](int threads) {
        const auto look = [&](double) { changed += allowed() != before; };
        return spawns_csv(sample(
            judge, {.count = 300, .min_distance = 0.1, .stance = Stance::Level, .threads = threads, .progress = look}));
    };
    const std::string expected = run(1);
    std::string one, three;
    std::thread first([&] { one = run(1); }), second([&] { three = run(3); });
    std::atomic<int> host_work{0};
    tbb::parallel_for(0, 1000, [&](int) { ++host_work; });
    first.join();
    second.join();
    CHECK(one == expected);
    CHECK(three == expected);
    CHECK(changed == 0);
    CHECK(host_work == 1000);
}

TEST_CASE("a query with one thread inside the host's own arena does not narrow that arena")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    tbb::task_arena host(3);
    int width = 0;
    host.execute([&] {
        raster(judge, {.step = 1, .threads = 1});
        width = tbb::this_task_arena::max_concurrency();
    });
    CHECK(width == 3);
}

TEST_CASE("a judge says in words why a pose is refused, and names what was hit")
{
    const Judge judge(training_map(), husky());
    const auto reason = [&](double x, double y, double z) {
        const Pose pose{{x, y, z}};
        return judge.describe(pose, judge.check(pose));
    };
    CHECK(reason(0, 3, 0.1) == "valid");
    CHECK(reason(100, 0, 0.1) == "outside the map's bounds");
    CHECK(reason(-6.5, -5, 0.1) == "collision with thin_wall");
    CHECK(reason(7, -7, 0.1) == "submerged");
    CHECK(reason(0, 3, 2.5) == "aerial: 2.55 m above the ground, the limit is 1 m (--max-height)");
    CHECK(reason(0, 3, -9) == "aerial: no ground below the origin; the next ground is 8.95 m above the origin");
    CHECK(name_of(*judge.check({{-6.5, -5, 0.1}}).hit, judge.map()) == "thin_wall");
}

TEST_CASE("the reason of a pose that has sunk through a deck names the distance of the deck above it")
{
    Scene scene;
    add_shape(scene, "floor", Label::Terrain, box_shape({4, 4, 1}, {{0, 0, -0.5}}));
    add_mesh(scene, "deck", Label::Terrain, {{-2, -2, 2}, {2, -2, 2}, {2, 2, 2}, {-2, 2, 2}}, {{0, 1, 2}, {0, 2, 3}},
             Solid::No);
    const Judge judge(map_of(scene), husky());
    const auto reason = [&](double z) {
        const Pose pose{{0.3, 0.2, z}};
        return judge.describe(pose, judge.check(pose));
    };
    CHECK(
        reason(1.95) ==
        "aerial: 1.95 m above the ground, the limit is 1 m (--max-height); the next ground is 0.05 m above the origin");
    CHECK(reason(3.5) == "aerial: 1.5 m above the ground, the limit is 1 m (--max-height)");
}

TEST_CASE("a pose over a crest that is above its origin and below the robot is valid if the robot is free there")
{
    // A body at 0.25 m on two skids. Its origin is between them, at the height of their lowest points.
    const Robot robot = make_robot("skids", {shape_part(box_shape({0.8, 0.8, 0.1}, {{0, 0, 0.3}})),
                                             shape_part(box_shape({0.8, 0.1, 0.25}, {{0, 0.35, 0.125}})),
                                             shape_part(box_shape({0.8, 0.1, 0.25}, {{0, -0.35, 0.125}}))});
    const double crest = GENERATE(0.03, 0.1, 0.2);
    const Label label = GENERATE(Label::Terrain, Label::Obstacle);
    const bool is_wet = GENERATE(false, true);
    CAPTURE(crest, to_string(label), is_wet);
    Scene scene;  // no ground below the crest
    const auto add_block = [&](const Vec3& low, const Vec3& high, Label of_block, const char* name) {
        add_shape(scene, name, of_block, box_shape(high - low, {(low + high) / 2}));
    };
    add_block({-5, -5, -1}, {5, -0.2, 0}, Label::Terrain, "right");
    add_block({-5, 0.2, -1}, {5, 5, 0}, Label::Terrain, "left");
    add_block({-5, -0.2, -1}, {5, 0.2, crest}, label, "crest");
    if (is_wet) add_block({-5, -5, -0.9}, {5, 5, crest}, Label::Water, "water");
    const Judge judge(map_of(scene), robot), exhaustive = without_mask(judge);
    const auto check = [&](double z) {
        const Pose pose{{0, 0, z}};
        const Judgement out = judge.check(pose);
        CHECK(exhaustive.check(pose).verdict == out.verdict);
        CHECK(judge.check(std::span(&pose, 1))[0].verdict == out.verdict);
        CHECK(judge.is_valid(pose) == (out.verdict == Verdict::Valid));
        return out;
    };
    const auto reason = [&](double z) { return judge.describe({{0, 0, z}}, judge.check({{0, 0, z}})); };
    const std::string no_ground = "aerial: no ground below the origin; ";
    const std::string below = no_ground + "with the ground below the robot, ";
    const Judgement over = check(0.02);
    const auto settle = [&](double z) {
        const Pose pose{{0, 0, z}};
        return judge.settle(std::span(&pose, 1))[0];
    };
    if (label == Label::Terrain && !is_wet) {
        CHECK(settle(0.02).verdict == Verdict::Valid);
        CHECK(settle(0.02).position.z() == Approx(0).margin(1e-9));
        CHECK(settle(0.02).ground->height == Approx(crest));
        CHECK(settle(-0.02).verdict == Verdict::Aerial);  // the robot is let down, and not up
        CHECK(over.verdict == Verdict::Valid);
        CHECK(over.ground->height == Approx(crest));
        CHECK(check(-0.02).verdict == Verdict::Aerial);  // the skids are in the ground
        CHECK_THAT(reason(-0.02), Contains(below) && Contains(" m above the origin, it is collision with "));
        CHECK(check(crest + 0.02).verdict == Verdict::Valid);
    } else {
        CHECK(over.verdict == Verdict::Aerial);
        CHECK(settle(0.02).verdict == Verdict::Aerial);
        CHECK_FALSE(over.ground);
        CHECK_THAT(reason(0.02),
                   Contains(below) && Contains(label == Label::Terrain ? "it is submerged"
                                                                       : "it is off_terrain: the ground is crest"));
    }
    CHECK(check(-0.5).verdict == Verdict::Aerial);  // it is buried
    if (label == Label::Terrain) CHECK_THAT(reason(-0.5), Contains(no_ground + "the next ground is "));
}

TEST_CASE("a pose over a crest is valid also if an obstacle or water is below its origin")
{
    // Skids as above, on two rails that join at a sheet between the skids. Below the sheet is what refuses the robot.
    const Robot robot = make_robot("skids", {shape_part(box_shape({0.8, 0.8, 0.1}, {{0, 0, 0.3}})),
                                             shape_part(box_shape({0.8, 0.1, 0.25}, {{0, 0.35, 0.125}})),
                                             shape_part(box_shape({0.8, 0.1, 0.25}, {{0, -0.35, 0.125}}))});
    const bool is_wet = GENERATE(false, true);
    CAPTURE(is_wet);
    Scene scene;
    add_shape(scene, "right", Label::Terrain, box_shape({10, 4.8, 1}, {{0, -2.6, -0.5}}));
    add_shape(scene, "left", Label::Terrain, box_shape({10, 4.8, 1}, {{0, 2.6, -0.5}}));
    add_shape(scene, "crest", Label::Terrain, box_shape({10, 0.4, 0.05}, {{0, 0, 0.125}}));  // 0.1 to 0.15 m
    add_shape(scene, "bed", is_wet ? Label::Terrain : Label::Obstacle, box_shape({10, 0.4, 0.5}, {{0, 0, -0.5}}));
    if (is_wet) add_shape(scene, "water", Label::Water, box_shape({10, 0.4, 0.1}, {{0, 0, -0.2}}));
    const Judge judge(map_of(scene), robot);
    const auto check = [&](double z) { return judge.check({{0, 0, z}}); };
    const Verdict below = is_wet ? Verdict::Submerged : Verdict::OffTerrain;
    CHECK(check(0.02).verdict == Verdict::Valid);
    CHECK(check(0.02).ground->height == Approx(0.15));
    CHECK(check(-0.02).verdict == below);   // the skids are in the rails
    CHECK(check(-0.105).verdict == below);  // no crest below the robot, which would collide
    CHECK(check(-0.02).ground->height == Approx(-0.25));
}

TEST_CASE("counts by verdict add up")
{
    VerdictCounts counts, more;
    ++counts[Verdict::Valid];
    more[Verdict::Outside] = 2;
    more[Verdict::Valid] = 3;
    counts += more;
    CHECK((counts[Verdict::Valid] == 4 && counts[Verdict::Outside] == 2 && counts.total() == 6));
    CHECK(counts != more);
    std::uint64_t sum = 0;
    for (const Verdict verdict : all_verdicts) sum += counts[verdict];
    CHECK(sum == counts.total());
}

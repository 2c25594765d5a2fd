#include "catch.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>

#include <numeric>

using namespace spawnfield;

namespace {

Verdict judged(const Judge& judge, const RasterPose& pose, double yaw)
{
    return judge.check({Vec3(pose.x, pose.y, pose.z), rotation_from_rpy(0, 0, yaw)}).verdict;
}

}  // namespace

TEST_CASE("the thesis's 2D raster of the training arena has 41 x 41 columns and a pose per layer")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    RasterOptions options{.step = 0.5, .bounds = {Vec3(-10, -10, 0), Vec3(10, 10, 0)}, .offset = 0.5};
    const RasterResult result = raster(judge, options);
    CHECK(result.grid.cols == 41);
    CHECK(result.grid.rows == 41);
    std::size_t expected = 0;
    for (int j = 0; j < 41; ++j)
        for (int i = 0; i < 41; ++i) expected += column_at(map.geometry, -10 + 0.5 * i, -10 + 0.5 * j).layers.size();
    CHECK(result.poses.size() == expected);
    CHECK(result.poses.size() >
          1681);  // the floor continues under platform, ramp and flying box, and the underground box has its own top
    const Judge exhaustive = at_any_height(judge);
    for (const RasterPose& pose : result.poses) CHECK(pose.verdict == judged(exhaustive, pose, 0));
}

TEST_CASE("rows are sorted by y, then by x, and each column from the top down")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    for (const int dims : {2, 3}) {
        RasterOptions options{.dims = dims, .step = 0.7};
        const RasterResult result = raster(judge, options);
        CHECK(result.poses.size() > 500);
        for (std::size_t i = 1; i < result.poses.size(); ++i) {
            const RasterPose &a = result.poses[i - 1], &b = result.poses[i];
            const bool later = b.y > a.y || (b.y == a.y && (b.x > a.x || (b.x == a.x && b.z < a.z)));
            CHECK(later);
        }
    }
}

TEST_CASE("a 3D raster has the verdicts that check gives for each single pose")
{
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const TestMap map = map_of(seed == 1 ? training_map().scene : random_scene(seed));
        const Robot robot = random_robot(seed);
        const Judge judge(map, robot, {.max_height = 0.8}), exhaustive = without_mask(judge);
        RasterOptions options{.dims = 3, .step = 1.3, .step_z = 0.35, .yaw = 0.4};
        const RasterResult result = raster(judge, options);
        VerdictCounts counts;
        auto next = result.poses.begin();
        for (int j = 0; j < result.grid.rows; ++j)
            for (int i = 0; i < result.grid.cols; ++i)
                for (int k = result.grid.heights - 1; k >= 0; --k) {
                    const RasterPose pose{result.grid.x_of(i), result.grid.y_of(j), result.grid.z_of(k), 0,
                                          Verdict::Valid};
                    const Verdict verdict = verdict_in_raster(exhaustive,
                                                              {{pose.x, pose.y, pose.z}, rotation_from_rpy(0, 0, 0.4)});
                    ++counts[verdict];
                    if (verdict == Verdict::Aerial) continue;
                    REQUIRE(next != result.poses.end());
                    CHECK(next->z == pose.z);
                    CHECK(next->verdict == verdict);
                    ++next;
                }
        CHECK(next == result.poses.end());
        CHECK(counts == result.counts);
    }
}

TEST_CASE("upper limits of bounds and max_height belong to the raster")
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(2, 2));
    const TestMap map = map_of(scene);
    const Judge judge(map, load_robot("box:0.1,0.1,0.05"), {.max_height = 0.3});
    RasterOptions options{.dims = 3, .step = 0.1, .bounds = {Vec3(0, 0, 0.1), Vec3(0.7, 0.3, 1.2)}};
    const RasterResult result = raster(judge, options);
    CHECK(result.grid.cols == 8);  // 0.7 / 0.1 is 6.999… in floating point
    CHECK(result.grid.rows == 4);
    CHECK(result.grid.heights == 12);
    CHECK(result.counts[Verdict::Valid] == 8 * 4 * 3);  // 0.1, 0.2 and 0.3
    CHECK(result.counts[Verdict::Aerial] == 8 * 4 * 9);
}

TEST_CASE("aerial poses are written in their places on request")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    RasterOptions options{.dims = 3, .step = 2};
    const RasterResult result = raster(judge, options);
    const std::string all = csv_of(result, true), few = csv_of(result, false);
    const auto lines = [](const std::string& text) { return std::size_t(std::count(text.begin(), text.end(), '\n')); };
    CHECK(lines(all) == 1 + std::size_t(result.grid.cols) * result.grid.rows * result.grid.heights);
    CHECK(lines(few) == 1 + result.poses.size());
    CHECK(lines(few) < lines(all));
}

TEST_CASE("without height check every pose is checked only for collisions")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    RasterOptions options{.dims = 3, .step = 1.5, .height_check = false};
    const RasterResult result = raster(judge, options);
    CHECK(result.poses.size() == std::size_t(result.grid.cols) * result.grid.rows * result.grid.heights);
    CHECK(result.exact_checks < result.poses.size());
    for (const RasterPose& pose : result.poses)
        CHECK((pose.verdict == Verdict::Valid) ==
              checker_of(map, husky()).is_free({Vec3(pose.x, pose.y, pose.z), Mat3::Identity()}));
    CHECK(result.counts[Verdict::Valid] > 0);
    CHECK(result.counts[Verdict::Collision] > 0);
}

TEST_CASE("layers restrict a raster to some layers of each column")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const auto poses = [&](LayerChoice choice) {
        RasterOptions options{.step = 0.5, .layers = choice};
        return raster(judge, options).poses;
    };
    const auto all = poses({}), top = poses({LayerChoice::Kind::Top, 0}),
               bottom = poses({LayerChoice::Kind::Bottom, 0});
    const auto first = poses({LayerChoice::Kind::Index, 0}), second = poses({LayerChoice::Kind::Index, 1});
    CHECK(top.size() == bottom.size());
    CHECK(first.size() == top.size());
    CHECK(first.size() + second.size() == all.size());
    CHECK(second.size() > 50);
    for (const RasterPose& pose : top) CHECK(pose.layer == 0);
    for (const RasterPose& pose : second) CHECK(pose.layer == 1);
}

TEST_CASE("columns outside the map are outside")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    RasterOptions options{.dims = 3, .step = 1, .bounds = {Vec3(12, 0, 0), Vec3(13, 1, 2)}};
    const RasterResult result = raster(judge, options);
    CHECK(result.counts[Verdict::Outside] == 2 * 2 * 3);
    CHECK(result.poses.size() == 12);
}

TEST_CASE("a raster is the same bytes with any number of threads")
{
    const TestMap map = map_of(random_scene(4));
    const Judge judge(map, random_robot(4));
    for (const int dims : {2, 3}) {
        const auto text_at = [&](int threads) {
            return csv_of(raster(judge, {.dims = dims, .step = 0.4, .threads = threads}));
        };
        const std::string one = text_at(1);
        CHECK(std::count(one.begin(), one.end(), '\n') > 1000);
        for (const int threads : {2, 8}) CHECK((text_at(threads) == one));  // a failure prints no whole raster
    }
}

TEST_CASE("a raster refuses steps and heights out of their limits")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const auto run = [&](auto change) {
        RasterOptions options;
        change(options);
        return raster(judge, options);
    };
    CHECK_THROWS_WITH(run([](RasterOptions& o) { o.step = 0; }), "raster: step is 0, needs > 0 m");
    CHECK_THROWS_WITH(run([](RasterOptions& o) { o.step = 1e-9; }), Contains("steps along x is 202"));
    CHECK_THROWS_WITH(run([](RasterOptions& o) { o.dims = 4; }), "raster: dims is 4, needs 2 or 3");
    CHECK_THROWS_AS(run([](RasterOptions& o) { o.height_check = false; }), ArgumentError);
}

namespace {

RasterOptions snapped(double step, double step_z, double offset)
{
    return {.dims = 3, .step = step, .step_z = step_z, .offset = offset, .snap = true};
}

/// Adds a level floor of 4 x 4 m at this height.
void add_floor(Scene& scene, double height)
{
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(4, 4), {Vec3(0, 0, height)}));
}

std::vector<double> heights_of(const RasterResult& raster)
{
    std::vector<double> out;
    for_each_pose(raster, true, [&](const RasterPose& pose) { out.push_back(pose.z); });
    return out;
}

}  // namespace

TEST_CASE("a floor between two steps is found with snap, but not without")
{
    Scene scene;
    add_floor(scene, 1.2);  // steps at 0, 2.5 and 5: the next one above is 1.3 m up
    const TestMap map = map_of(scene);
    const Judge judge(map, load_robot("box:0.1,0.1,0.05"));
    RasterOptions options = snapped(1, 2.5, 0.1);
    options.bounds = {Vec3(-1, -1, 0), Vec3(1, 1, 6)};
    const RasterResult found = raster(judge, options);
    CHECK(found.poses.size() == 9);
    for (const RasterPose& pose : found.poses) {
        CHECK(pose.z == 1.2 + 0.1);
        CHECK(pose.layer == 0);
        CHECK(pose.verdict == Verdict::Valid);
        CHECK(pose.snapped);
    }
    CHECK((found.counts[Verdict::Aerial] == 9 * 2 &&
           found.counts[Verdict::Valid] == 9));  // the second of the steps 0, 2.5 and 5 is replaced
    CHECK(found.counts.total() == 9 * 3);
    options.snap = false;
    const RasterResult missed = raster(judge, options);
    CHECK(missed.poses.empty());
    CHECK((missed.counts[Verdict::Aerial] == 9 * 3 && missed.counts.total() == 9 * 3));
}

TEST_CASE("snapped poses replace steps: one step for two layers below it, none beyond the last step or the bounds")
{
    Scene scene;
    for (const double height : {0.4, 1.6, 2.2, 5.5, 7.0, -1.0}) add_floor(scene, height);
    const TestMap map = map_of(scene);
    const Judge judge(map, load_robot("box:0.1,0.1,0.05"));
    RasterOptions options = snapped(1, 2.5, 0.25);
    options.bounds = {Vec3(0, 0, 0), Vec3(0, 0, 6)};
    // Three poses replace the step 2.5, and 5.75 is above the last step.
    const auto heights = [&] { return heights_of(raster(judge, options)); };
    // Three poses replace the step 2.5, and 5.75 is above the last step.
    CHECK(heights() == std::vector<double>{5.75, 5.0, 2.45, 1.85, 0.65, 0.0});
    options.layers = {LayerChoice::Kind::Index, 2};
    CHECK(raster(judge, options).poses.size() == 1);  // 2.45; the steps near it were replaced
    options.layers = {LayerChoice::Kind::Bottom, 0};
    const RasterResult bottom = raster(judge, options);
    REQUIRE(bottom.poses.size() == 1);  // the layer is below the bounds, and the step 0 is 1 m above it
    CHECK_FALSE(bottom.poses[0].snapped);
    options.layers = {};
    options.step_z = 0.2;
    options.bounds.max.z() = 0.8;
    CHECK(heights() == std::vector<double>{0.8, 0.65, 0.2 * 3, 0.2, 0});  // 0.65 replaces 0.4, above the next step
    options.offset = 0.4;                                                 // at a step, so there is one pose
    CHECK(heights() == std::vector<double>{0.8, 0.2 * 3, 0.2, 0});
}

TEST_CASE("a floor that differs from a step only by rounding replaces that step")
{
    RasterGrid grid;
    grid.step_z = 0.1;
    grid.heights = 8;
    CHECK(grid.step_above(0.3) == 3);  // 3 * 0.1 is greater than 0.3
    CHECK(grid.step_above(0.7) == 7);  // 7 * 0.1 is greater than 0.7, and 0.7 / 0.1 is less than 7
    CHECK(grid.step_above(0.7 + 5e-10) == 7);
    CHECK(grid.step_above(0.7 + 5e-9) == 8);
    CHECK(grid.step_above(0.31) == 4);
    CHECK(grid.step_above(-5) == 0);
    CHECK(grid.step_above(9) == 8);
}

TEST_CASE("the poses of the 2D raster are among those of the 3D raster with snap, in all maps")
{
    std::size_t valid = 0, other = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const TestMap map = seed == 1 ? training_map() : map_of(random_scene(seed));
        const Judge judge(map, random_robot(seed));
        RasterOptions options = snapped(0.9, 2.1, 0.3 + 0.02 * double(seed % 9));
        options.yaw = 0.2;
        options.bounds = {map.bounds.min - Vec3(1, 0, 0), map.bounds.max};
        options.bounds.min.z() = map.bounds.min.z() + 0.2;
        const RasterResult all = raster(judge, options);
        std::vector<RasterPose> on_layers;
        std::copy_if(all.poses.begin(), all.poses.end(), std::back_inserter(on_layers),
                     [](const RasterPose& pose) { return pose.snapped; });
        options.dims = 2;
        options.snap = false;
        auto next = on_layers.begin();
        for (const RasterPose& pose : raster(judge, options).poses) {
            const double layer = column_at(map.geometry, pose.x, pose.y).layers[std::size_t(pose.layer)];
            if (layer < options.bounds.min.z() - 1e-9 || layer > options.bounds.max.z() + 1e-9) continue;
            REQUIRE(next != on_layers.end());
            CHECK((next->x == pose.x && next->y == pose.y && next->z == pose.z && next->layer == pose.layer &&
                   next->verdict == pose.verdict));
            ++(pose.verdict == Verdict::Valid ? valid : other);
            ++next;
        }
        CHECK(next == on_layers.end());
        std::uint64_t visited = 0;
        for_each_pose(all, true, [&](const RasterPose&) { ++visited; });
        CHECK(visited == all.counts.total());
    }
    CHECK((valid > 500 && other > 500));
}

TEST_CASE("with snap no place is checked twice, and each column is sorted downwards, also if offsets meet steps")
{
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        const Judge judge(map, husky());
        for (const auto& [step_z, offset] : {std::pair{0.5, 0.5}, {0.2, 1.0}, {0.1, 0.1}, {0.5, 0.0}}) {
            RasterOptions options = snapped(1.3, step_z, offset);
            options.bounds = {{-9, -9, -2}, {9, 9, 6}};  // level floors at whole steps
            const RasterResult result = raster(judge, options);
            std::uint64_t visited = 0, out_of_order = 0;
            std::optional<RasterPose> last;
            for_each_pose(result, true, [&](const RasterPose& pose) {
                ++visited;
                out_of_order += last && last->x == pose.x && last->y == pose.y && !(pose.z < last->z - 1e-9);
                last = pose;
            });
            INFO("scene " << seed << ", step " << step_z << ", offset " << offset);
            CHECK(out_of_order == 0);
            CHECK(visited == result.counts.total());
        }
    }
}

TEST_CASE("snap refuses 2D, no height check, and offsets that would be aerial")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    RasterOptions options = snapped(1, 1, 1.5);
    CHECK_THROWS_WITH(raster(judge, options),
                      "raster: offset is 1.5, needs 0 .. max_height with snap: poses on their layers would be aerial");
    options.offset = -0.1;
    CHECK_THROWS_AS(raster(judge, options), ArgumentError);
    options.offset = 0.1;
    options.height_check = false;
    CHECK_THROWS_WITH(raster(judge, options), "raster: snap needs the height check, because only it finds the layers");
    options.height_check = true;
    options.dims = 2;
    CHECK_THROWS_AS(raster(judge, options), ArgumentError);
}

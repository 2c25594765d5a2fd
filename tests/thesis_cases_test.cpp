#include "catch.h"
#include "test_map.h"
#include "worlds/bridge.h"
#include "worlds/hand_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace spawnfield;

// Cases in which the answers of the thesis (Ropelato) were wrong, with the right answers.

namespace {

void add_box(Scene& scene, const Vec3& low, const Vec3& high, Label label)
{
    hand::add_shape(scene, label, {ShapeKind::Box, high - low, {(low + high) / 2, Mat3::Identity()}});
}

/// Returns level ground at z = 0, 20 x 20 m around the origin.
Scene open_ground()
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(20, 20), {.kind = "plane"});
    return scene;
}

/// Returns the raster with the mask, after a check that --exhaustive gives the same.
RasterResult raster_of(const Scene& scene, const RasterOptions& options, const JudgeOptions& limits = {})
{
    const Judge judge(map_of(scene), husky(), limits);
    const RasterResult result = raster(judge, options);
    CHECK(raster(without_mask(judge), options).counts == result.counts);
    return result;
}

/// Returns the verdict at a position of the raster; nothing if the raster has no pose there.
std::optional<Verdict> verdict_at(const RasterResult& result, const Vec3& position)
{
    for (const RasterPose& pose : result.poses)
        if ((Vec3(pose.x, pose.y, pose.z) - position).norm() < 1e-9) return pose.verdict;
    return std::nullopt;
}

std::optional<Verdict> verdict_in_2d(const Scene& scene, double x, double y, double z,
                                     double max_slope = std::numeric_limits<double>::infinity())
{
    const RasterOptions options{.bounds = {{x, y, -100}, {x, y, 100}}, .offset = 0.1};
    return verdict_at(raster_of(scene, options, {.max_slope = max_slope}), {x, y, z});
}

}  // namespace

TEST_CASE("above a fence no step of a 3D raster is valid")
{
    Scene scene = open_ground();
    add_box(scene, {-5, -0.02, 0}, {5, 0.02, 1}, Label::Obstacle);
    RasterOptions options{.dims = 3, .step = 0.25, .bounds = {{-2, 0, 0}, {2, 0, 3}}};
    const RasterResult on_line = raster_of(scene, options);  // directly above the fence, whose top is the ground
    CHECK(on_line.counts[Verdict::Valid] == 0);
    CHECK(verdict_at(on_line, {0, 0, 0.5}) == Verdict::Collision);
    CHECK(verdict_at(on_line, {0, 0, 1.25}) == Verdict::OffTerrain);
    options.bounds = {{-2, 0.25, 0}, {2, 0.25, 0.75}};  // beside the fence, which the robot overlaps
    CHECK(raster_of(scene, options).counts[Verdict::Valid] == 0);
    options.bounds = {{-2, 0.5, 0}, {2, 0.5, 0.75}};
    CHECK(raster_of(scene, options).counts[Verdict::Valid] == 17 * 3);  // far enough from the fence
}

TEST_CASE("the path of a bridge is found under its frame, although the bridge is a single object")
{
    Scene scene = open_ground();
    hand::Mesh deck = hand::box({12, 3, 0.4});
    for (Vec3& v : deck.vertices) v.z() += 3;
    hand::add_mesh(scene, Label::Terrain, deck);
    for (const double side : {-1.4, 1.4}) {
        hand::Mesh post = hand::box({0.3, 0.2, 2.2});
        for (Vec3& v : post.vertices) v += Vec3(0, side, 4.2);
        hand::add_piece(scene, post);
    }
    hand::Mesh beam = hand::box({0.3, 3, 0.3});
    for (Vec3& v : beam.vertices) v.z() += 5.4;
    hand::add_piece(scene, beam);
    CHECK(verdict_in_2d(scene, 0, 0, 5.65) ==
          Verdict::Valid);  // on the beam, which is terrain, and nothing is in the way
    CHECK(verdict_in_2d(scene, 0, 0, 3.3) == Verdict::Valid);  // the path below
    CHECK(verdict_in_2d(scene, 0, 0, 0.1) == Verdict::Valid);  // the ground under the bridge

    const double limit = std::numbers::pi / 9;  // 20 degrees; now the footing of the robot is examined
    CHECK(verdict_in_2d(scene, 0, 0, 5.65, limit) == Verdict::Unstable);
    CHECK(verdict_in_2d(scene, 0, 1.4, 5.65, limit) == Verdict::Unstable);
    CHECK(verdict_in_2d(scene, 0, 0, 3.3, limit) == Verdict::Valid);
    CHECK(verdict_in_2d(scene, 0, 0, 0.1, limit) == Verdict::Valid);
}

TEST_CASE("on the generated bridge frames and pillars are refused because of their footing, and the path is valid")
{
    const worlds::World world = worlds::complex_district();
    const auto bridge = std::find_if(world.landmarks.begin(), world.landmarks.end(),
                                     [](const auto& landmark) { return landmark.name == "bridge"; });
    REQUIRE(bridge != world.landmarks.end());
    const TestMap map = map_of(world.scene, 0.25, bridge->where);
    const RasterOptions options{.step = 0.25, .bounds = bridge->where, .offset = 0.05};
    const auto valid_ones = [&](double max_slope) {  // counts valid poses under the beams of the frames and on them
        const RasterResult result = raster(Judge(map, husky(), {.max_slope = max_slope}), options);
        std::size_t paths = 0, tops = 0;
        for (std::size_t i = 0; i + 1 < result.poses.size(); ++i) {
            const RasterPose &upper = result.poses[i], &lower = result.poses[i + 1];
            if (upper.x != lower.x || upper.y != lower.y || std::abs(upper.z - lower.z - worlds::frame_top) > 1e-3)
                continue;
            paths += lower.verdict == Verdict::Valid;
            tops += upper.verdict == Verdict::Valid;
        }
        return std::pair{paths, tops};
    };
    const auto [paths, tops] = valid_ones(std::numeric_limits<double>::infinity());
    CHECK(paths > 20);
    CHECK(tops > 20);  // without footings, the top of a frame is valid
    const auto [paths_with_footing, tops_with_footing] = valid_ones(std::numbers::pi / 9);
    CHECK(paths_with_footing == paths);
    CHECK(tops_with_footing == 0);
}

TEST_CASE("terrain between two steps of a 3D raster is found if steps snap onto it")
{
    Scene scene;
    add_box(scene, {-10, -10, 0}, {10, 10, 1.3},
            Label::Terrain);  // 1.2 m below the next step, 1.3 m above the previous one
    RasterOptions options{.dims = 3, .step = 2.5, .bounds = {{-5, -5, 0}, {5, 5, 10}}};
    CHECK(raster_of(scene, options).counts[Verdict::Valid] == 0);
    options.snap = true;
    CHECK(raster_of(scene, options).counts[Verdict::Valid] == 25);
}

TEST_CASE("a wheel that cuts into a steep slope collides")
{
    Scene scene;
    const double rise = std::tan(30 * std::numbers::pi / 180);
    hand::add_mesh(scene, Label::Terrain,
                   hand::relief(20, 20, [&](double x, double) { return rise * std::max(0.0, x); }),
                   {.kind = "heightmap"});
    CHECK(verdict_in_2d(scene, -1, 0, 0.1) == Verdict::Valid);
    CHECK(verdict_in_2d(scene, -0.6, 0, 0.1) == Verdict::Valid);   // the front is 0.495 m ahead, just before the slope
    CHECK(verdict_in_2d(scene, 0, 0, 0.1) == Verdict::Collision);  // the front is 0.29 m deep in the slope
    CHECK(verdict_in_2d(scene, 3, 0, 3 * rise + 0.1) == Verdict::Collision);
    // The front is 0.145 m beyond the foot of the slope, which is 0.08 m high there.
    CHECK(verdict_in_2d(scene, -0.35, 0, 0.1) == Verdict::Valid);
}

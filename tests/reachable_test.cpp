#include "catch.h"
#include "figure_text.h"
#include "rest_robots.h"
#include "temp_folder.h"
#include "test_map.h"

#include <spawnfield/error.h>
#include <spawnfield/headings.h>
#include <spawnfield/heatmap.h>
#include <spawnfield/map_export.h>

#include <algorithm>
#include <atomic>

using namespace spawnfield;
using rest_robots::add_block;
using rest_robots::boxy;

// Tests of queries with a filter on settled poses: the verdict `unreachable`.

namespace {

/// A floor with a block that the robot cannot stand beside everywhere, and a ramp.
TestMap furnished()
{
    Scene scene = rest_robots::slope(rest_robots::rad(10));
    add_block(scene, {2, -1, -1}, {3, 1, 2});
    add_shape(scene, "pillar", Label::Obstacle, box_shape({0.5, 0.5, 4}, {{-2, 2, 0}}));
    return map_of(std::move(scene));
}

bool is_east(const SettledPose& pose) { return pose.position.x() > 0; }

bool is_nowhere(const SettledPose&) { return false; }

/// Accepts one heading only.
bool looks_east(const SettledPose& pose) { return is_east(pose) && std::abs(pose.yaw) < 1e-9; }

Judge judge_of(const Map& map) { return {map, boxy({0.6, 0.4, 0.3})}; }

RasterOptions half_metres(ReachFilter is_reachable)
{
    return {.step = 0.5, .stance = Stance::Settled, .is_reachable = std::move(is_reachable)};
}

}  // namespace

TEST_CASE("the poses of a raster that its filter refuses are unreachable, and all others are as before")
{
    const TestMap map = furnished();
    const Judge judge = judge_of(map);
    const RasterResult all = raster(judge, half_metres({})), east = raster(judge, half_metres(is_east));
    REQUIRE(all.poses.size() == east.poses.size());
    std::uint64_t refused = 0, other = 0;
    for (std::size_t p = 0; p < all.poses.size(); ++p) {
        const RasterPose &before = all.poses[p], &after = east.poses[p];
        CHECK((before.x == after.x && before.y == after.y && before.z == after.z));
        CHECK(all.rests[p].has_pose() == east.rests[p].has_pose());
        if (all.rests[p].has_pose()) CHECK(all.rests[p].margin == east.rests[p].margin);
        const bool is_refused = before.verdict == Verdict::Valid && before.x <= 0;
        CHECK(after.verdict == (is_refused ? Verdict::Unreachable : before.verdict));
        refused += is_refused;
        other += before.verdict != Verdict::Valid && before.x <= 0;
    }
    CHECK((refused > 100 && other > 20));
    CHECK(east.counts[Verdict::Unreachable] == refused);
    CHECK(east.counts[Verdict::Valid] + refused == all.counts[Verdict::Valid]);
}

TEST_CASE("a filter is asked only about valid poses, as the Judge settles them")
{
    const TestMap map = furnished();
    const Judge judge = judge_of(map);
    std::atomic<std::uint64_t> asked{0}, wrong{0};
    const ReachFilter watch = [&](const SettledPose& pose) {
        const SettledPose expected = judge.settle(pose.position, pose.yaw);
        ++asked;
        wrong += pose.verdict != Verdict::Valid || expected.position != pose.position || expected.roll != pose.roll;
        return true;
    };
    const RasterResult result = raster(judge, half_metres(watch));
    CHECK(asked == result.counts[Verdict::Valid]);
    CHECK(wrong == 0);
    CHECK(result.counts[Verdict::Unreachable] == 0);
}

TEST_CASE("samples lie where their filter accepts them, and are the same bytes at any number of threads")
{
    const TestMap map = furnished();
    const Judge judge = judge_of(map);
    const auto sampled = [&](int threads, ReachFilter is_reachable) {
        return sample(judge, {.count = 200,
                              .min_distance = 0.1,
                              .random_yaw = true,
                              .seed = 3,
                              .is_reachable = std::move(is_reachable),
                              .threads = threads});
    };
    const SpawnList one = sampled(1, is_east);
    REQUIRE(one.spawns.size() == 200);
    for (const Spawn& spawn : one.spawns) CHECK(spawn.position.x() > 0);
    CHECK(one.counts[Verdict::Unreachable] > 100);
    for (const int threads : {2, 8}) {
        const SpawnList more = sampled(threads, is_east);
        CHECK(spawns_csv(more, {}) == spawns_csv(one, {}));
        CHECK(more.counts == one.counts);
    }
    const ReachFilter accepts_all = [](const SettledPose&) { return true; };
    CHECK(spawns_csv(sampled(2, accepts_all), {}) == spawns_csv(sampled(2, {}), {}));
}

TEST_CASE("a filter that refuses everything leaves no spawn, and every valid pose becomes unreachable")
{
    const TestMap map = furnished();
    const Judge judge = judge_of(map);
    const SpawnList none = sample(judge, {.count = 3, .is_reachable = is_nowhere});
    CHECK(none.spawns.empty());
    CHECK(!none.is_full);  // there is no proof for settled poses
    CHECK(none.counts[Verdict::Valid] == 0);
    CHECK(none.counts[Verdict::Unreachable] > 1000);
    CHECK(raster(judge, half_metres(is_nowhere)).counts[Verdict::Valid] == 0);
}

TEST_CASE("a heading that the filter refuses is not valid")
{
    using Kind = HeadingRule::Kind;
    const TestMap map = furnished();
    const Judge judge = judge_of(map);
    for (const Kind kind : {Kind::Any, Kind::All, Kind::Best, Kind::Clearest, Kind::Along}) {
        CAPTURE(int(kind));
        RasterOptions options = half_metres(looks_east);
        options.heading = HeadingRule{.kind = kind, .count = 4};
        const RasterResult result = raster(judge, options);
        options.is_reachable = {};
        const RasterResult before = raster(judge, options);
        for (std::size_t p = 0; p < result.poses.size(); ++p) {
            const bool at_zero = (before.rests[p].valid_headings & 1) != 0 && before.poses[p].x > 0;
            CHECK(result.rests[p].valid_headings == (at_zero ? 1 : 0));
            const Verdict verdict = result.poses[p].verdict;
            if (kind == Kind::All)
                CHECK(verdict != Verdict::Valid);
            else
                CHECK((verdict == Verdict::Valid) == at_zero);
            if (verdict == Verdict::Valid) CHECK(result.rests[p].yaw == 0);
        }
        CHECK(result.counts[Verdict::Unreachable] > 100);
    }
    const HeadingRaster counted = raster_at_headings(judge, half_metres(looks_east), 8);
    for (const std::uint8_t headings : counted.valid_headings) CHECK(headings <= 1);
    CHECK(counted.raster.counts[Verdict::Valid] > 100);
}

TEST_CASE("a filter for level robots is refused")
{
    const TestMap map = furnished();
    const Judge judge = judge_of(map);
    const std::string why =
        "is_reachable is given, but stance is Level: only settled robots have islands; give stance "
        "Settled, or no filter";
    CHECK_THROWS_WITH(sample(judge, {.stance = Stance::Level, .is_reachable = is_east}), "sample: " + why);
    CHECK_THROWS_WITH(raster(judge, {.is_reachable = is_east}), "raster: " + why);
}

TEST_CASE("pictures and files of other programs have a number and a colour for unreachable poses")
{
    CHECK(int(Verdict::Unreachable) == 9);
    const TestMap map = furnished();
    const Judge judge = judge_of(map);
    RasterOptions options = half_metres(is_east);
    const RasterResult result = raster(judge, options);
    const TempFolder folder;

    std::string ply;
    write_ply(result, {}, [&](std::string_view piece) { ply += piece; });
    CHECK_THAT(ply, Contains("9 unreachable\n") && Contains(std::string("\x37\x1d\x4a\x09", 4)));

    const GridFrame frame = frame_around(map.bounds, 0.5);
    write_heatmap(map, rasterize_terrain(map.geometry, frame), result, {}, folder / "verdict.svg");
    const auto texts = svg_texts(bytes_of(folder / "verdict.svg"));
    const auto name = std::find(texts.begin(), texts.end(), "unreachable");
    REQUIRE(name != texts.end());
    CHECK_THAT(*(name + 1), Contains(std::to_string(result.counts[Verdict::Unreachable]) + "   "));

    options.layers.kind = LayerChoice::Kind::Top;
    const VerdictImage image = verdict_image(judge, frame, options);
    CHECK(std::count(image.verdicts.begin(), image.verdicts.end(), 9) == std::ptrdiff_t(image.counts[Verdict(9)]));
    write_nav2_map(image, folder / "map.yaml");
    const std::string file = bytes_of(folder / "map.pgm"), pixels = file.substr(file.size() - image.verdicts.size());
    for (std::size_t k = 0; k < image.verdicts.size(); ++k)
        if (image.verdicts[k] == 9) CHECK(pixels[k] == 0);  // occupied
}

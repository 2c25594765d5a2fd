#include "arena.h"
#include "hard_scene.h"
#include "test_map.h"

#include <spawnfield/error.h>
#include <spawnfield/headings.h>

#include <numbers>

using namespace spawnfield;

namespace {

RasterOptions half_metres() { return {.step = 0.5}; }

}  // namespace

TEST_CASE("a raster at 16 headings counts valid headings; if none is valid, the most frequent verdict counts")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    const HeadingRaster result = raster_at_headings(judge, half_metres());
    const std::size_t count = result.raster.poses.size();
    REQUIRE(result.headings == 16);
    REQUIRE(result.valid_headings.size() == count);

    std::vector<std::array<int, verdict_count>> tallies(count);
    for (int k = 0; k < 16; ++k) {
        RasterOptions options = half_metres();
        options.yaw = 2 * std::numbers::pi * k / 16;
        const RasterResult one = raster(judge, options);
        REQUIRE(one.poses.size() == count);
        for (std::size_t p = 0; p < count; ++p) ++tallies[p][std::size_t(one.poses[p].verdict)];
    }
    std::size_t wrong = 0, some = 0;
    VerdictCounts counts;
    for (std::size_t p = 0; p < count; ++p) {
        const auto& tally = tallies[p];
        const int fitting = tally[std::size_t(Verdict::Valid)],
                  seen = tally[std::size_t(result.raster.poses[p].verdict)];
        const int most = *std::max_element(tally.begin(), tally.end());
        wrong += result.valid_headings[p] != fitting;
        wrong += fitting > 0 ? result.raster.poses[p].verdict != Verdict::Valid : seen != most;
        some += fitting > 0 && fitting < 16;
        ++counts[result.raster.poses[p].verdict];
    }
    CHECK(wrong == 0);
    CHECK(some > 20);
    CHECK(counts == result.raster.counts);
}

TEST_CASE("a raster at headings is the rasters at each yaw, with every kind of judge")
{
    for (std::uint64_t seed = 0; seed < 12; ++seed)
        for (const bool steep : {false, true}) {
            const HardCase hard = hard_case(seed);
            CAPTURE(seed, steep);
            const TestMap map = map_of(hard.scene, hard.resolution, hard.map_bounds);
            JudgeOptions judging{.max_height = hard.max_height, .exhaustive = seed % 4 == 3};
            if (steep) judging.max_slope = 0.3;
            const Judge judge(map, hard.robot, judging);
            const double width = (map.bounds.max - map.bounds.min).head<2>().maxCoeff();
            RasterOptions options{.step = width / 23.3, .offset = hard.offset};
            const HeadingRaster all = raster_at_headings(judge, options, 5);
            std::vector<int> valid(all.raster.poses.size());
            std::uint64_t exact_checks = 0;
            for (int k = 0; k < 5; ++k) {
                options.yaw = 2 * std::numbers::pi * k / 5;
                const RasterResult one = raster(judge, options);
                REQUIRE(one.poses.size() == valid.size());
                exact_checks += one.exact_checks;
                for (std::size_t p = 0; p < valid.size(); ++p) valid[p] += one.poses[p].verdict == Verdict::Valid;
            }
            CHECK(std::equal(valid.begin(), valid.end(), all.valid_headings.begin(), all.valid_headings.end()));
            CHECK(all.raster.exact_checks == exact_checks);
        }
}

TEST_CASE("a raster at headings refuses counts out of range and 3D rasters")
{
    const TestMap map = training_map();
    const Judge judge(map, husky());
    CHECK_THROWS_WITH(raster_at_headings(judge, half_metres(), 0), "raster_at_headings: headings is 0, needs 1 .. 255");
    CHECK_THROWS_AS(raster_at_headings(judge, half_metres(), 256), ArgumentError);
    RasterOptions options = half_metres();
    options.dims = 3;
    CHECK_THROWS_WITH(raster_at_headings(judge, options), "raster_at_headings: dims is 3, needs 2");
}

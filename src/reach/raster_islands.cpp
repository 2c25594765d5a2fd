#include "base/parallel.h"
#include "query/stand_judge.h"

#include <spawnfield/error.h>
#include <spawnfield/raster_islands.h>

#include <algorithm>

namespace spawnfield {

std::vector<std::int32_t> islands_of(const ReachGraph& graph, const Judge& judge, const RasterResult& raster,
                                     const RunOptions& options)
{
    if (raster.rests.size() != raster.poses.size())
        throw ArgumentError("islands_of", "size of raster.rests", double(raster.rests.size()),
                            "as many as its poses: a raster of settled poses at one yaw");
    constexpr std::size_t chunk = 256;  // neighbours share work
    std::vector<std::int32_t> out(raster.poses.size(), no_island);
    PerThread<StandJudge> stand_judges{[&] { return StandJudge(judge.impl()); }};
    parallel_for((out.size() + chunk - 1) / chunk, options.threads, options.progress, [&](std::size_t c) {
        for (std::size_t p = c * chunk; p < std::min(out.size(), (c + 1) * chunk); ++p) {
            const RasterPose& pose = raster.poses[p];
            if (pose.verdict != Verdict::Valid) continue;
            const RasterRest& rest = raster.rests[p];
            const auto island = graph.island_of(
                stand_judges.local().judge({pose.x, pose.y, rest.layer_height}, rest.yaw));
            if (island) out[p] = std::int32_t(*island);
        }
    });
    return out;
}

}  // namespace spawnfield

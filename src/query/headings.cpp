#include "query/headings_judge.h"

#include <spawnfield/error.h>

namespace spawnfield {

HeadingRaster raster_at_headings(const Judge& judge, const RasterOptions& options, int headings)
{
    if (headings < 1 || headings > 255) throw ArgumentError("raster_at_headings", "headings", headings, "1 .. 255");
    if (options.dims != 2) throw ArgumentError("raster_at_headings", "dims", options.dims, "2");
    HeadingRaster out;
    out.headings = headings;
    RasterOptions upright = options;
    upright.yaw = 0;
    std::vector<VerdictTally> tallies;
    out.raster = raster_with(judge, upright, headings, &tallies);
    out.valid_headings.reserve(tallies.size());
    for (const VerdictTally& tally : tallies) out.valid_headings.push_back(tally[std::size_t(Verdict::Valid)]);
    return out;
}

}  // namespace spawnfield

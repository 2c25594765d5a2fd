#include <spawnfield/error.h>
#include <spawnfield/headings.h>

#include <algorithm>
#include <numbers>

namespace spawnfield {
namespace {

using VerdictTally = std::array<std::uint8_t, verdict_count>;

/// Returns Valid if the pose was valid at some heading. Otherwise returns the most frequent verdict; if there are
/// several, the first of them in the enumeration.
Verdict merged(const VerdictTally& tally)
{
    if (tally[std::size_t(Verdict::Valid)] > 0) return Verdict::Valid;
    return Verdict(std::max_element(tally.begin(), tally.end()) - tally.begin());
}

Progress part_of(const Progress& progress, int part, int parts)
{
    if (!progress) return {};
    return [=](double share) { progress((part + share) / parts); };
}

}  // namespace

HeadingRaster raster_at_headings(const Judge& judge, const RasterOptions& options, int headings)
{
    if (headings < 1 || headings > 255) throw ArgumentError("raster_at_headings", "headings", headings, "1 .. 255");
    if (options.dims != 2) throw ArgumentError("raster_at_headings", "dims", options.dims, "2");
    HeadingRaster out;
    out.headings = headings;
    std::vector<VerdictTally> tallies;
    std::uint64_t exact_checks = 0;
    for (int k = headings - 1; k >= 0; --k) {  // yaw 0 comes last, so out.raster keeps its yaw
        RasterOptions turned = options;
        turned.yaw = 2 * std::numbers::pi * k / headings;
        turned.progress = part_of(options.progress, headings - 1 - k, headings);
        out.raster = raster(judge, turned);
        exact_checks += out.raster.exact_checks;
        tallies.resize(out.raster.poses.size());
        for (std::size_t p = 0; p < tallies.size(); ++p) ++tallies[p][std::size_t(out.raster.poses[p].verdict)];
    }
    out.raster.exact_checks = exact_checks;
    out.raster.counts = {};
    for (std::size_t p = 0; p < tallies.size(); ++p) {
        out.raster.poses[p].verdict = merged(tallies[p]);
        ++out.raster.counts[out.raster.poses[p].verdict];
        out.valid_headings.push_back(tallies[p][std::size_t(Verdict::Valid)]);
    }
    return out;
}

}  // namespace spawnfield

#pragma once

#include "query/pose_judge.h"

#include <spawnfield/headings.h>

#include <deque>
#include <vector>

namespace spawnfield {

/// For each verdict, at how many headings a pose has it.
using VerdictTally = std::array<std::uint8_t, verdict_count>;

/// Returns Valid if the pose was valid at some heading. Otherwise returns the most frequent verdict; if there are
/// several, the first of them in the enumeration.
Verdict merged(const VerdictTally& tally);

/// Judges poses at several headings, the yaws heading_of(k, headings). The column and the ground of a pose are the same
/// for all of them, and most poses are free at every yaw.
class HeadingsJudge {
public:
    HeadingsJudge(const Judge::Impl& shared, int headings, double max_height);

    /// Judges a pose at all headings. `column` must be the column at its x and y. Adds the number of exact checks to
    /// `exact_checks`.
    VerdictTally judge(const ColumnView& column, const Vec3& position, std::uint64_t& exact_checks);
    /// Says that many of the next poses are in this rectangle: their exact checks share the search for tiles.
    void expect(const Rect& places) { at_heading_.front().expect(places); }

private:
    std::deque<PoseJudge> at_heading_;  // a deque never moves its elements
    std::optional<Mask> every_yaw_;     ///< empty: every pose is checked exactly
    bool has_footing_;
};

/// Does the same as raster(), but with `tallies`, judges each pose of a 2D raster at `headings` yaws, and writes a
/// tally for each of result.poses. Their verdicts are merged. options.yaw is then not used.
RasterResult raster_with(const Judge& judge, const RasterOptions& options, int headings,
                         std::vector<VerdictTally>* tallies);

}  // namespace spawnfield

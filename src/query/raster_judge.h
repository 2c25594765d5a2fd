#pragma once

#include "query/area_index.h"
#include "query/headings_judge.h"
#include "query/stand_judge.h"

#include <spawnfield/query.h>

#include <algorithm>
#include <array>
#include <limits>

namespace spawnfield {

/// Numbers of steps of a raster's heights, without duplicates.
using Steps = std::vector<int>;

bool has_step(const Steps& steps, int k);

/// Returns the steps that a column's snapped poses replace, and the steps at the same heights as these poses.
Steps replaced_steps(const RasterGrid& grid, double offset, std::span<const RasterPose> column);

/// The listed poses of one row of columns, and the counts of those that are not listed.
struct RasterRow {
    std::vector<RasterPose> poses;
    std::vector<VerdictTally> tallies;  ///< of the poses, if they are judged at several headings
    std::vector<RasterRest> rests;      ///< of the poses, if they are settled at one yaw
    std::uint64_t aerial = 0, exact_checks = 0;

    void clear()  // keeps the memory
    {
        poses.clear();
        tallies.clear();
        rests.clear();
        aerial = exact_checks = 0;
    }
};

/// Judges strips of rows. In a strip, it goes from block to block, so that neighbouring columns share work.
class RasterJudge {
public:
    static constexpr int most_rows = 32, most_columns = 128;  ///< of a strip and a block

    /// Returns the number of rows and columns of a block of settled poses. The robots of a block share the search for
    /// the solids below them, if their columns are near enough to each other. 1: they are not.
    static int settled_block(const Settler& settler, double step)
    {
        constexpr double size = 8;  // of a block's side, times the robot's reach
        constexpr int most = 8;
        return std::clamp(int(size * settler.reach() / step), 1, most);
    }

    RasterJudge(const Judge::Impl& shared, const RasterOptions& options, const RasterGrid& grid, double offset,
                double top, int headings);

    /// Judges as many rows as `out` has entries, beginning with row `first`.
    void judge_rows(int first, std::span<RasterRow> out) const;

private:
    /// What a thread keeps from strip to strip: mostly memory.
    struct Worker {
        // Only one of these three has a value:
        std::optional<PoseJudge> judge;                            ///< of level poses at options.yaw
        std::optional<HeadingsJudge> at_headings;                  ///< of level poses at several yaws
        std::optional<StandJudge> stand;                           ///< of settled poses
        Columns columns;                                           ///< of the current block
        std::array<double, most_columns> x;                        ///< of the block's columns
        std::array<Columns::OpenGround, most_columns> ground;      ///< in one row of the block
        std::vector<PoseJudge::LayeredColumn> layered;             ///< in the same row
        std::array<PoseJudge::RowVerdict, most_columns> verdicts;  ///< in the same row

        explicit Worker(const RasterJudge& raster)
        {
            if (raster.is_settled_)
                stand.emplace(raster.shared_, raster.options_.is_reachable);
            else if (raster.headings_ > 0)
                at_headings.emplace(raster.shared_, raster.headings_, raster.max_height());
            else
                judge.emplace(raster.shared_, raster.options_.yaw, raster.max_height());
            if (judge && raster.options_.dims == 2) judge->leave_layered_cells();
        }
    };

    /// A pose of a 2D raster is `offset` above its layer by definition.
    double max_height() const
    {
        return options_.dims == 2 ? std::numeric_limits<double>::infinity() : shared_.options.max_height;
    }

    /// Judges row j of a block.
    void judge_row(Worker& worker, std::span<const double> x, int j, double y, RasterRow& out) const;

    void judge_column(Worker& worker, int i, int j, double x, double y, RasterRow& out) const;

    /// Returns the layers that are ground, from the top down. RasterPose::layer counts these.
    std::span<const double> ground_layers(const ColumnView& column) const;

    void layers(Worker& worker, const ColumnView& column, double x, double y, RasterRow& out) const;

    /// Lets the robot down at a place on a layer.
    void settle(StandJudge& stand, const ColumnView& column, const Vec3& place, int layer, RasterRow& out) const;

    /// Returns the steps that may be near enough to the ground, the steps beyond the map's z limits, and the replaced
    /// steps, from the top down. All other steps are certainly aerial.
    const Steps& near_heights(const ColumnView& column, const Steps& replaced) const;

    void heights(PoseJudge& judge, const ColumnView& column, const Steps& replaced, double x, double y,
                 RasterRow& out) const;

    /// Judges a column whose aerial poses are listed too: a column outside the map, or any column without height check.
    void all_heights(PoseJudge& judge, const Steps& replaced, double x, double y, RasterRow& out) const;

    std::int32_t layer_of(const ColumnView& column, const std::optional<Ground>& ground) const;

    /// Returns the steps of a 3D raster beyond the map's z limits.
    Steps steps_outside() const;

    const Judge::Impl& shared_;
    const RasterOptions& options_;
    const RasterGrid& grid_;
    const double offset_;
    const double top_;       ///< upper limit of the bounds' z
    const ZRange ground_z_;  ///< layers beyond it are not ground
    const AreaIndex area_;
    const bool is_everywhere_;
    const int headings_;  ///< 0: only options.yaw
    const bool is_settled_ = options_.stance == Stance::Settled;
    int block_ = most_columns;  ///< columns of a block
    /// Whether all poses on open ground are judged alike: at one yaw, above their layer, anywhere.
    const bool is_simple_ = options_.dims == 2 && !is_settled_ && options_.height_check && headings_ == 0 &&
                            is_everywhere_ && offset_ >= 0 && options_.layers.includes(0, 1);
    const Steps outside_ = steps_outside();
    mutable PerThread<Worker> workers_{[this] { return Worker(*this); }};
};

}  // namespace spawnfield

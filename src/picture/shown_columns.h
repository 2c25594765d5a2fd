#pragma once

#include "picture/palette.h"
#include "picture/picture.h"

#include <spawnfield/heatmap.h>

namespace spawnfield {

/// What a column is shown as: a verdict, or one of these.
using Kind = std::uint8_t;
constexpr Kind some_headings = verdict_count, obstacle = verdict_count + 1, no_pose = verdict_count + 2,
               kind_count = verdict_count + 3;

constexpr Kind kind_of(Verdict verdict) { return static_cast<Kind>(verdict); }

Colour colour_of(Kind kind);

/// The pose that the picture shows of each column, nullptr where it has none. Row 0 is the largest y.
struct ShownPoses {
    int rows = 0, cols = 0;
    std::vector<const RasterPose*> poses;
    std::vector<int> headings;  ///< at how many the pose is valid

    std::size_t index(int row, int col) const { return static_cast<std::size_t>(row) * cols + col; }
    const RasterPose* at(int row, int col) const { return poses[index(row, col)]; }
    bool is_valid(int row, int col, int at_headings) const
    {
        return at(row, col) && headings[index(row, col)] >= at_headings;
    }
};

/// Valid at more headings first, then the higher one. Throws ArgumentError for poses that stand on no column.
ShownPoses shown_poses(const RasterResult& raster, const HeatmapOptions& options);

/// What a column without a pose is: in 3D rasters all its poses are aerial, which are counted but not listed.
bool is_aerial_without_pose(const RasterResult& raster);

using Kinds = cv::Mat_<Kind>;  ///< by column, row 0 the largest y

Kinds column_kinds(const ShownPoses& shown, const RasterResult& raster, const HeatmapOptions& options);

/// Makes obstacles of the columns that one stands on. Where the robot fits over or beside it, the column stays valid.
void mark_obstacles(Kinds& kinds, const cv::Mat_<std::uint8_t>& obstacles);

/// Each column is the middle of a square.
View view_of(const RasterGrid& grid);
GridFrame frame_of(const RasterGrid& grid);

}  // namespace spawnfield

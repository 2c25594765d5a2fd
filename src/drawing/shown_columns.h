#pragma once

#include "picture/palette.h"
#include "drawing/picture.h"

#include <spawnfield/heatmap.h>

namespace spawnfield {

/// The kind of a column in the picture: a verdict, or one of the constants below.
using Kind = std::uint8_t;
constexpr Kind some_headings = verdict_count, obstacle = verdict_count + 1, no_pose = verdict_count + 2,
               kind_count = verdict_count + 3;

constexpr Kind kind_of(Verdict verdict) { return static_cast<Kind>(verdict); }

Colour colour_of(Kind kind);

/// The pose that the picture shows for each column; nullptr for a column without a pose. Row 0 is the largest y.
struct ShownPoses {
    int rows = 0, cols = 0;
    std::vector<const RasterPose*> poses;
    std::vector<int> headings;  ///< number of headings at which the pose is valid

    std::size_t index(int row, int col) const { return static_cast<std::size_t>(row) * cols + col; }
    const RasterPose* at(int row, int col) const { return poses[index(row, col)]; }
    bool is_valid(int row, int col, int least_headings) const
    {
        return at(row, col) && headings[index(row, col)] >= least_headings;
    }
};

/// Returns the height of the layer on which a pose of a 2D raster stands, m; of a pose of a 3D raster, its own height.
/// `pose` must be one of raster.poses.
double layer_height(const RasterResult& raster, const RasterPose& pose);

/// Returns the poses to show. Of several poses in a column it takes the one that is valid at most headings, and among
/// equal ones the first in the raster's list: that of the highest layer. Throws ArgumentError for a pose that is not in
/// a column of the raster.
ShownPoses shown_poses(const RasterResult& raster, const HeatmapOptions& options);

/// Returns whether a column without a pose is aerial: in a 3D raster, aerial poses are counted but not listed, so that
/// all poses of such a column are aerial.
bool is_aerial_without_pose(const RasterResult& raster);

using Kinds = cv::Mat_<Kind>;  ///< one for each column; row 0 is the largest y

Kinds column_kinds(const ShownPoses& shown, const RasterResult& raster, const HeatmapOptions& options);

/// Marks the columns on which an obstacle stands. A column where the robot fits over or beside the obstacle remains
/// valid.
void mark_obstacles(Kinds& kinds, const cv::Mat_<std::uint8_t>& obstacles);

/// Returns the area of the raster. Each column is the middle of a square.
View view_of(const RasterGrid& grid);
GridFrame frame_of(const RasterGrid& grid);

}  // namespace spawnfield

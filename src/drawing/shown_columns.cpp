#include "drawing/shown_columns.h"

#include <spawnfield/error.h>

#include <cmath>

namespace spawnfield {
namespace {

/// Returns at how many headings pose p of the raster is valid.
int headings_of(const RasterResult& raster, const HeatmapOptions& options, std::size_t p)
{
    if (!options.valid_headings.empty()) return options.valid_headings[p];
    return raster.poses[p].verdict == Verdict::Valid ? options.headings : 0;
}

}  // namespace

Colour colour_of(Kind kind)
{
    switch (kind) {
    case some_headings: return rgb(some_headings_colour);
    case obstacle: return rgb(obstacle_colour);
    case no_pose: return rgb(no_pose_colour);
    default: return rgb(verdict_palette[kind]);
    }
}

double layer_height(const RasterResult& raster, const RasterPose& pose)
{
    if (!raster.rests.empty()) return raster.rests[std::size_t(&pose - raster.poses.data())].layer_height;
    return pose.z - (raster.dims == 2 ? raster.offset : 0);
}

ShownPoses shown_poses(const RasterResult& raster, const HeatmapOptions& options)
{
    const RasterGrid& grid = raster.grid;
    ShownPoses shown{grid.rows, grid.cols, {}, {}};
    shown.poses.resize(static_cast<std::size_t>(grid.rows) * grid.cols);
    shown.headings.resize(shown.poses.size());
    for (std::size_t p = 0; p < raster.poses.size(); ++p) {
        const RasterPose& pose = raster.poses[p];
        const double i = std::round((pose.x - grid.x0) / grid.step), j = std::round((pose.y - grid.y0) / grid.step);
        if (!(i >= 0 && i < grid.cols))
            throw ArgumentError("write_heatmap", "x of a pose", pose.x, "a column of the raster");
        if (!(j >= 0 && j < grid.rows))
            throw ArgumentError("write_heatmap", "y of a pose", pose.y, "a column of the raster");
        const std::size_t column = shown.index(grid.rows - 1 - static_cast<int>(j), static_cast<int>(i));
        const int headings = headings_of(raster, options, p);
        if (shown.poses[column] && headings <= shown.headings[column]) continue;
        shown.poses[column] = &pose;
        shown.headings[column] = headings;
    }
    return shown;
}

bool is_aerial_without_pose(const RasterResult& raster)
{
    return raster.dims == 3 && raster.counts[Verdict::Aerial] > 0 && raster.area.is_everywhere();
}

Kinds column_kinds(const ShownPoses& shown, const RasterResult& raster, const HeatmapOptions& options)
{
    const Kind without_pose = is_aerial_without_pose(raster) ? kind_of(Verdict::Aerial) : no_pose;
    Kinds kinds(shown.rows, shown.cols);
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col) {
            const RasterPose* const pose = shown.at(row, col);
            kinds(row, col) = !pose                                        ? without_pose
                              : shown.is_valid(row, col, options.headings) ? kind_of(Verdict::Valid)
                              : shown.is_valid(row, col, 1)                ? some_headings
                                                                           : kind_of(pose->verdict);
        }
    return kinds;
}

void mark_obstacles(Kinds& kinds, const cv::Mat_<std::uint8_t>& obstacles)
{
    for (int row = 0; row < kinds.rows; ++row)
        for (int col = 0; col < kinds.cols; ++col) {
            const Kind kind = kinds(row, col);
            if (obstacles(row, col) && kind != kind_of(Verdict::Valid) && kind != some_headings)
                kinds(row, col) = obstacle;
        }
}

View view_of(const RasterGrid& grid)
{
    return {grid.x_of(0) - grid.step / 2, grid.y_of(0) - grid.step / 2, grid.cols * grid.step, grid.rows * grid.step};
}

GridFrame frame_of(const RasterGrid& grid)
{
    const View view = view_of(grid);
    return {view.x0, view.y0, grid.step, grid.rows, grid.cols};
}

}  // namespace spawnfield

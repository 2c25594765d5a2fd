#include "drawing/quantities.h"

#include "drawing/relief.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace spawnfield {
namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

cv::Mat_<float> pose_heights(const ShownPoses& shown, int headings)
{
    cv::Mat_<float> values(shown.rows, shown.cols, no_value);
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col)
            if (shown.is_valid(row, col, headings)) values(row, col) = static_cast<float>(shown.at(row, col)->z);
    return values;
}

cv::Mat_<float> measured(const ShownPoses& shown, const RasterResult& raster, const HeatmapOptions& options)
{
    cv::Mat_<float> values(shown.rows, shown.cols, no_value);
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col)
            if (shown.is_valid(row, col, options.headings))
                values(row, col) = float(options.values[std::size_t(shown.at(row, col) - raster.poses.data())]);
    return values;
}

/// A valid column with the 3 x 3 terrain cells around it.
struct Place {
    int row, col;  ///< of the column in the raster
    int cell_row, cell_col;
    double layer;  ///< height of the layer that its pose stands on, m
    /// For each cell, the layer that is nearest to that height: in a neighbouring cell the same surface may be another
    /// layer.
    HeightImage around;
};

std::vector<Place> valid_places(const ShownPoses& shown, const RasterResult& raster, const GridFrame& frame,
                                int headings)
{
    const RasterGrid& grid = raster.grid;
    std::vector<Place> out;
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col) {
            if (!shown.is_valid(row, col, headings)) continue;
            const int cell_col = cell_index((grid.x_of(col) - frame.x0) / frame.cell, frame.cols);
            const int from_below = cell_index((grid.y_of(grid.rows - 1 - row) - frame.y0) / frame.cell, frame.rows);
            if (cell_col < 0 || from_below < 0) continue;
            out.push_back({row, col, frame.rows - 1 - from_below, cell_col, layer_height(raster, *shown.at(row, col)),
                           HeightImage(3, 3, no_value)});
        }
    return out;
}

/// Takes the heights around a place that are nearer to its layer than those found before.
void take_nearer(Place& place, const HeightImage& heights)
{
    for (int dr = -1; dr <= 1; ++dr)
        for (int dc = -1; dc <= 1; ++dc) {
            const int row = place.cell_row + dr, col = place.cell_col + dc;
            if (row < 0 || col < 0 || row >= heights.rows || col >= heights.cols || !std::isfinite(heights(row, col)))
                continue;
            float& nearest = place.around(dr + 1, dc + 1);
            if (!(std::abs(heights(row, col) - place.layer) >= std::abs(nearest - place.layer)))
                nearest = heights(row, col);
        }
}

/// Returns the slope of each valid column, degrees. Goes layer by layer, so that only one page of the terrain is in
/// memory.
cv::Mat_<float> slopes(const ShownPoses& shown, const RasterResult& raster, const TerrainMap& terrain, int headings)
{
    std::vector<Place> places = valid_places(shown, raster, terrain.frame, headings);
    for (int layer = 0; layer < terrain.layers(); ++layer) {
        const HeightImage heights = page_image(terrain, "height." + std::to_string(layer));
        for (Place& place : places) take_nearer(place, heights);
    }
    cv::Mat_<float> values(shown.rows, shown.cols, no_value);
    for (const Place& place : places) {
        const double slope = gradient(place.around, 1, 1, terrain.frame.cell).norm();
        values(place.row, place.col) = static_cast<float>(std::atan(slope) * 180 / std::numbers::pi);
    }
    return values;
}

/// Returns how the robot stands in each valid column: degrees for angles, m for lengths.
cv::Mat_<float> rests(const ShownPoses& shown, const RasterResult& raster, HeatmapQuantity quantity, int headings)
{
    constexpr double degree = std::numbers::pi / 180;
    const auto value = [&](const RasterRest& rest) {
        switch (quantity) {
        case HeatmapQuantity::Roll: return rest.roll / degree;
        case HeatmapQuantity::Pitch: return rest.pitch / degree;
        case HeatmapQuantity::Margin: return rest.margin;
        case HeatmapQuantity::Belly: return rest.belly;
        default: return rest.tilt / degree;
        }
    };
    cv::Mat_<float> values(shown.rows, shown.cols, no_value);
    for (int row = 0; row < shown.rows; ++row)
        for (int col = 0; col < shown.cols; ++col)
            if (shown.is_valid(row, col, headings))
                values(row, col) = float(value(raster.rests[std::size_t(shown.at(row, col) - raster.poses.data())]));
    return values;
}

}  // namespace

cv::Mat_<float> quantity_values(const ShownPoses& shown, const RasterResult& raster, const TerrainMap& terrain,
                                const HeatmapOptions& options)
{
    if (is_measured(options.quantity)) return measured(shown, raster, options);
    switch (options.quantity) {
    case HeatmapQuantity::Height: return pose_heights(shown, options.headings);
    case HeatmapQuantity::Slope: return slopes(shown, raster, terrain, options.headings);
    default: return rests(shown, raster, options.quantity, options.headings);
    }
}

}  // namespace spawnfield

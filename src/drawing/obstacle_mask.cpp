#include "drawing/obstacle_mask.h"

#include "base/parallel.h"
#include "column/columns.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Returns the column's layer that is nearest to the height; the height itself if no layer is within reach.
double own_layer(const ColumnView& column, double height, double reach)
{
    double nearest = height, distance = reach;
    for (const double layer : column.layers)
        if (std::abs(layer - height) <= distance) {
            nearest = layer;
            distance = std::abs(layer - height);
        }
    return nearest;
}

bool has_obstacle(const ColumnView& column, double low, double high)
{
    return std::any_of(column.spans.begin(), column.spans.end(),
                       [&](const Span& span) { return !span.terrain && span.top >= low && span.bottom <= high; });
}

/// Returns whether an obstacle stands in the column at (x, y) at the height of a robot on the shown layer.
bool is_obstacle(const ColumnView& column, double x, double y, const ObstacleSearch& search)
{
    constexpr double anywhere = std::numeric_limits<double>::infinity();
    if (column.spans.empty()) return false;
    const std::optional<double> height = search.layer_near(x, y);
    if (!height) return search.without_layer && column.layers.empty() && has_obstacle(column, -anywhere, anywhere);
    const double layer = own_layer(column, *height, search.reach);
    return has_obstacle(column, layer + search.robot.low, layer + search.robot.high);
}

}  // namespace

cv::Mat_<std::uint8_t> obstacle_mask(const Geometry& geometry, const GridFrame& frame, const ObstacleSearch& search)
{
    constexpr int strip = 32, block = 128;  // rows and columns that are looked up together
    cv::Mat_<std::uint8_t> mask(frame.rows, frame.cols, std::uint8_t{0});
    if (geometry.element_count() == 0) return mask;
    parallel_for(std::size_t((frame.rows + strip - 1) / strip), search.threads, {}, [&](std::size_t s) {
        const int first_row = int(s) * strip, rows = std::min(strip, frame.rows - first_row);
        for (int first_col = 0; first_col < frame.cols; first_col += block) {
            const int cols = std::min(block, frame.cols - first_col);
            const ColumnGrid grid{frame.x0, frame.y0, frame.cell, first_col, first_row, cols, rows, 0.5};
            const Columns columns(geometry, grid);
            for (int j = 0; j < rows; ++j)
                for (int i = 0; i < grid.cols; ++i)
                    mask(frame.rows - 1 - first_row - j, first_col + i) = is_obstacle(
                        columns.at(i, j), grid.x_of(first_col + i), grid.y_of(first_row + j), search);
        }
    });
    return mask;
}

}  // namespace spawnfield

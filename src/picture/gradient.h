#pragma once

#include <spawnfield/terrain.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {

/// Returns the change of height with x and with y at a cell. It is one-sided if one neighbour has no height, 0 if both
/// have none, and NaN if the cell itself has no height.
inline Eigen::Vector2d gradient(const HeightImage& heights, int row, int col, double cell)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const double here = heights(row, col);
    if (!std::isfinite(here)) return {nan, nan};
    const auto change = [&](int row_step, int col_step) {
        const auto height = [&](int r, int c) {
            const bool inside = r >= 0 && r < heights.rows && c >= 0 && c < heights.cols;
            return inside && std::isfinite(heights(r, c)) ? static_cast<double>(heights(r, c)) : nan;
        };
        double after = height(row + row_step, col + col_step), before = height(row - row_step, col - col_step);
        const int steps = (std::isfinite(after) ? 1 : 0) + (std::isfinite(before) ? 1 : 0);
        if (!std::isfinite(after)) after = here;
        if (!std::isfinite(before)) before = here;
        return (after - before) / (std::max(steps, 1) * cell);
    };
    return {change(0, 1), change(-1, 0)};  // rows run against y
}

}  // namespace spawnfield

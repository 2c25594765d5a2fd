#pragma once

#include "free_space/bounds_tile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {

/// Columns or rows of cells of a raster, or of one of its tiles; both ends are included.
struct CellRange {
    int first, last;

    bool operator==(const CellRange&) const = default;
    int count() const { return last - first + 1; }
    /// Returns the part of it that is in the tile which begins at `cell`, counted from there.
    CellRange in_tile(int cell) const
    {
        return {std::max(first - cell, 0), std::min(last - cell, int(BoundsTile::side) - 1)};
    }
};

inline constexpr CellRange no_cells{std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};

// The values must fit an int.
inline int floor_of(double value) { return int(std::floor(value)); }
inline int ceil_of(double value) { return int(std::ceil(value)); }

/// Returns the cells that meet a range, which counts in cells.
inline CellRange cells_around(double low, double high) { return {floor_of(low), floor_of(high)}; }
/// Returns the cells that are completely inside it.
inline CellRange cells_inside(double low, double high) { return {ceil_of(low), floor_of(high) - 1}; }

}  // namespace spawnfield

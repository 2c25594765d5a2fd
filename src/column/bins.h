#pragma once

#include <spawnfield/column.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {

/// Column or row of bins at an offset from the index's corner; what lies beyond the rim is in the outermost.
inline std::uint32_t bin_number(double offset, double cell, std::uint32_t count)
{
    return static_cast<std::uint32_t>(std::clamp(std::floor(offset / cell), 0.0, double(count - 1)));
}

/// Calls visit(first, last) with the elements of each level's bin that holds (x, y).
template <class Visit>
void visit_bins_at(const ColumnIndex& index, double x, double y, const Visit& visit)
{
    const double dx = x - index.x0, dy = y - index.y0;
    if (dx < 0 || dy < 0) return;
    for (const ColumnIndex::Level& level : index.levels) {
        if (dx > level.cell * level.cols || dy > level.cell * level.rows) continue;
        const std::size_t bin = std::size_t{bin_number(dy, level.cell, level.rows)} * level.cols + bin_number(dx, level.cell, level.cols);
        visit(level.elements.data() + level.offsets[bin], level.elements.data() + level.offsets[bin + 1]);
    }
}

}  // namespace spawnfield

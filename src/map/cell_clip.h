#pragma once

#include <spawnfield/column.h>

namespace spawnfield {

/// A rectangle of square cells: cell (i, j) spans x0 + i * cell .. x0 + (i + 1) * cell, likewise in y.
struct CellBlock {
    double x0 = 0, y0 = 0, cell = 1;
    int cols = 0, rows = 0;

    std::uint32_t id(int i, int j) const { return std::uint32_t(j) * std::uint32_t(cols) + std::uint32_t(i); }
};

/// Heights between which solid surfaces (and the filling of primitives) lie anywhere in a closed cell.
struct CellSpan {
    std::uint32_t cell;  ///< CellBlock::id
    double bottom, top;
};

/// One span for each cell that a triangle or primitive meets, cells widened by touch_tolerance; water left out. Sorted by
/// cell, then bottom. The inside of filled meshes is not in it: only their surfaces are.
std::vector<CellSpan> clip_to_cells(const Geometry& geometry, const CellBlock& block);

/// Unions spans of one cell that overlap; input and output sorted by bottom.
void join_spans(std::vector<Interval>& spans);

/// Solid intervals of a column, terrain and obstacles joined, from the bottom up.
std::vector<Interval> solid_intervals(const Column& column);

}  // namespace spawnfield

#pragma once

#include "column/columns.h"

namespace spawnfield {

/// A rectangle of square cells: cell (i, j) spans x0 + i * cell .. x0 + (i + 1) * cell, likewise in y.
struct CellBlock {
    double x0 = 0, y0 = 0, cell = 1;
    int cols = 0, rows = 0;

    std::uint32_t id(int i, int j) const { return std::uint32_t(j) * std::uint32_t(cols) + std::uint32_t(i); }
};

/// Heights between which solid surfaces, and the filling of primitives, lie anywhere in the closed cells of a block;
/// water left out. Of the inside of meshes it knows nothing, but for meshes with holes that are filled by wish: those
/// count down to their lowest vertex.
///
/// Upper ends are attained: some solid point of the cell, or within 1e-8 m of it, is as high. Cylinders become prisms
/// around them that are at most 4e-6 m wider, or 4096-sided: then is_tight() is false.
/// Source of the clipping: Sutherland, Hodgman, Reentrant polygon clipping, 1974. O(triangles + cells they cover).
class CellSpans {
public:
    CellSpans(const Geometry& geometry, const CellBlock& block);

    /// Whether there is more than one interval to a cell, before they are joined; if not, it is this one, if not empty.
    bool has_more(std::uint32_t cell) const { return more_[cell]; }
    const Interval& first(std::uint32_t cell) const { return first_[cell]; }
    /// Of one cell, joined, from the bottom up.
    void get(std::uint32_t cell, std::vector<Interval>& out) const;
    bool is_tight() const { return tight_; }

private:
    class Collector;
    struct Further {
        std::uint32_t cell;
        Interval z;
    };
    std::vector<Interval> first_;        ///< one for each cell; bottom > top: none
    std::vector<bool> more_;             ///< whether the cell has further ones
    std::vector<Further> further_;       ///< what does not touch the first one; sorted by cell
    std::vector<std::uint32_t> starts_;  ///< in further_, by row of the block
    int cols_;
    bool tight_ = true;
};

/// Unions intervals that overlap; sorts them from the bottom up.
void join_spans(std::vector<Interval>& spans);

/// Solid intervals of a column, terrain and obstacles joined, from the bottom up.
std::vector<Interval> solid_intervals(const ColumnView& column);

}  // namespace spawnfield

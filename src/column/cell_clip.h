#pragma once

#include "column/columns.h"

#include <limits>

namespace spawnfield {

/// A rectangle of square cells. Cell (i, j) extends from x0 + i * cell to x0 + (i + 1) * cell in x, and from y0 + j *
/// cell to y0 + (j + 1) * cell in y.
struct CellBlock {
    double x0 = 0, y0 = 0, cell = 1;
    int cols = 0, rows = 0;

    std::uint32_t id(int i, int j) const { return std::uint32_t(j) * std::uint32_t(cols) + std::uint32_t(i); }
};

/// The height intervals in which the surfaces of solids and sheets, and the insides of primitives, lie in each closed
/// cell of a block. Water is left out. The insides of meshes are not included, with one exception: a surface of a mesh
/// with holes that the user asked to fill (Piece::open) counts from its top down to the mesh's lowest vertex.
///
/// Each upper end is the height of a solid point that lies in the cell or at most 1e-8 m outside it. Cylinders are
/// replaced by prisms around them that are at most 4e-6 m wider. If that takes more than 4096 sides, the prism has 4096
/// sides and is_tight() is false. O(triangles + cells that they cover). Source of the clipping: Sutherland, Hodgman,
/// Reentrant polygon clipping, 1974.
class CellSpans {
public:
    CellSpans(const Geometry& geometry, const CellBlock& block);

    /// Returns whether a cell has more intervals than first(). If not, first() is its only interval, or the cell has
    /// none: then first() has bottom > top.
    bool has_more(std::uint32_t cell) const { return last_[cell] != nothing; }
    const Interval& first(std::uint32_t cell) const { return first_[cell]; }
    /// Writes the intervals of one cell to `out`, joined, from the bottom up.
    void get(std::uint32_t cell, std::vector<Interval>& out) const;
    bool is_tight() const { return tight_; }

private:
    class Collector;
    static constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();
    struct Further {
        Interval z;
        std::uint32_t previous;  ///< index in further_ of another interval of the same cell, or nothing
    };
    std::vector<Interval> first_;      ///< one for each cell; bottom > top: none
    std::vector<Further> further_;     ///< intervals that did not touch the cell's first one
    std::vector<std::uint32_t> last_;  ///< for each cell the index of its last one in further_, or nothing
    bool tight_ = true;
};

/// Returns the solid intervals of a column, terrain and obstacles joined, from the bottom up.
std::vector<Interval> solid_intervals(const ColumnView& column);

}  // namespace spawnfield

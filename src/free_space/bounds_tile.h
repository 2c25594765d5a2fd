#pragma once

#include "base/tile_store.h"

#include <spawnfield/solid_bounds.h>

#include <bit>
#include <span>

namespace spawnfield {

/// The head of a tile. A 16-bit value means the height base + value * quantum, m. The value 0 means that there is
/// nothing.
struct BoundsHead {
    double base, quantum;
    double slack;  ///< m; each upper end is at most this far above a solid point of its cell; infinite if not known
    std::uint32_t bound_cells, bounds;  ///< number of cells that have intervals, and number of these intervals
    std::uint32_t solid_cells, solids;  ///< the same for BoundsTile::solids
};

struct QuantizedSpan {
    std::uint16_t bottom, top;
};

/// The intervals of a tile's cells. Most cells have none; the others are marked by a bit. The rank of a marked cell is
/// the number of marked cells before it.
struct CellIntervals {
    const std::uint64_t* marks = nullptr;   ///< one bit for each cell; nullptr if no cell is marked
    const std::uint16_t* ranks = nullptr;   ///< of each 64th cell, marked or not
    const std::uint32_t* starts = nullptr;  ///< by rank: where the cell's intervals begin in `spans`; then their number
    const QuantizedSpan* spans = nullptr;   ///< in each cell from the bottom up

    bool has(std::uint32_t cell) const { return marks != nullptr && (marks[cell / 64] >> (cell % 64) & 1) != 0; }
    /// Returns the intervals of a marked cell.
    std::span<const QuantizedSpan> of(std::uint32_t cell) const
    {
        const std::uint64_t before = marks[cell / 64] & ((std::uint64_t{1} << (cell % 64)) - 1);
        const std::size_t rank = std::size_t{ranks[cell / 64]} + std::size_t(std::popcount(before));
        return {spans + starts[rank], spans + starts[rank + 1]};
    }
};

/// A view of a tile's bytes. Its cell (col, row) has the number row * side + col; row 0 is the smallest y.
struct BoundsTile {
    static constexpr std::uint32_t side = 64;
    static constexpr std::uint32_t cells = side * side;

    const BoundsHead* head = nullptr;
    const std::uint16_t* tops = nullptr;  ///< for each cell the height of its highest solid point, rounded up
    /// All solid points of a marked cell lie in its intervals, which are rounded outwards. In other cells any point
    /// below the top may be solid.
    CellIntervals bounds;
    /// Points at the cell's centre that are certainly solid, rounded inwards.
    CellIntervals solids;

    BoundsTile() = default;
    /// Finds the arrays behind the head. The head's counts must fit the bytes (see bounds_tile_size).
    explicit BoundsTile(std::string_view bytes);

    double height(std::uint16_t value) const { return head->base + value * head->quantum; }
};

/// Returns the size of a tile with this head, bytes, without the padding at its end.
std::uint64_t bounds_tile_size(const BoundsHead& head);

struct SolidBounds::Impl {
    double x0 = 0, y0 = 0;  ///< lower left corner of all levels, m
    bool is_whole = false;  ///< nothing solid is beyond the raster
    TileStore tiles;        ///< level 0 is the finest; each next level has cells of twice the size

    const std::vector<TileLevel>& levels() const { return tiles.levels(); }

    /// Returns how many columns or rows of a level lie completely on the finest raster. The last coarse cells may reach
    /// beyond it.
    std::uint32_t whole_cols(std::size_t level) const { return levels()[0].cols >> level; }
    std::uint32_t whole_rows(std::size_t level) const { return levels()[0].rows >> level; }

    /// Returns a tile. It has no head if nothing in it is solid. Throws FileError for a damaged tile of a file.
    BoundsTile open(std::size_t level, std::uint32_t col, std::uint32_t row) const
    {
        const std::size_t number = std::size_t{row} * levels()[level].tile_cols + col;
        if (levels()[level].tiles[number].size == 0) return {};
        return BoundsTile(tiles.open(level, number, is_consistent));
    }

private:
    /// Returns whether all counts and indices of a tile fit its bytes.
    static bool is_consistent(std::string_view bytes);
};

}  // namespace spawnfield

#pragma once

#include "base/tile_store.h"

#include <spawnfield/solid_bounds.h>

#include <bit>
#include <span>

namespace spawnfield {

/// Heights of a tile: base + value * quantum, m. Value 0: nothing.
struct BoundsHead {
    double base, quantum;
    double slack;  ///< some solid point of the cell is within this of each upper end, m; infinite: not known
    std::uint32_t bound_cells, bounds;  ///< cells that have intervals, and how many they have together
    std::uint32_t solid_cells, solids;
};

struct QuantizedSpan {
    std::uint16_t bottom, top;
};

/// Intervals of those cells of a tile that have some.
struct CellIntervals {
    const std::uint64_t* marks = nullptr;   ///< a bit for each cell that has some; nullptr: none has
    const std::uint16_t* ranks = nullptr;   ///< marked cells before each 64 cells
    const std::uint32_t* starts = nullptr;  ///< in spans, by rank of the cell, and the end
    const QuantizedSpan* spans = nullptr;   ///< from the bottom up

    bool has(std::uint32_t cell) const { return marks != nullptr && (marks[cell / 64] >> (cell % 64) & 1) != 0; }
    /// Returns the intervals of a cell that has some.
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
    const std::uint16_t* tops = nullptr;  ///< of all that is solid in the cell, rounded up
    CellIntervals
        bounds;  ///< that hold all that is solid in the cell, where there is a gap; elsewhere all below the top may be
    CellIntervals solids;  ///< certainly solid at the cell's centre, rounded inwards

    BoundsTile() = default;
    /// The arrays behind a head, whose counts must fit the bytes (bounds_tile_size).
    explicit BoundsTile(std::string_view bytes);

    double height(std::uint16_t value) const { return head->base + value * head->quantum; }
};

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

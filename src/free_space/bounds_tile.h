#pragma once

#include "base/bits.h"
#include "base/tile_store.h"

#include <spawnfield/shape.h>
#include <spawnfield/solid_bounds.h>

#include <bit>
#include <span>

namespace spawnfield {

/// The head of a tile. A 16-bit value means the height base + value * quantum, m. The value 0 means that there is
/// nothing. Tiles of bounds.bin version 1 have a head without the last four fields.
struct BoundsHead {
    double base, quantum;
    double slack;  ///< m; each upper end is at most this far above a solid point of its cell; infinite if not known
    std::uint32_t bound_cells, bounds;  ///< number of cells that have intervals, and number of the stored intervals
    std::uint32_t solid_cells, solids;  ///< the same for BoundsTile::solids
    std::uint32_t bound_lists, solid_lists;  ///< numbers of the stored lists; 0: each cell has its own list
    std::uint32_t is_uniform;                ///< 1: all cells are the same, and only one is stored
    std::uint32_t unused;
};

struct QuantizedSpan {
    std::uint16_t bottom, top;

    bool operator==(const QuantizedSpan&) const = default;
};

/// The intervals of a tile's cells. Most cells have none; the others are marked by a bit. The rank of a marked cell is
/// the number of marked cells before it. Neighbouring cells often share a list of intervals.
struct CellIntervals {
    const std::uint64_t* marks = nullptr;   ///< one bit for each cell; nullptr if no cell is marked
    const std::uint16_t* ranks = nullptr;   ///< of each 64th cell, marked or not
    const std::uint16_t* lists = nullptr;   ///< by rank: the number of the cell's list; nullptr: it is the rank
    const std::uint32_t* starts = nullptr;  ///< where each list begins in `spans`; then their number
    const QuantizedSpan* spans = nullptr;   ///< in each list from the bottom up

    /// Returns the marks of the cells of a row of the tile, one bit for each.
    std::uint64_t marks_of(std::uint32_t row) const { return marks == nullptr ? 0 : marks[row]; }
    bool has(std::uint32_t cell) const { return marks != nullptr && (marks[cell / 64] >> (cell % 64) & 1) != 0; }
    /// Calls visit(col, intervals) for each marked cell of a row of the tile. It takes less time than of() for each.
    template <class Visit>
    void visit_row(std::uint32_t row, const Visit& visit) const
    {
        if (marks == nullptr || marks[row] == 0) return;
        std::size_t rank = ranks[row];  // a row has 64 cells
        for_each_bit(marks[row], [&](std::uint32_t col) {
            const std::size_t list = lists == nullptr ? rank : lists[rank];
            visit(col, std::span(spans + starts[list], spans + starts[list + 1]));
            ++rank;
        });
    }
    /// Returns the intervals of a marked cell.
    std::span<const QuantizedSpan> of(std::uint32_t cell) const
    {
        const std::uint64_t before = marks[cell / 64] & ((std::uint64_t{1} << (cell % 64)) - 1);
        const std::size_t rank = std::size_t{ranks[cell / 64]} + std::size_t(std::popcount(before));
        const std::size_t list = lists == nullptr ? rank : lists[rank];
        return {spans + starts[list], spans + starts[list + 1]};
    }
};

/// A view of a tile's bytes. Its cell (col, row) has the number row * side + col; row 0 is the smallest y.
struct BoundsTile {
    static constexpr std::uint32_t side = 64;
    static constexpr std::uint32_t cells = side * side;
    static constexpr std::uint32_t version = 2;  ///< of the bytes that pack() returns, and of bounds.bin

    double base = 0, quantum = 0, slack = 0;  ///< as in BoundsHead
    const std::uint16_t* tops = nullptr;      ///< for each cell the height of its highest solid point, rounded up
    /// All solid points of a marked cell lie in its intervals, which are rounded outwards. In other cells any point
    /// below the top may be solid.
    CellIntervals bounds;
    /// Points at the cell's centre that are certainly solid, rounded inwards.
    CellIntervals solids;

    BoundsTile() = default;
    /// Finds the arrays behind the head. The head's counts must fit the bytes (see is_consistent). Without bytes, the
    /// tile is empty.
    explicit BoundsTile(std::string_view bytes, std::uint32_t bytes_version = version);

    bool is_empty() const { return tops == nullptr; }
    double height(std::uint16_t value) const { return base + value * quantum; }

    /// Returns whether all counts and indices of a tile fit its bytes.
    static bool is_consistent(std::string_view bytes, std::uint32_t bytes_version = version);
};

/// Intervals of heights in each cell of a tile, before they are packed. Those of cell c are spans[starts[c]] ..
/// spans[starts[c + 1] - 1].
struct CellList {
    std::array<std::uint32_t, BoundsTile::cells + 1> starts{};
    std::vector<Interval> spans;  ///< from the bottom up, with gaps between them

    std::span<const Interval> of(std::size_t cell) const
    {
        return std::span(spans).subspan(starts[cell], starts[cell + 1] - starts[cell]);
    }

    /// Gives all cells the spans that the first cell has.
    void repeat_first();
};

/// A tile before it is packed.
struct LooseTile {
    CellList bounds, solids;  ///< as in BoundsTile
    double slack = 0;         ///< as in BoundsHead, before the heights are rounded
    bool is_empty() const { return bounds.spans.empty(); }
};

/// Packs a tile into bytes: heights become 16-bit numbers. A cell with one interval of bounds has only its top in the
/// tile; only cells with two or more have their intervals. Returns no bytes for an empty tile.
std::string packed(const LooseTile& tile);

struct SolidBounds::Impl {
    class ChangedTiles;  // changed_bounds.cpp

    double x0 = 0, y0 = 0;  ///< lower left corner of all levels, m
    bool is_whole = false;  ///< nothing solid is beyond the raster
    std::uint32_t tile_version = BoundsTile::version;
    TileStore tiles;  ///< level 0 is the finest; each next level has cells of twice the size
    // Only for a changed scene (changed_bounds.h), in the place of `tiles`:
    std::shared_ptr<const Impl> base;  ///< of the unchanged scene
    std::unique_ptr<const ChangedTiles> changed;

    Impl();
    ~Impl();

    const std::vector<TileLevel>& levels() const { return base ? base->levels() : tiles.levels(); }

    /// Says that most tiles will be needed (see TileStore).
    void expect_all() const { (base ? base->tiles : tiles).expect_all(); }

    /// Returns how many columns or rows of a level lie completely on the finest raster. The last coarse cells may reach
    /// beyond it.
    std::uint32_t whole_cols(std::size_t level) const { return levels()[0].cols >> level; }
    std::uint32_t whole_rows(std::size_t level) const { return levels()[0].rows >> level; }

    /// Returns a tile. It is empty if nothing in it is solid. Throws FileError for a damaged tile of a file.
    BoundsTile open(std::size_t level, std::uint32_t col, std::uint32_t row) const;
    /// Begins to fetch the head of a tile from memory, if the tile was opened before. Inline for the same reason as
    /// Mask::OpenTile::fetch().
    [[gnu::always_inline]] void fetch_head(std::size_t level, std::uint32_t col, std::uint32_t row) const
    {
        if (!changed) __builtin_prefetch(tiles.opened(level, std::size_t{row} * tiles.levels()[level].tile_cols + col));
    }
    /// Returns the bytes of a tile, with or without zero bytes at the end; none if nothing in it is solid.
    std::string_view bytes_of(std::size_t level, std::uint32_t col, std::uint32_t row) const;
};

}  // namespace spawnfield

#pragma once

#include "base/bytes.h"
#include "geometry/tile.h"

#include <spawnfield/solid_bounds.h>

namespace spawnfield {

/// Heights of a tile: base + value * quantum, m. Value 0: nothing.
struct BoundsHead {
    double base, quantum;
    double slack;                 ///< some solid point of the cell is within this of each upper end, m; infinite: not known
    std::uint32_t spans, solids;  ///< numbers of intervals; 0: not told
};

struct QuantizedSpan {
    std::uint16_t bottom, top;
};

/// A tile's bytes as what they are. Cell (col, row) of it is number row * side + col; row 0 is the smallest y.
struct BoundsTile {
    static constexpr std::uint32_t side = 64;
    static constexpr std::uint32_t cells = side * side;

    const BoundsHead* head = nullptr;
    const std::uint16_t* tops = nullptr;           ///< of all that is solid in the cell, rounded up
    const std::uint32_t* span_starts = nullptr;    ///< intervals that hold it; nullptr: all below the top
    const QuantizedSpan* spans = nullptr;          ///< from the bottom up
    const std::uint32_t* solid_starts = nullptr;   ///< what is solid for certain at the cell's centre, rounded inwards
    const QuantizedSpan* solids = nullptr;

    BoundsTile() = default;
    /// The arrays behind a head, whose counts must fit the bytes (bounds_tile_size).
    explicit BoundsTile(std::string_view bytes);

    double height(std::uint16_t value) const { return head->base + value * head->quantum; }
    std::span<const QuantizedSpan> spans_of(std::uint32_t cell) const { return {spans + span_starts[cell], spans + span_starts[cell + 1]}; }
    std::span<const QuantizedSpan> solids_of(std::uint32_t cell) const { return {solids + solid_starts[cell], solids + solid_starts[cell + 1]}; }
};

std::uint64_t bounds_tile_size(const BoundsHead& head);

struct BoundsLevel {
    double cell = 0;                          ///< m
    std::uint32_t cols = 0, rows = 0;         ///< cells
    std::uint32_t tile_cols = 0, tile_rows = 0;
    std::vector<TileEntry> tiles;             ///< row after row; row 0 is the smallest y; a size of 0: nothing solid
};

struct SolidBounds::Impl {
    double x0 = 0, y0 = 0;   ///< lower left corner of all levels
    bool is_whole = false;   ///< nothing solid lies beyond the raster
    std::vector<BoundsLevel> levels;  ///< finest first
    Bytes bytes;
    std::string file;        ///< that they lie in, for messages; empty: in memory, and trusted

    void make_states();

    /// The tile, or one without a head where nothing is solid. Throws FileError.
    BoundsTile open(std::size_t level, std::uint32_t col, std::uint32_t row) const
    {
        const std::size_t number = std::size_t{row} * levels[level].tile_cols + col;
        const TileEntry& entry = levels[level].tiles[number];
        if (entry.size == 0) return {};
        const std::string_view view = bytes.view.substr(entry.offset, entry.size);
        std::atomic<std::uint8_t>& checked = states_[level][number];
        if (checked.load(std::memory_order_acquire) == 0) {
            verify(view, entry);
            checked.store(1, std::memory_order_release);
        }
        return BoundsTile(view);
    }

private:
    void verify(std::string_view view, const TileEntry& entry) const;

    mutable std::vector<std::unique_ptr<std::atomic<std::uint8_t>[]>> states_;  ///< 1: checked
};

}  // namespace spawnfield

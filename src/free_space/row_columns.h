#pragma once

#include "base/bits.h"
#include "base/rect.h"
#include "free_space/cell_range.h"
#include "free_space/row_maxima.h"

#include <optional>
#include <span>
#include <vector>

namespace spawnfield {

/// The columns of cells that a part meets at each pose of a row, tile by tile. They depend on the x of the poses, but
/// not on y and z, so that the rows of a raster share them.
class RowColumns {
public:
    /// The columns of one tile that the part meets at one pose.
    struct Seen {
        std::uint64_t bits;            ///< one for each column
        RowMaxima::Columns all, core;  ///< all of them, and those completely under the part's core
    };
    /// The poses at which the part meets a tile, which follow each other.
    struct InTile {
        std::uint32_t col;  ///< of the tile
        std::size_t first_pose, first_seen, count;
    };
    /// Where the part reaches from its origin, and its core; only x counts.
    struct Extent {
        Rect reach;
        std::optional<Rect> core;
    };
    struct Raster {
        double x0, cell;  ///< left edge and size of a cell, m
        int known_cols;   ///< the number of columns of cells
    };

    /// Sets the poses' x, m, ascending.
    void set(std::span<const double> x, const Extent& part, const Raster& raster);

    /// Returns whether the part is narrow enough for RowMaxima. If it is not, nothing else is known.
    bool fit_windows() const { return wide_ <= RowMaxima::widest; }
    int wide() const { return wide_; }            ///< columns of a window for Seen::all
    int core_wide() const { return core_wide_; }  ///< the same for Seen::core
    std::span<const InTile> tiles() const { return tiles_; }
    std::span<const Seen> seen_in(const InTile& tile) const
    {
        return std::span(seen_).subspan(tile.first_seen, tile.count);
    }
    /// Returns the poses about which this says nothing, although tiles may list them: they meet columns beyond the
    /// raster, or their number of columns fits no window, because the last bit of a number decides.
    std::span<const std::size_t> unknown() const { return unknown_; }

private:
    struct Cells {
        CellRange all, core;
    };
    Seen seen(const Cells& cells, int tile_left) const;
    void list_tiles(std::size_t first, std::size_t end);

    int wide_ = 1, core_wide_ = 1;
    std::vector<Cells> cells_;  ///< of each pose
    std::vector<InTile> tiles_;
    std::vector<Seen> seen_;
    std::vector<std::size_t> unknown_;
};

}  // namespace spawnfield

#pragma once

#include "base/four.h"
#include "geometry/geometry_impl.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace spawnfield {

/// The tiles of a geometry that meet a box, in square bins seen from above. A tile is opened when a space meets it for
/// the first time.
class TileBins {
public:
    /// The geometry must live as long as this object.
    explicit TileBins(const Geometry::Impl& geometry) : geometry_(geometry) {}

    /// Finds the tiles that meet `area`. It may be infinite along z.
    void find(const Bounds& area);
    /// The last area; empty if there was none.
    const Bounds& area() const { return area_; }

    /// Calls visit(tile) for each tile that meets a space in the area, until it returns false.
    template <class Visit>
    void visit(const Bounds& space, const Visit& visit)
    {
        const Limits limits = limits_of(space);
        const auto is_last = [&](std::uint32_t tile) { return !visit(opened(tile)); };
        const std::uint32_t probable = probable_;
        if (probable < binned_.size() && overlap_within(binned_[probable].limits, limits) && is_last(probable)) return;
        const BinRange bins = bins_of(Two{space.min.x(), space.max.x()}, Two{space.min.y(), space.max.y()});
        const Binned* const binned = binned_.data();
        for (std::size_t row = bins.first_row; row <= bins.last_row; ++row)
            for (std::size_t col = bins.first_col; col <= bins.last_col; ++col)
                for (const std::uint32_t tile : entries_of(row * cols_ + col)) {
                    const auto& [tile_limits, tile_bins] = binned[tile];
                    if (!overlap_within(tile_limits, limits)) continue;
                    const bool is_first = col == std::max(bins.first_col, tile_bins.first_col) &&
                                          row == std::max(bins.first_row, tile_bins.first_row);
                    if (is_first && tile != probable && is_last(tile)) {
                        probable_ = tile;
                        return;
                    }
                }
    }

private:
    struct BinRange {
        std::uint16_t first_col, last_col, first_row, last_row;
    };
    /// The limits of a box along x, y and z, m: smallest coordinate and negative of the largest for a tile, the other
    /// way round for a space. So few instructions compare them.
    using Limits = std::array<Two, 3>;
    /// A tile in the bins.
    struct Binned {
        Limits limits;
        BinRange bins;  ///< that it meets
    };
    /// Where a tile is.
    struct Found {
        const Forest* forest;
        std::uint32_t tree, number;
        std::uint32_t opened_as = not_opened;  ///< its index in opened_
        static constexpr std::uint32_t not_opened = ~std::uint32_t{0};
    };

    static Limits limits_of(const ElementBox& tile)
    {
        Limits out;
        for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = Two{tile.min[axis], -tile.max[axis]};
        return out;
    }
    static Limits limits_of(const Bounds& space)
    {
        return {Two{space.max.x(), -space.min.x()}, Two{space.max.y(), -space.min.y()},
                Two{space.max.z(), -space.min.z()}};
    }
    static bool overlap_within(const Limits& tile, const Limits& space)
    {
        return are_set((tile[0] <= space[0]) & (tile[1] <= space[1]) & (tile[2] <= space[2]));
    }

    std::span<const std::uint32_t> entries_of(std::size_t bin) const
    {
        return std::span(entries_).subspan(starts_[bin], starts_[bin + 1] - starts_[bin]);
    }
    const Tile& opened(std::uint32_t tile)
    {
        Found& found = found_[tile];
        if (found.opened_as == Found::not_opened) {
            opened_.push_back(geometry_.open(*found.forest, found.tree, found.number));
            found.opened_as = std::uint32_t(opened_.size() - 1);
        }
        return opened_[found.opened_as];
    }
    BinRange bins_of(const Two& x, const Two& y) const;
    void fill_bins();

    const Geometry::Impl& geometry_;
    Bounds area_;
    double bins_per_metre_ = 0;
    std::uint32_t cols_ = 1, rows_ = 1;
    std::vector<std::uint32_t> starts_{0, 0};  ///< of each bin in entries_; then their number
    std::vector<std::uint32_t> entries_;       ///< indices in binned_ and found_
    std::vector<Binned> binned_;
    std::vector<Found> found_;  ///< the same tiles
    std::vector<Tile> opened_;  ///< some of them
    /// The tile at which the last visit ended, or 0. It is visited first: for robots at neighbouring places, the same
    /// tile often decides.
    std::uint32_t probable_ = 0;
};

}  // namespace spawnfield

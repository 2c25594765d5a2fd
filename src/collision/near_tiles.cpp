#include "collision/near_tiles.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

bool contains(const Bounds& outer, const Bounds& inner)
{
    return (outer.min.array() <= inner.min.array()).all() && (outer.max.array() >= inner.max.array()).all();
}

/// Returns the box, grown on each side by three of its own lengths: the poses of a raster are that near to each other.
Bounds neighbourhood(const Bounds& box)
{
    constexpr double reach = 3;
    const Vec3 by = reach * (box.max - box.min);
    return {box.min - by, box.max + by};
}

}  // namespace

/// Returns the tiles that meet a box, and others near it.
const std::vector<NearTiles::Near>& NearTiles::tiles_near(const Bounds& space)
{
    if (!contains(known_, space)) {
        const Bounds wanted = contains(neighbourhood(last_), space) ? neighbourhood(space) : space;
        known_ = {};  // remains so if a tile is damaged
        near_.clear();
        geometry_.visit_tiles(wanted, [&](const Tile& tile, const ElementBox& box) { near_.push_back({tile, box}); });
        known_ = wanted;
    }
    last_ = space;
    return near_;
}

/// Returns the bins that a box meets. Both ranges are from the smallest to the largest coordinate, m.
NearTiles::BinRange NearTiles::bins_of(const Two& x, const Two& y) const
{
    const Two first{}, last_col = both(cols_ - 1), last_row = both(rows_ - 1);
    const Two cols = least(greatest((x - expected_->low_x) * bins_per_metre_, first), last_col),
              rows = least(greatest((y - expected_->low_y) * bins_per_metre_, first), last_row);
    return {std::uint16_t(cols[0]), std::uint16_t(cols[1]), std::uint16_t(rows[0]), std::uint16_t(rows[1])};
}

/// Puts the tiles of the expected rectangle into bins of the size that a tile has on average.
void NearTiles::bin_expected()
{
    const Rect& area = *expected_;
    binned_.clear();
    found_.clear();
    opened_.clear();
    probable_ = 0;
    geometry_.for_each_tree([&](const Forest& forest, std::size_t t) {
        const TileTree& tree = forest.trees[t];
        tree.visit(area.low_x, area.low_y, area.high_x, area.high_y, [&](std::size_t number) {
            binned_.push_back({limits_of(tree.boxes()[number]), {}});
            found_.push_back({&forest, std::uint32_t(t), std::uint32_t(number)});
        });
    });
    const double width = area.high_x - area.low_x, height = area.high_y - area.low_y;
    constexpr double most = 64;  // bins along a side
    bins_per_metre_ = std::min(std::sqrt(double(binned_.size()) / (width * height)), most / std::max(width, height));
    cols_ = std::uint32_t(width * bins_per_metre_) + 1;
    rows_ = std::uint32_t(height * bins_per_metre_) + 1;
    starts_.assign(std::size_t{cols_} * rows_ + 1, 0);
    const auto visit_bins = [&](const BinRange& bins, const auto& visit) {
        for (std::size_t row = bins.first_row; row <= bins.last_row; ++row)
            for (std::size_t col = bins.first_col; col <= bins.last_col; ++col) visit(starts_[row * cols_ + col]);
    };
    // A counting sort: first the number of entries of each bin, then where they end, which falls to where they begin.
    for (Binned& tile : binned_) {
        const auto& [x, y, z] = tile.limits;
        tile.bins = bins_of(Two{x[0], -x[1]}, Two{y[0], -y[1]});
        visit_bins(tile.bins, [](std::uint32_t& count) { ++count; });
    }
    for (std::size_t bin = 1; bin < starts_.size(); ++bin) starts_[bin] += starts_[bin - 1];
    entries_.resize(starts_.back());
    for (std::uint32_t tile = 0; tile < binned_.size(); ++tile)
        visit_bins(binned_[tile].bins, [&](std::uint32_t& end) { entries_[--end] = tile; });
    is_binned_ = true;
}

}  // namespace spawnfield

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

NearTiles::BinRange NearTiles::bins_of(double low_x, double low_y, double high_x, double high_y) const
{
    const auto bin = [this](double from_corner, std::uint32_t count) {
        return std::uint32_t(std::clamp(from_corner * bins_per_metre_, 0.0, double(count - 1)));
    };
    return {bin(low_x - expected_->low_x, cols_), bin(high_x - expected_->low_x, cols_),
            bin(low_y - expected_->low_y, rows_), bin(high_y - expected_->low_y, rows_)};
}

/// Puts the tiles of the expected rectangle into bins of the size that a tile has on average.
void NearTiles::bin_expected()
{
    const Rect& area = *expected_;
    std::vector<ElementBox> boxes;
    binned_.clear();
    geometry_.visit_tiles(area.low_x, area.low_y, area.high_x, area.high_y,
                          [&](const Tile& tile, const ElementBox& box) {
                              binned_.push_back(tile);
                              boxes.push_back(box);
                          });
    const double width = area.high_x - area.low_x, height = area.high_y - area.low_y;
    constexpr double most = 64;  // bins along a side
    bins_per_metre_ = std::min(std::sqrt(double(boxes.size()) / (width * height)), most / std::max(width, height));
    cols_ = std::uint32_t(width * bins_per_metre_) + 1;
    rows_ = std::uint32_t(height * bins_per_metre_) + 1;
    starts_.assign(std::size_t{cols_} * rows_ + 1, 0);
    const auto visit_bins = [&](const ElementBox& box, const auto& visit) {
        const BinRange bins = bins_of(box.min[0], box.min[1], box.max[0], box.max[1]);
        for (std::uint32_t row = bins.first_row; row <= bins.last_row; ++row)
            for (std::uint32_t col = bins.first_col; col <= bins.last_col; ++col)
                visit(starts_[std::size_t{row} * cols_ + col], bins);
    };
    // A counting sort: first the number of entries of each bin, then where they end, which falls to where they begin.
    for (const ElementBox& box : boxes) visit_bins(box, [](std::uint32_t& count, const BinRange&) { ++count; });
    for (std::size_t bin = 1; bin < starts_.size(); ++bin) starts_[bin] += starts_[bin - 1];
    entries_.resize(starts_.back());
    for (std::uint32_t tile = 0; tile < boxes.size(); ++tile)
        visit_bins(boxes[tile], [&](std::uint32_t& end, const BinRange& bins) {
            entries_[--end] = {boxes[tile], tile, std::uint16_t(bins.first_col), std::uint16_t(bins.first_row)};
        });
    is_binned_ = true;
}

}  // namespace spawnfield

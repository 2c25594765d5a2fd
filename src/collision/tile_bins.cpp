#include "collision/tile_bins.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {

void TileBins::find(const Bounds& area)
{
    area_ = area;
    binned_.clear();
    found_.clear();
    opened_.clear();
    probable_ = 0;
    geometry_.find_tiles(area, [&](const Forest& forest, std::size_t tree, std::size_t tile, const ElementBox& box) {
        binned_.push_back({limits_of(box), {}});
        found_.push_back({&forest, std::uint32_t(tree), std::uint32_t(tile)});
    });
    fill_bins();
}

/// Returns the bins that a box meets. Both ranges are from the smallest to the largest coordinate, m. The bins at the
/// rim also have what is beyond.
TileBins::BinRange TileBins::bins_of(const Two& x, const Two& y) const
{
    const Two first{}, last_col = both(cols_ - 1), last_row = both(rows_ - 1);
    const Two cols = least(greatest((x - area_.min.x()) * bins_per_metre_, first), last_col),
              rows = least(greatest((y - area_.min.y()) * bins_per_metre_, first), last_row);
    return {std::uint16_t(cols[0]), std::uint16_t(cols[1]), std::uint16_t(rows[0]), std::uint16_t(rows[1])};
}

/// Puts the tiles into bins of the size that a tile has on average.
void TileBins::fill_bins()
{
    const double width = area_.max.x() - area_.min.x(), height = area_.max.y() - area_.min.y();
    constexpr double most = 64;      // bins along a side
    constexpr std::size_t few = 16;  // tiles; one bin for all of them takes less time
    bins_per_metre_ = 0;
    cols_ = rows_ = 1;
    if (binned_.size() > few && width * height > 0 && std::isfinite(width * height)) {
        bins_per_metre_ = std::min(std::sqrt(double(binned_.size()) / (width * height)),
                                   most / std::max(width, height));
        cols_ = std::uint32_t(width * bins_per_metre_) + 1;
        rows_ = std::uint32_t(height * bins_per_metre_) + 1;
    }
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
}

}  // namespace spawnfield

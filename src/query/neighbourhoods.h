#pragma once

#include "base/rect.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace spawnfield {

/// Returns the indices of places (x, y), m, in an order in which most neighbours follow each other, so that they use
/// the same tiles in the cache. Counting sort over a grid around the places: square blocks of bins follow each other
/// row by row, and so do the bins of a block.
inline std::vector<std::uint32_t> in_neighbourhoods(std::span<const Vec2> places)
{
    const Rect around = places.empty() ? Rect{} : rect_around(places);
    constexpr std::size_t block = 8;  // bins along its side
    const auto blocks = std::size_t(std::clamp(std::sqrt(double(places.size())) / block, 1.0, 128.0)),
               side = blocks * block;
    const auto along = [&](double at, double low, double high) {
        const double share = (at - low) / (high - low);
        return share > 0 ? std::size_t(std::min(share, 1.0) * double(side - 1)) : 0;  // also if the share is NaN
    };
    const auto bin_of = [&](const Vec2& place) {
        const std::size_t row = along(place.y(), around.low_y, around.high_y),
                          col = along(place.x(), around.low_x, around.high_x);
        return ((row / block * blocks + col / block) * block + row % block) * block + col % block;
    };
    std::vector<std::uint32_t> bins(places.size()), next(side * side + 1), order(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) ++next[(bins[i] = std::uint32_t(bin_of(places[i]))) + 1];
    for (std::size_t bin = 1; bin < next.size(); ++bin) next[bin] += next[bin - 1];
    for (std::size_t i = 0; i < places.size(); ++i) order[next[bins[i]]++] = std::uint32_t(i);
    return order;
}

}  // namespace spawnfield

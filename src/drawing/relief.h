#pragma once

#include "drawing/picture.h"
#include "picture/gradient.h"

#include <spawnfield/terrain.h>

namespace spawnfield {

/// Returns the index of the cell that contains `distance` from the beginning of a row of n cells with side 1, both ends
/// included; -1 if it is beyond the row.
int cell_index(double distance, int n);

/// Returns how much brighter or darker than level ground each pixel of a view is in light from the north-west: -1 to 1,
/// and 0 where there is no height. Gentle relief is exaggerated. O(cells in the view + pixels).
cv::Mat_<float> relief(const GridFrame& frame, const HeightImage& heights, const View& view, cv::Size pixels);

/// Returns a colour in this light. Level ground (light 0) keeps its colour. At depth 1, light 1 mixes it with 15 %
/// white, and light -1 reduces it to 65 %.
inline Colour shaded(Colour colour, float light, float depth = 1)
{
    const float darker = light < 0 ? -0.35f * light * depth : 0, whiter = light > 0 ? 0.15f * light * depth : 0;
    const auto channel = [&](int c) {
        return static_cast<std::uint8_t>(static_cast<float>(colour[c]) * (1 - darker - whiter) + 255 * whiter + 0.5f);
    };
    return {channel(0), channel(1), channel(2)};
}

}  // namespace spawnfield

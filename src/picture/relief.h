#pragma once

#include "picture/picture.h"

#include <spawnfield/terrain.h>

namespace spawnfield {

/// Index of the cell of side 1 in a row of n that holds `distance` from its beginning, both ends included; -1 if none
/// does.
int cell_index(double distance, int n);

/// Change of height with x and with y at a cell; one-sided where a neighbour has no height, 0 where both have none. NaN
/// at a cell that has no height itself.
Eigen::Vector2d gradient(const HeightImage& heights, int row, int col, double cell);

/// How much brighter or darker than level ground the light from the north-west makes each pixel of a view: -1 to 1, 0
/// where there is no height. Gentle relief is exaggerated. O(cells in the view + pixels).
cv::Mat_<float> relief(const GridFrame& frame, const HeightImage& heights, const View& view, cv::Size pixels);

/// Level ground keeps its colour; at full depth the brightest is mixed with 15 % white, the darkest has 65 % of it.
inline Colour shaded(Colour colour, float light, float depth = 1)
{
    const float darker = light < 0 ? -0.35f * light * depth : 0, whiter = light > 0 ? 0.15f * light * depth : 0;
    const auto channel = [&](int c) {
        return static_cast<std::uint8_t>(static_cast<float>(colour[c]) * (1 - darker - whiter) + 255 * whiter + 0.5f);
    };
    return {channel(0), channel(1), channel(2)};
}

}  // namespace spawnfield

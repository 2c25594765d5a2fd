#pragma once

#include <cstdint>
#include <vector>

namespace spawnfield {

constexpr std::uint64_t max_pixels = std::uint64_t(1) << 30;  ///< default limit for an image

/// An image of one channel. Row 0 is at the top.
struct GreyImage {
    int rows = 0, cols = 0;
    /// Value of white in an unsigned image: 255 or 65535. 0: pixels are plain numbers (float, signed or 32 bits).
    double largest = 0;
    std::vector<double> pixels;  ///< row after row
    bool zero_is_white = false;  ///< viewers show 0 as white and `largest` as black (TIFF's MINISWHITE)
    bool is_float32 = false;
};

}  // namespace spawnfield

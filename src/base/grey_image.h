#pragma once

#include <cstdint>
#include <vector>

namespace spawnfield {

constexpr std::uint64_t max_pixels = std::uint64_t(1) << 30;  ///< that an image may have

/// One channel, rows from the top.
struct GreyImage {
    int rows = 0, cols = 0;
    double largest = 0;  ///< what white is in an unsigned image: 255 or 65535; 0: values stand for themselves (float,
                         ///< signed, 32 bits)
    std::vector<double> pixels;
    bool zero_is_white = false;  ///< a viewer shows largest as black (TIFF's MINISWHITE)
    bool is_float32 = false;
};

}  // namespace spawnfield

#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace spawnfield {

/// Returns the largest float that is not above value.
inline float rounded_down(double value)
{
    const float nearest = float(value);
    const bool is_above = double(nearest) > value;
    // Faster than std::nextafter: the bits of a float count its magnitude. Zero and infinity are left to it.
    if (nearest == 0 || nearest > std::numeric_limits<float>::max()) [[unlikely]]
        return is_above ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
    // Without a branch, because every second value is rounded up, and no processor can predict which one.
    const auto bits = std::bit_cast<std::int32_t>(nearest);
    const std::int32_t down = bits < 0 ? 1 : -1;
    return std::bit_cast<float>(bits + down * std::int32_t(is_above));
}

/// Returns the smallest float that is not below value.
inline float rounded_up(double value) { return -rounded_down(-value); }

}  // namespace spawnfield

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
    if (!(double(nearest) > value)) return nearest;
    // Faster than std::nextafter: the bits of a float count its magnitude. Zero and infinity are left to it.
    if (nearest == 0 || nearest > std::numeric_limits<float>::max())
        return std::nextafter(nearest, -std::numeric_limits<float>::infinity());
    return std::bit_cast<float>(std::bit_cast<std::int32_t>(nearest) + (nearest > 0 ? -1 : 1));
}

/// Returns the smallest float that is not below value.
inline float rounded_up(double value) { return -rounded_down(-value); }

}  // namespace spawnfield

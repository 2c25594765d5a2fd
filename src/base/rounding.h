#pragma once

#include <cmath>
#include <limits>

namespace spawnfield {

/// Returns the largest float that is not above value.
inline float rounded_down(double value)
{
    const float nearest = float(value);
    return double(nearest) > value ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}

/// Returns the smallest float that is not below value.
inline float rounded_up(double value) { return -rounded_down(-value); }

}  // namespace spawnfield

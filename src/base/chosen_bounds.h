#pragma once

#include <spawnfield/error.h>
#include <spawnfield/types.h>

#include <cmath>

namespace spawnfield {

/// Returns the bounds that a caller chose, or `fallback` if `wanted` is a default Bounds. Only the first `axes` axes
/// are chosen; the others are those of `fallback`. Throws ArgumentError unless the chosen numbers are finite and each
/// minimum is at most the maximum.
inline Bounds chosen_bounds(const char* function, const Bounds& wanted, const Bounds& fallback, int axes = 3)
{
    const Bounds unset;
    if (wanted.min == unset.min && wanted.max == unset.max) return fallback;
    Bounds out = fallback;
    for (int axis = 0; axis < axes; ++axis) {
        const std::string letter(1, "xyz"[axis]);
        out.min[axis] = wanted.min[axis];
        out.max[axis] = wanted.max[axis];
        if (!std::isfinite(out.min[axis]))
            throw ArgumentError(function, "bounds.min." + letter, out.min[axis], "a finite number, m");
        if (!std::isfinite(out.max[axis]))
            throw ArgumentError(function, "bounds.max." + letter, out.max[axis], "a finite number, m");
        if (out.max[axis] < out.min[axis])
            throw ArgumentError(function, "bounds.max." + letter, out.max[axis], "at least bounds.min." + letter);
    }
    return out;
}

}  // namespace spawnfield

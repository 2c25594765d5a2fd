#pragma once

#include "catch.h"

#include <spawnfield/types.h>

inline void check_bounds(const spawnfield::Bounds& bounds, const spawnfield::Vec3& min, const spawnfield::Vec3& max,
                         double margin = 1e-9)
{
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(bounds.min[axis] == Approx(min[axis]).margin(margin));
        CHECK(bounds.max[axis] == Approx(max[axis]).margin(margin));
    }
}

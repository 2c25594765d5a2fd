#pragma once

#include "test_map.h"

// Functions with which the tests of exactness use the free-space mask.

/// Returns a map with a mask of this resolution. Poses beyond the bounds are `outside`, but solids there still collide.
inline TestMap map_at(spawnfield::Scene scene, double resolution, const spawnfield::Bounds& bounds = {})
{
    return map_of(std::move(scene), resolution, bounds);
}

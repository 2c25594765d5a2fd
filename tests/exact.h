#pragma once

#include "test_map.h"

// What the tests of exactness need to know of the free-space mask, in one place.

/// A scene with a mask of this resolution. Poses beyond the bounds are `outside`, solids there still count.
inline TestMap map_at(spawnfield::Scene scene, double resolution, const spawnfield::Bounds& bounds = {})
{
    return map_of(std::move(scene), resolution, bounds);
}

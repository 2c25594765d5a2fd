#pragma once

#include "island.h"
#include "world.h"

namespace worlds {

/// Regions 16 to 80 m across: car, fence_and_water, bridge, houses, shore. Parts are known by their names' beginnings.
std::vector<Landmark> complex_landmarks(const spawnfield::Scene& scene, const Island& island);

}  // namespace worlds

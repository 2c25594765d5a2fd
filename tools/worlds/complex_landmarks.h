#pragma once

#include "island.h"
#include "world.h"

namespace worlds {

/// Returns five regions, 16 to 80 m across: car, fence_and_water, bridge, houses, shore. Finds parts by the beginnings
/// of their names.
std::vector<Landmark> complex_landmarks(const spawnfield::Scene& scene, const Island& island);

}  // namespace worlds

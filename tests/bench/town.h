#pragma once

#include <spawnfield/scene.h>

namespace bench {

/// A town of 1.28 x 1.28 km from the origin to +x and +y, about a million triangles, on a coast that leaves half of it
/// under water: streets with raised pavements, closed houses with recesses, cars, fences, trees, and a bridge whose
/// deck is terrain on piers that are obstacles.
///
/// Same seed, same scene.
spawnfield::Scene town_scene(std::uint64_t seed = 1);

/// The same on 240 x 240 m, for quick runs.
spawnfield::Scene small_town_scene(std::uint64_t seed = 1);

}  // namespace bench

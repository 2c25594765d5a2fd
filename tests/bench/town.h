#pragma once

#include <spawnfield/scene.h>

namespace bench {

/// Returns a town of 1.28 x 1.28 km, from the origin to +x and +y, with about a million triangles. It lies on a coast,
/// and half of the square is under water. It has streets with raised pavements, closed houses with recesses, cars,
/// fences, trees, and a bridge whose deck is terrain and whose piers are obstacles.
///
/// The same seed gives the same scene.
spawnfield::Scene town_scene(std::uint64_t seed = 1);

/// Returns the same on 240 x 240 m, for quick runs.
spawnfield::Scene small_town_scene(std::uint64_t seed = 1);

}  // namespace bench

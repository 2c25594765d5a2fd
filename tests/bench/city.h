#pragma once

#include <spawnfield/scene.h>

namespace bench {

/// Returns a city on a plane of 500 x 500 m, from the origin to +x and +y, with about 380,000 triangles. In its middle,
/// 600 bodies stand on a built-up area of 330 x 270 m: houses (boxes and closed meshes with recesses), pavements with
/// kerbs, trees, cars, a car park with two decks, foot bridges and lamps. A second terrain sheet covers the built-up
/// area 6 cm above the plane, so that there the ground has two layers everywhere.
///
/// The same seed gives the same scene.
spawnfield::Scene city_scene(std::uint64_t seed = 1);

/// Returns the same with four blocks and 85 bodies on a plane of 160 x 160 m, for quick runs.
spawnfield::Scene small_city_scene(std::uint64_t seed = 1);

}  // namespace bench

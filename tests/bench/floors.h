#pragma once

#include <spawnfield/scene.h>

namespace bench {

/// Returns a building of 40 x 30 m, from the origin to +x and +y, with four storeys of 3 m and a roof with a parapet.
/// Slabs and ramps are terrain. Walls with doors and windows (one closed mesh per storey) and furniture are obstacles.
///
/// The same seed gives the same scene.
spawnfield::Scene floors_scene(std::uint64_t seed = 1);

}  // namespace bench

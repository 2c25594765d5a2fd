#pragma once

#include <spawnfield/scene.h>

namespace bench {

/// A building of 40 x 30 m from the origin to +x and +y, four storeys of 3 m and a roof with a parapet: slabs and ramps
/// are terrain; walls with doors and windows, closed as one mesh a storey, and furniture are obstacles.
///
/// Same seed, same scene.
spawnfield::Scene floors_scene(std::uint64_t seed = 1);

}  // namespace bench

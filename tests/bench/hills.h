#pragma once

#include <spawnfield/scene.h>

namespace bench {

/// Returns a landscape of 500 x 500 m with 75 m of relief, from the origin to +x and +y: a terrain sheet of 524,288
/// triangles, a lake, and 2,000 obstacles with about 155,000 triangles (closed houses in villages, trees, thin fences,
/// cars, rocks).
///
/// The same seed gives the same scene (SplitMix64). `tiles` x `tiles` equal copies stand side by side without seams;
/// tiles >= 1.
spawnfield::Scene hills_scene(std::uint64_t seed = 1, int tiles = 1);

/// Returns the same on 125 x 125 m with a sixteenth of everything, for quick runs.
spawnfield::Scene small_hills_scene(std::uint64_t seed = 1, int tiles = 1);

}  // namespace bench

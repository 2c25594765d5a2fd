#pragma once

#include <spawnfield/scene.h>

namespace bench {

/// A landscape of 500 x 500 m and 75 m of relief from the origin to +x and +y: a terrain sheet of 524,288 triangles, a
/// lake, and 2,000 obstacles of about 155,000 triangles: closed houses in villages, trees, thin fences, cars, rocks.
///
/// Same seed, same scene, from SplitMix64. `tiles` x `tiles` equal copies stand side by side, seamless; tiles >= 1.
spawnfield::Scene hills_scene(std::uint64_t seed = 1, int tiles = 1);

/// The same on 125 x 125 m with a sixteenth of all, for quick runs.
spawnfield::Scene small_hills_scene(std::uint64_t seed = 1, int tiles = 1);

}  // namespace bench

#pragma once

#include <spawnfield/query.h>

namespace bench {

/// Returns the map that baking the scene at this resolution (m) and reading it would give, but without files.
spawnfield::Map map_of(const spawnfield::Scene& scene, const spawnfield::Bounds& bounds, double cell);

}  // namespace bench

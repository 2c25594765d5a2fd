#pragma once

#include <spawnfield/query.h>

namespace bench {

/// What a bake of the scene at this resolution (m) and its reading give, without files.
spawnfield::Map map_of(const spawnfield::Scene& scene, const spawnfield::Bounds& bounds, double cell);

}  // namespace bench

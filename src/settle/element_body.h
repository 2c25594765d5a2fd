#pragma once

#include "geometry/tile.h"
#include "settle/convex.h"

namespace spawnfield {

/// Returns the body of an element of a tile, relative to an origin near it, so that its coordinates are precise.
Convex body_of(const Tile& tile, std::uint32_t element, const Vec3& origin);

}  // namespace spawnfield

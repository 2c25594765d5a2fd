#pragma once

#include "settle/convex.h"

namespace spawnfield {

/// Returns the shortest vector from a point of body a to a point of body b, m; 0 if they touch or overlap. Its length
/// is exact to about 1e-9 m. Both must lie near the origin, so that their coordinates are precise.
///
/// Source: Gilbert, Johnson, Keerthi, A fast procedure for computing the distance between complex objects, 1988. FCL
/// has this, too, but with a tolerance of 1e-6 m.
Vec3 shortest_way(const Convex& a, const Convex& b);

}  // namespace spawnfield

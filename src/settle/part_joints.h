#pragma once

#include "settle/convex.h"

#include <vector>

namespace spawnfield {

/// Returns segments that join parts of a robot between which there is a gap, so that all parts are one body. Uses the
/// parts' bounds. Source: Prim, Shortest connection networks and some generalizations, 1957.
std::vector<Convex> joints_of(const std::vector<Convex>& parts);

}  // namespace spawnfield

#pragma once

#include "world.h"

namespace worlds {

/// A bridge along its own x, its origin in the middle of its length at height 0 of the world.
struct BridgeSite {
    spawnfield::Pose world_from_bridge;
    double left_ground,
        right_ground;  ///< m, height of the road at its ends, x = -bridge_length / 2 and bridge_length / 2
    double bed;        ///< m, lowest ground under it
    double deck;       ///< m, top of its level middle
};

inline constexpr double bridge_length = 100, bridge_half_width = 3.5;  // m
inline constexpr double frame_top = 3.6;                               ///< m above the deck

/// Ramps of earth and a level deck, pillars under it, railings beside it and frames over it that a Husky passes under.
void add_bridge(spawnfield::Scene& scene, const BridgeSite& site, Bridge bridge);

}  // namespace worlds

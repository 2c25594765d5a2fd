#pragma once

#include "world.h"

namespace worlds {

/// Place of a bridge. The bridge runs along its own x; its origin is in the middle of its length, at height 0 of the
/// world.
struct BridgeSite {
    spawnfield::Pose world_from_bridge;
    double left_ground;   ///< m, height of the road at the end at x = -bridge_length / 2
    double right_ground;  ///< m, height of the road at the end at x = bridge_length / 2
    double bed;           ///< m, lowest ground under the bridge
    double deck;          ///< m, top of the level middle
};

inline constexpr double bridge_length = 100, bridge_half_width = 3.5;  // m
inline constexpr double frame_top = 3.6;                               ///< m above the deck

/// Adds a bridge: ramps of earth, a level deck, pillars under it, railings beside it and frames over it. A Husky fits
/// under the frames.
void add_bridge(spawnfield::Scene& scene, const BridgeSite& site, Bridge bridge);

}  // namespace worlds

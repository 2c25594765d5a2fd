#pragma once

#include <spawnfield/reach.h>
#include <spawnfield/query.h>

#include <vector>

namespace spawnfield {

inline constexpr std::int32_t no_island = -1;

/// Returns the number of the island of each pose of a raster, as ReachGraph::island_of(); no_island for a pose that is
/// not valid, and for one from which the robot can go nowhere. The judge must be that of the graph and of the raster.
/// Lets the robot down again at each valid pose. Throws ArgumentError unless the raster has settled poses at one yaw
/// each (RasterResult::rests).
SPAWNFIELD_API std::vector<std::int32_t> islands_of(const ReachGraph& graph, const Judge& judge,
                                                    const RasterResult& raster, const RunOptions& options = {});

}  // namespace spawnfield

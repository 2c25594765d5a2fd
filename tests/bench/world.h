#pragma once

#include <spawnfield/query.h>

namespace bench {

/// All that the benchmark knows of how a Map holds its scene: only this file's .cpp names those fields.
spawnfield::Map map_of(spawnfield::Scene scene, const spawnfield::Bounds& bounds, double cell);
spawnfield::CollisionChecker checker_of(const spawnfield::Map& map, const spawnfield::Robot& robot);

/// Heights of the terrain layers, from the top down, m.
std::vector<double> layers_at(const spawnfield::Map& map, double x, double y);

std::uint64_t digest_of_index(const spawnfield::Map& map);
std::uint64_t rebuilt_index(const spawnfield::Map& map);  ///< its triangles and primitives binned anew: their number
spawnfield::TerrainMap terrain_of(const spawnfield::Map& map, const spawnfield::GridFrame& frame, int threads);
spawnfield::OccupancyTree occupancy_of(const spawnfield::Map& map, double voxel, int threads);
spawnfield::Scene scene_of(const spawnfield::Map& map);

}  // namespace bench

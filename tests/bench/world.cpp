#include "world.h"

#include "digest.h"

using namespace spawnfield;

namespace bench {

Map map_of(Scene scene, const Bounds& bounds, double cell)
{
    Map map;
    map.name = scene.name;
    map.scene = std::move(scene);
    map.bounds = bounds.is_empty() ? map.scene.bounds() : bounds;
    map.index = build_column_index(map.scene);
    map.resolution = cell;
    if (!map.scene.has_terrain()) return map;
    const double size = (map.bounds.max - map.bounds.min).head<2>().maxCoeff();
    map.layers = terrain_of(map, frame_around(map.bounds, size / 256), 0).layers();
    return map;
}

CollisionChecker checker_of(const Map& map, const Robot& robot) { return {map.scene, map.index, robot}; }

std::vector<double> layers_at(const Map& map, double x, double y) { return column_at(map.scene, map.index, x, y).layers; }

std::uint64_t digest_of_index(const Map& map) { return digest_of(map.index); }

std::uint64_t rebuilt_index(const Map& map)
{
    build_column_index(map.scene);
    return map.scene.triangles.size() + map.scene.primitives.size();
}

TerrainMap terrain_of(const Map& map, const GridFrame& frame, int threads)
{
    return rasterize_terrain(map.scene, map.index, frame, threads);
}

OccupancyTree occupancy_of(const Map& map, double voxel, int threads)
{
    return build_occupancy(map.scene, map.index, map.bounds, voxel, threads);
}

Scene scene_of(const Map& map) { return map.scene; }

}  // namespace bench

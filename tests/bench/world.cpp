#include "world.h"

using namespace spawnfield;

namespace bench {

Map map_of(const Scene& scene, const Bounds& bounds, double cell)
{
    Map map;
    map.name = scene.name;
    map.bounds = bounds.is_empty() ? scene.bounds() : bounds;
    map.resolution = cell;
    map.geometry = Geometry(scene);
    map.solid_bounds = SolidBounds(map.geometry, map.bounds, cell);
    if (!scene.has_terrain()) return map;
    const double size = (map.bounds.max - map.bounds.min).head<2>().maxCoeff();
    map.layers = rasterize_terrain(map.geometry, frame_around(map.bounds, size / 256)).layers();
    return map;
}

}  // namespace bench

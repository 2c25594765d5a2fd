#include "settle/element_body.h"

namespace spawnfield {

Convex body_of(const Tile& tile, std::uint32_t element, const Vec3& origin)
{
    if (!tile.is_triangle(element))
        return moved(convex_of(tile.primitive(element).shape()), {-origin, Mat3::Identity()});
    std::array<Vec3, 3> corners = tile.corners(element);
    for (Vec3& corner : corners) corner -= origin;
    return convex_of(corners);
}

}  // namespace spawnfield

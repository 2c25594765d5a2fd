#include "collision/near_tiles.h"

#include <limits>

namespace spawnfield {
namespace {

bool contains(const Bounds& outer, const Bounds& inner)
{
    return (outer.min.array() <= inner.min.array()).all() && (outer.max.array() >= inner.max.array()).all();
}

/// Returns the box, grown on each side by three of its own lengths: the poses of a raster are that near to each other.
Bounds neighbourhood(const Bounds& box)
{
    constexpr double reach = 3;
    const Vec3 by = reach * (box.max - box.min);
    return {box.min - by, box.max + by};
}

}  // namespace

void NearTiles::expect(const Rect& area)
{
    constexpr double inf = std::numeric_limits<double>::infinity();
    expected_ = {{area.low_x, area.low_y, -inf}, {area.high_x, area.high_y, inf}};
    is_found_ = false;
}

/// Returns the tiles that meet a box, and others near it.
TileBins& NearTiles::tiles_around(const Bounds& space)
{
    if (contains(expected_, space)) {
        if (!is_found_) in_expected_.find(expected_);
        is_found_ = true;
        return in_expected_;
    }
    if (!contains(near_last_.area(), space))
        near_last_.find(contains(neighbourhood(last_), space) ? neighbourhood(space) : space);
    last_ = space;
    return near_last_;
}

}  // namespace spawnfield

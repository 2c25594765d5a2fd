#pragma once

#include <spawnfield/geometry.h>

namespace spawnfield {

/// Returns whether no terrain or obstacle touches the straight line between two points, m. Water does not count. The
/// inside of a mesh does not count either, only its surface. A triangle in whose plane the line lies is not touched.
bool is_clear_line(const Geometry& geometry, const Vec3& from, const Vec3& to);

}  // namespace spawnfield

#pragma once

#include "base/polygon2.h"

#include <limits>

namespace spawnfield {

/// The edge of a polygon that is nearest to a point.
struct NearestEdge {
    double distance = std::numeric_limits<double>::infinity();  ///< negative: the point is outside
    Vec2 outward = Vec2::Zero();                                ///< normal of the edge, of length 1
    Vec2 from = Vec2::Zero(), to = Vec2::Zero();                ///< its ends
};

/// Returns the nearest edge of a convex polygon (counterclockwise, 2 or more corners; two are a line with two sides).
NearestEdge nearest_edge(const Polygon2& polygon, const Vec2& point);

/// Returns a convex polygon without corners that are there only by rounding: those very near to another corner or to
/// the line between their neighbours.
Polygon2 clear_corners(const Polygon2& polygon);

}  // namespace spawnfield

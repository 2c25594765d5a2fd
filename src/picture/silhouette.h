#pragma once

#include "base/polygon2.h"

#include <spawnfield/robot.h>

namespace spawnfield {

/// What a parallel view shows to the right and upwards: unit vectors in the robot's frame.
struct ViewAxes {
    Vec3 u, v;
};

inline const ViewAxes view_from_above{Vec3::UnitX(), Vec3::UnitY()};

/// Outline of a part in a view, m. Circles become polygons of 64 corners around them.
Polygon2 silhouette(const RobotPart& part, const ViewAxes& axes);

}  // namespace spawnfield

#pragma once

#include "base/polygon2.h"

#include <spawnfield/robot.h>

namespace spawnfield {

/// The axes of a parallel view, u to the right and v upwards: unit vectors in the robot's frame.
struct ViewAxes {
    Vec3 u, v;
};

inline const ViewAxes view_from_above{Vec3::UnitX(), Vec3::UnitY()};

/// Returns the outline of a part in a view, m. Circles are replaced by polygons of 64 corners around them.
SPAWNFIELD_MODULE_API Polygon2 silhouette(const RobotPart& part, const ViewAxes& axes);

}  // namespace spawnfield

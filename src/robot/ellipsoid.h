#pragma once

#include <spawnfield/robot.h>

namespace spawnfield {

/// Returns a polyhedron of 320 triangles that contains the ellipsoid with these half axes (m, > 0). Its faces touch the
/// ellipsoid or lie just outside. It is needed because FCL cannot test ellipsoids against triangles.
RobotPart ellipsoid_hull(const Vec3& radii, const Pose& robot_from_ellipsoid);

/// Returns how much larger the hull is than the ellipsoid, as a share of the ellipsoid's volume.
double ellipsoid_growth(const RobotPart& hull, const Vec3& radii);

}  // namespace spawnfield

#pragma once

#include <spawnfield/robot.h>

namespace spawnfield {

/// A polyhedron of 320 triangles that holds the ellipsoid of these half axes (m, > 0): FCL has no test of ellipsoids
/// with triangles. Its faces touch the ellipsoid or lie just outside.
RobotPart ellipsoid_hull(const Vec3& radii, const Pose& robot_from_ellipsoid);

/// How much larger the hull is, as a share of the ellipsoid's volume.
double ellipsoid_growth(const RobotPart& hull, const Vec3& radii);

}  // namespace spawnfield

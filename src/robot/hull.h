#pragma once

#include <spawnfield/robot.h>

namespace spawnfield {

/// Largest distance of a robot's points from its origin, m. The largest machines that drive are 200 m long, and at much
/// larger distances rounding exceeds 1e-6 m.
inline constexpr double farthest_robot_point = 1000;

/// Returns the convex hull of the points as a robot part, in the frame of the points. Throws std::domain_error if it
/// has no volume. Source: Barber, Dobkin, Huhdanpaa, The Quickhull algorithm for convex hulls, 1996 (libqhull).
RobotPart convex_hull(const std::vector<Vec3>& points);

/// Returns the part with its surface moved outwards by at least `margin` (m, > 0). A hull grows by a cube of that half
/// side (Minkowski sum), so by up to sqrt(3) * margin at corners. All other shapes grow in their dimensions.
RobotPart grown(const RobotPart& part, double margin);

}  // namespace spawnfield

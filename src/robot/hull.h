#pragma once

#include <spawnfield/robot.h>

namespace spawnfield {

/// A robot's farthest point from its origin, m: the largest machines that drive are 200 m long, and far beyond that
/// distances have no 1e-6 m left.
inline constexpr double farthest_robot_point = 1000;

/// Convex hull of the points, as a robot part in their frame. Throws std::domain_error if it has no volume.
/// Source: Barber, Dobkin, Huhdanpaa, The Quickhull algorithm for convex hulls, 1996 (libqhull).
RobotPart convex_hull(const std::vector<Vec3>& points);

/// The part with its surface moved outwards by at least margin (m, > 0): hulls by a cube of that half side (Minkowski
/// sum), so by up to sqrt(3) times as much at corners; all others by their dimensions.
RobotPart grown(const RobotPart& part, double margin);

}  // namespace spawnfield

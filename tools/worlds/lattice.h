#pragma once

#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

namespace worlds {

/// Returns a scene of cols x rows x heights boxes without any ground. They are 1 m apart, the first at the origin, and
/// 0.2 to 0.4 m across. A robot that is less than 0.5 m long from its origin meets exactly one of them at each lattice
/// point.
spawnfield::Scene grid_of_boxes(int cols, int rows, int heights, std::uint64_t seed = 1);

/// Returns the same with closed convex meshes of 80 triangles each.
spawnfield::Scene grid_of_balls(int cols, int rows, int heights, std::uint64_t seed = 1);

spawnfield::Scene empty_scene();  ///< without any part

/// Returns an ellipsoid of 224 triangles, as large as the Husky's box.
spawnfield::Robot hull_robot();

}  // namespace worlds

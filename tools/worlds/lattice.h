#pragma once

#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

namespace worlds {

/// cols x rows x heights obstacles 1 m apart in the open, the first at the origin: nothing that casts ground. Each is
/// 0.2 to 0.4 m across; a robot that is less than 0.5 m long from its origin meets one at each lattice point.
spawnfield::Scene grid_of_boxes(int cols, int rows, int heights, std::uint64_t seed = 1);

/// The same of closed convex meshes, 80 triangles each.
spawnfield::Scene grid_of_balls(int cols, int rows, int heights, std::uint64_t seed = 1);

spawnfield::Scene empty_scene();  ///< nothing at all

/// An ellipsoid as large as the Husky's box, of 224 triangles.
spawnfield::Robot hull_robot();

}  // namespace worlds

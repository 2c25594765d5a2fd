#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <spawnfield/robot.h>

namespace spawnfield {

/// Appends what stands for a collision of a URDF or SDF file: a shape, a polyhedron around an ellipsoid, or up to
/// `most_parts` convex parts that hold a mesh. The part's name is that of its link. Throws FileError for what no robot
/// can be made of, and for meshes that are not found or have no volume.
void append_body(Robot& robot, const CollisionBody& body, ModelPaths& paths, const std::string& file, int most_parts);

}  // namespace spawnfield

#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <spawnfield/robot.h>

namespace spawnfield {

/// Adds the parts for one collision of a URDF or SDF file to the robot: a shape, a polyhedron around an ellipsoid, or
/// up to RobotOptions::mesh_parts convex parts that contain a mesh. The parts get the name of their link. Throws
/// FileError for geometry that a robot cannot have, and for meshes that are not found or have no volume.
void append_body(Robot& robot, const CollisionBody& body, ModelPaths& paths, const std::string& file,
                 const RobotOptions& options);

}  // namespace spawnfield

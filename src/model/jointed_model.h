#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <spawnfield/joints.h>

namespace spawnfield {

/// All <collision> of a URDF or SDF model with its joints at given positions: a robot, or a world that is spawned as
/// one.
struct JointedModel {
    std::string name;
    std::vector<CollisionBody> bodies;  ///< named model, link, collision (which may be empty)
    std::vector<std::string> notices;
};

/// Reads a URDF, in the frame of its root link. Joints stand as given, all others at 0. Throws FileError, and
/// ArgumentError for joints.
JointedModel read_urdf_model(const std::filesystem::path& file, const std::vector<JointPosition>& joints);

/// Reads the <model> of an SDF file, in the model's frame: its own <pose> does not count. Joints stand as given, all
/// others at 0. Throws FileError, and ArgumentError for joints.
JointedModel read_sdf_model(const std::filesystem::path& file, ModelPaths& paths,
                            const std::vector<JointPosition>& joints);

}  // namespace spawnfield

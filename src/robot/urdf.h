#pragma once

#include "scene/collision_geometry.h"

#include <spawnfield/robot.h>

namespace spawnfield {

/// All <collision> of a URDF, in the root link's frame: a robot, or a world that is spawned as one.
struct UrdfModel {
    std::string name;
    std::vector<CollisionBody> bodies;  ///< named model, link, collision (which may be empty)
    std::vector<std::string> notices;
};

/// With joints as given, all others at 0. Throws FileError, and ArgumentError for joints.
UrdfModel read_urdf_model(const std::filesystem::path& file, const std::vector<JointPosition>& joints);

/// The union of <collision> of all links, in the root link's frame. Throws FileError, and ArgumentError for joints.
Robot read_urdf(const std::filesystem::path& file, const RobotOptions& options);

}  // namespace spawnfield

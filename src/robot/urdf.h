#pragma once

#include <spawnfield/robot.h>

namespace spawnfield {

/// The union of <collision> of all links at zero joint positions, in the root link's frame. Throws FileError.
Robot read_urdf(const std::filesystem::path& file, const RobotOptions& options);

}  // namespace spawnfield

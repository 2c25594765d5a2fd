#pragma once

#include <spawnfield/robot.h>

namespace spawnfield {

/// The union of <collision> of all links of the <model> in a .sdf file, or in the folder of its model.config, in the
/// model's frame; of its own <pose> nothing counts. Throws FileError, and ArgumentError for joints.
Robot read_sdf_robot(const std::filesystem::path& file_or_folder, const RobotOptions& options);

}  // namespace spawnfield

#pragma once

#include "model_path.h"

#include <spawnfield/robot.h>

namespace spawnfield::cli {

/// Options on how a robot's file is read.
struct RobotArgs : ModelPathArgs {
    std::vector<std::string> joints;
    int mesh_parts = 1;
};

/// Adds --joints and --mesh-parts.
void add_robot_options(CLI::App& command, RobotArgs& args);
inline const std::vector<std::string> robot_option_names{"--joints", "--mesh-parts"};

/// Throws ArgumentError.
RobotOptions robot_options(const RobotArgs& args);

}  // namespace spawnfield::cli

#pragma once

#include <spawnfield/robot.h>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace spawnfield::cli {

/// How a robot's file is read.
struct RobotArgs {
    std::vector<std::string> package_paths, model_paths, joints;
    int mesh_parts = 1;
};
void add_robot_options(CLI::App& command, RobotArgs& args);
inline const std::vector<std::string> robot_option_names{"--package-path", "--model-path", "--joints", "--mesh-parts"};

/// Throws ArgumentError.
RobotOptions robot_options(const RobotArgs& args);

}  // namespace spawnfield::cli

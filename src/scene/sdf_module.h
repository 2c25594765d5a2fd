#pragma once

#include "scene/sdf_model.h"

#include <spawnfield/robot.h>

/// What asks libsdformat is a module of its own (src/sdf), loaded when the first SDF file is read: libsdformat compiles
/// a regular expression in each of its files when it is loaded, 50 ms that every start of a program would pay.
namespace spawnfield::sdf_module {

SdfContent read_file(const std::filesystem::path& file, ModelPaths& paths, const std::optional<std::string>& text);
Robot read_robot(const std::filesystem::path& file_or_folder, const RobotOptions& options);

/// What the module's only symbol points to.
struct Functions {
    decltype(&read_file) file;
    decltype(&read_robot) robot;
};
inline constexpr const char* symbol = "spawnfield_sdf_functions";

}  // namespace spawnfield::sdf_module

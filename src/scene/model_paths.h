#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace spawnfield {

/// Folders that hold SDF models: those given, then those that Gazebo looks into (GZ_SIM_RESOURCE_PATH,
/// IGN_GAZEBO_RESOURCE_PATH, GAZEBO_MODEL_PATH, with colons between), then those above the file, the nearest first.
std::vector<std::filesystem::path> model_folders(const std::vector<std::filesystem::path>& given, const std::filesystem::path& file);

/// The file or folder that a URI of an SDF file means: model://NAME/REST and package://NAME/REST in the folders (NAME in one
/// of them), file://PATH, PATH from `base` on. Empty if it is not there.
std::filesystem::path find_uri(const std::string& uri, const std::filesystem::path& base, const std::vector<std::filesystem::path>& folders);

}  // namespace spawnfield

#pragma once

#include <filesystem>
#include <string>

namespace spawnfield {

/// Returns "ground_plane" or "sun" if the URI means this model of Gazebo, else "".
///
/// The name may be in upper or lower case, with spaces, underscores, hyphens or none of them: `model://ground_plane`,
/// `Ground Plane`, and on Fuel `https://HOST/1.0/OpenRobotics/models/Ground%20Plane`, with or without a version. On
/// Fuel, only models of the owner OpenRobotics count.
std::string built_in_model(const std::string& uri);

/// Returns the folder of the built-in models. It is installed beside the library.
std::filesystem::path built_in_folder();

/// Returns the SDF file of a built-in model.
/// Throws std::runtime_error if the installation lacks it.
std::filesystem::path built_in_file(const std::string& model);

}  // namespace spawnfield

#pragma once

#include <filesystem>
#include <string>

namespace spawnfield {

/// Returns "ground_plane" or "sun" if the URI means this model of Gazebo, else "".
///
/// The name may have any case, with spaces or underscores or without: `model://ground_plane`, `Ground Plane`, and on
/// Fuel `https://HOST/1.0/OpenRobotics/models/Ground%20Plane`, with or without a version. A model of another owner is
/// another model.
std::string built_in_model(const std::string& uri);

/// Returns the SDF file of a built-in model, which lies beside the library.
/// Throws std::runtime_error if the installation lacks it.
std::filesystem::path built_in_file(const std::string& model);

}  // namespace spawnfield

#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

namespace spawnfield {

/// Reads a nav2 or ROS map as a floor and walls. Throws FileError, ArgumentError.
Scene read_nav2_scene(const std::filesystem::path& file, const SceneOptions& options);

/// Reads a file that is the whole scene. Its extension decides: an elevation model, an OctoMap, or a mesh that assimp
/// reads. Throws FileError, ArgumentError.
Scene read_bare_scene(const std::filesystem::path& file, const SceneOptions& options);

}  // namespace spawnfield

#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

namespace spawnfield {

/// A nav2 or ROS map: a floor and walls. Throws FileError, ArgumentError.
Scene read_nav2_scene(const std::filesystem::path& file, const SceneOptions& options);

/// A file that is the whole scene, by its extension: an elevation model, an OctoMap, or a mesh that assimp reads.
/// Throws FileError, ArgumentError.
Scene read_bare_scene(const std::filesystem::path& file, const SceneOptions& options);

}  // namespace spawnfield

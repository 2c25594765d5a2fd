#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

namespace spawnfield {

/// Reads a Gazebo world or model, with all that it includes. Throws FileError.
Scene read_sdf_scene(const std::filesystem::path& file, const SceneOptions& options);

/// Reads a world that is spawned as a URDF, at the origin. Throws FileError.
Scene read_urdf_scene(const std::filesystem::path& file, const SceneOptions& options);

}  // namespace spawnfield

#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

namespace spawnfield {

/// Reads a scene.yaml (docs/input-files.md) and the files that its parts name. Throws FileError.
Scene read_scene_yaml(const std::filesystem::path& file, const SceneOptions& options);

}  // namespace spawnfield

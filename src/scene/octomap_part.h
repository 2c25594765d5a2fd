#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

namespace spawnfield {

/// Appends each occupied leaf of an OctoMap (.bt, or .ot of type OcTree) as a solid box. Throws FileError.
void append_octomap(Scene& scene, std::uint32_t part, const std::filesystem::path& file, const Pose& pose);

}  // namespace spawnfield

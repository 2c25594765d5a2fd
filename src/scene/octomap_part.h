#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

namespace spawnfield {

/// Appends each occupied leaf of an OctoMap (.bt, .ot) as a solid box of the part, which must be the scene's last. With
/// Unknown::Blocked, also appends the unknown space in the box around all known space, as obstacles of a new part
/// "NAME:unknown". Adds a notice with the size of the unknown space. With auto_slope (rad), the slope around a leaf
/// decides whether it is terrain or obstacle (octomap_ground.h). Throws FileError.
void append_octomap(Scene& scene, std::uint32_t part, const std::filesystem::path& file, const Pose& pose,
                    Unknown unknown, std::optional<double> auto_slope);

}  // namespace spawnfield

#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

namespace spawnfield {

/// Appends each occupied leaf of an OctoMap (.bt, .ot) as a solid box of the part, the scene's last; with
/// Unknown::Blocked also what it does not know within the box around all that it knows, as obstacles of a new part
/// "NAME:unknown". A notice tells how much that is. With auto_slope (rad) a leaf's label is terrain or obstacle by
/// the slope around it (octomap_ground.h). Throws FileError.
void append_octomap(Scene& scene, std::uint32_t part, const std::filesystem::path& file, const Pose& pose,
                    Unknown unknown, std::optional<double> auto_slope);

}  // namespace spawnfield

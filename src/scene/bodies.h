#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <spawnfield/scene.h>

namespace spawnfield {

/// Appends the collisions of an SDF or URDF world, a part for each, and labels them. Planes come last: they are cut to
/// what the rest needs. `missing` are notices, or errors where the options are strict; files that are not found join
/// them. Throws FileError.
void append_bodies(Scene& scene, const std::filesystem::path& file, std::vector<CollisionBody> bodies,
                   ModelPaths& paths, const SceneOptions& options, std::vector<std::string> missing);

}  // namespace spawnfield

#pragma once

#include "model/collision_geometry.h"
#include "model/model_paths.h"

#include <spawnfield/scene.h>

namespace spawnfield {

/// Appends the collisions of an SDF or URDF world, one part for each, and labels them. Planes come last, because their
/// size follows from the other geometry. `missing` are messages about missing content; files that are not found are
/// added to them. They become notices, or with `strict` options an error. Throws FileError.
void append_bodies(Scene& scene, const std::filesystem::path& file, std::vector<CollisionBody> bodies,
                   ModelPaths& paths, const SceneOptions& options, std::vector<std::string> missing);

}  // namespace spawnfield

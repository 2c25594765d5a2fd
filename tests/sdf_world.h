#pragma once

#include "temp_folder.h"

/// A scene.yaml in the folder that holds the collision shapes of an SDF world: boxes, spheres, cylinders, planes,
/// meshes and pavements (polylines), with includes from `models` (model://) at any depth. What has no file or another
/// shape is left out. Not faithful to Gazebo to the letter; enough to compare answers of two ways of asking in a world
/// of that size.
std::filesystem::path scene_of_world(const TempFolder& folder, const std::filesystem::path& world,
                                     const std::filesystem::path& models);

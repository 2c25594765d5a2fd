#pragma once

#include "temp_folder.h"

/// Writes a scene.yaml with the collision shapes of an SDF world into the folder and returns its path. It knows boxes,
/// spheres, cylinders, planes, meshes and pavements (polylines), with includes from `models` (model://) at any depth.
/// It leaves out other shapes and missing files. The result is not exactly what Gazebo has, but enough to compare two
/// answers in a world of that size.
std::filesystem::path scene_of_world(const TempFolder& folder, const std::filesystem::path& world,
                                     const std::filesystem::path& models);

#pragma once

#include "scene/collision_geometry.h"
#include "scene/heightmap.h"

namespace spawnfield {

/// Heights of a <heightmap> as Gazebo has them: the brightest pixel lies size.z above black, however bright it is
/// (gazebo::common::ImageHeightmap, HeightmapShape); between pixels, `sampling` - 1 samples are interpolated bilinearly.
/// Throws FileError.
Heightmap gazebo_heights(const std::filesystem::path& file, const CollisionGeometry& geometry);

}  // namespace spawnfield

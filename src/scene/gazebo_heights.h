#pragma once

#include "model/collision_geometry.h"
#include "scene/heightmap.h"

namespace spawnfield {

/// Returns the heights of a <heightmap> as Gazebo does. In a PNG image the brightest pixel is size.z above black,
/// even if it is not white (gazebo::common::ImageHeightmap, HeightmapShape). Any other file is an elevation model: its
/// lowest point keeps its height, and its highest is size.z above that (gz::common::Dem and gz-physics'
/// CustomHeightmapShape since Gazebo Harmonic); pixels without height remain without. Between two pixels, `sampling` -
/// 1 samples are interpolated bilinearly. Throws FileError.
Heightmap gazebo_heights(const std::filesystem::path& file, const CollisionGeometry& geometry);

}  // namespace spawnfield

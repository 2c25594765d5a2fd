#pragma once

#include "model/collision_geometry.h"
#include "scene/heightmap.h"

namespace spawnfield {

/// Heights of a <heightmap> as Gazebo has them. Of an image the brightest pixel lies size.z above black, however bright
/// it is (gazebo::common::ImageHeightmap, HeightmapShape). Any other file than PNG is an elevation model: its lowest
/// place keeps its height, its highest lies size.z above that (gz::common::Dem and gz-physics' CustomHeightmapShape
/// from Gazebo Harmonic on); what has no height has none here either. Between pixels, `sampling` - 1 samples are
/// interpolated bilinearly. Throws FileError.
Heightmap gazebo_heights(const std::filesystem::path& file, const CollisionGeometry& geometry);

}  // namespace spawnfield

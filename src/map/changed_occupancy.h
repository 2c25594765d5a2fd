#pragma once

#include "geometry/tile.h"

#include <spawnfield/occupancy.h>

#include <span>

namespace spawnfield {

/// Writes the file that write_occupancy() writes for a changed geometry, where `old_file` is that of the unchanged one
/// with the same bounds and resolution. Only towers of cubes (occupancy_towers.h) that meet a box of the changes, or
/// come within a voxel of one, are made; all others are copied. Either both geometries have filled meshes, or neither.
/// Returns the number of leaves. Throws FileError for a damaged old file, and OutputError.
std::size_t write_changed_occupancy(const std::filesystem::path& file, const std::filesystem::path& old_file,
                                    const Geometry& geometry, const Bounds& bounds, double resolution,
                                    std::span<const ElementBox> boxes, int threads);

}  // namespace spawnfield

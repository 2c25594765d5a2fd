#pragma once

#include <spawnfield/terrain.h>

#include <filesystem>

namespace spawnfield {

/// Multi-page TIFF of float32 tiles, deflated with predictor 3, one directory per page, its name as ImageDescription.
/// Throws OutputError.
void write_terrain(const std::filesystem::path& file, const TerrainMap& terrain);

/// Pages of such a file, without inflating them. Throws FileError.
TerrainMap read_terrain_file(const std::filesystem::path& file, const GridFrame& frame);

}  // namespace spawnfield

#pragma once

#include <spawnfield/terrain.h>

#include <filesystem>

namespace spawnfield {

/// Writes a TIFF of several pages: float32 tiles, deflated with predictor 3; one directory for each page, with the
/// page's name as ImageDescription. Throws OutputError.
void write_terrain(const std::filesystem::path& file, const TerrainMap& terrain);

/// Reads the pages of such a file without inflating them. Throws FileError.
TerrainMap read_terrain_file(const std::filesystem::path& file, const GridFrame& frame);

}  // namespace spawnfield

#pragma once

#include <spawnfield/geometry.h>

#include <filesystem>

namespace spawnfield {

/// geometry.bin: what exact checks need, in tiles that are read one by one (docs/map-format.md). Throws OutputError.
void write_geometry(const std::filesystem::path& file, const Geometry& geometry);

/// Reads the head alone; tiles are read and checked when they are touched. Throws FileError for a file that is cut
/// short, altered or newer.
Geometry open_geometry(const std::filesystem::path& file, const std::string& head_checksum);

}  // namespace spawnfield

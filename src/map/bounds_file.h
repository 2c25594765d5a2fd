#pragma once

#include <spawnfield/solid_bounds.h>

#include <filesystem>

namespace spawnfield {

/// bounds.bin: the images behind the free-space mask, in tiles that are read one by one (docs/map-format.md). Throws
/// OutputError.
void write_bounds(const std::filesystem::path& file, const SolidBounds& bounds);

/// Reads the head alone; tiles are read and checked when they are touched. Throws FileError for a file that is cut
/// short, altered or newer.
SolidBounds open_bounds(const std::filesystem::path& file, const std::string& head_checksum);

}  // namespace spawnfield

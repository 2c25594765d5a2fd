#pragma once

#include <spawnfield/solid_bounds.h>

#include <filesystem>

namespace spawnfield {

/// Writes bounds.bin: the images from which the free-space mask is made, in tiles that are read one by one
/// (docs/map-format.md). Throws OutputError.
void write_bounds(const std::filesystem::path& file, const SolidBounds& bounds);

/// Opens bounds.bin and reads its head only. A tile is read and checked when it is first used. Throws FileError for a
/// file that is cut short, altered or of another version.
SolidBounds open_bounds(const std::filesystem::path& file, const std::string& head_checksum);

}  // namespace spawnfield

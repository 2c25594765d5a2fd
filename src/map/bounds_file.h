#pragma once

#include "map/listed_file.h"

#include <spawnfield/solid_bounds.h>

namespace spawnfield {

/// Writes bounds.bin: the images from which the free-space mask is made, in tiles that are read one by one
/// (docs/map-format.md). Returns the file's entry for map.yaml. Throws OutputError.
ListedFile write_bounds(const std::filesystem::path& file, const SolidBounds& bounds);

/// Opens bounds.bin and reads its head only. A tile is read and checked when it is first used. Throws FileError for a
/// file that is cut short, altered or of another version.
SolidBounds open_bounds(const std::filesystem::path& file, const std::string& head_checksum);

}  // namespace spawnfield

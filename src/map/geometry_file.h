#pragma once

#include "map/listed_file.h"

#include <spawnfield/geometry.h>

namespace spawnfield {

/// Writes geometry.bin: the geometry for exact checks, in tiles that are read one by one (docs/map-format.md). Returns
/// the file's entry for map.yaml. Throws OutputError.
ListedFile write_geometry(const std::filesystem::path& file, const Geometry& geometry);

/// Opens geometry.bin and reads its head only. A tile is read and checked when it is first used. Throws FileError for a
/// file that is cut short, altered or of another version.
Geometry open_geometry(const std::filesystem::path& file, const std::string& head_checksum);

}  // namespace spawnfield

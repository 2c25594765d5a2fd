#pragma once

#include <spawnfield/column.h>

#include <filesystem>
#include <string>

namespace spawnfield {

/// geometry.bin: what exact checks need, in sections that can be read one by one (docs/map-format.md).
std::string geometry_bytes(const Scene& scene, const ColumnIndex& index);

/// Throws FileError for a file that is cut short, altered or newer.
void read_geometry(const std::filesystem::path& file, Scene& scene, ColumnIndex& index);

}  // namespace spawnfield

#pragma once

#include <spawnfield/input_file.h>

#include <fstream>

namespace spawnfield {

/// Opens a regular file for reading. Throws FileError.
std::ifstream open_file(const std::filesystem::path& file);

}  // namespace spawnfield

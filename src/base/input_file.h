#pragma once

#include <filesystem>
#include <string>

namespace spawnfield {

/// All bytes of a file. Throws FileError.
std::string read_file(const std::filesystem::path& file);

}  // namespace spawnfield

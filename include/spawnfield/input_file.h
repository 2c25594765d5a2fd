#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <string>

namespace spawnfield {

/// Throws FileError unless there is a regular file (links are followed). To be called before a file is opened: opening
/// a pipe waits for its writer, and a device may never end.
SPAWNFIELD_API void require_file(const std::filesystem::path& file);

/// All bytes of a file. Throws FileError.
SPAWNFIELD_API std::string read_file(const std::filesystem::path& file);

/// The first bytes of a file, at most so many. Throws FileError.
SPAWNFIELD_API std::string read_start(const std::filesystem::path& file, std::size_t most);

}  // namespace spawnfield

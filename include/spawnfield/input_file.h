#pragma once

#include <spawnfield/export.h>

#include <filesystem>
#include <string>

namespace spawnfield {

/// Throws FileError unless the file exists and is a regular file (links are followed). Call it before opening a file,
/// because opening a pipe waits for its writer, and reading a device may never end.
SPAWNFIELD_API void require_file(const std::filesystem::path& file);

/// Returns all bytes of a file. Throws FileError.
SPAWNFIELD_API std::string read_file(const std::filesystem::path& file);

/// Returns the first `most` bytes of a file, or all if there are fewer. Throws FileError.
SPAWNFIELD_API std::string read_start(const std::filesystem::path& file, std::size_t most);

}  // namespace spawnfield

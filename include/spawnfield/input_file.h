#pragma once

#include <spawnfield/error.h>
#include <spawnfield/export.h>

#include <filesystem>
#include <string>

namespace spawnfield {

// These follow links and never throw. A path that cannot be followed, because of a circle of links or a folder without
// permission, leads to nothing, but is not missing: opening it says why. One that is too long for the system is
// missing.

/// Returns whether a path leads to anything.
SPAWNFIELD_API bool does_exist(const std::filesystem::path& path);

/// Returns whether a path leads to a regular file.
SPAWNFIELD_API bool is_file(const std::filesystem::path& path);

/// Returns whether a path leads to a folder.
SPAWNFIELD_API bool is_folder(const std::filesystem::path& path);

/// Returns whether nothing has this path.
SPAWNFIELD_API bool is_missing(const std::filesystem::path& path);

/// Throws FileError unless the file exists and is a regular file (links are followed). Call it before opening a file,
/// because opening a pipe waits for its writer, and reading a device may never end.
SPAWNFIELD_API void require_file(const std::filesystem::path& file);

/// Returns whether a path is a folder or lies in it, at any depth. Both must be absolute and without links.
SPAWNFIELD_API bool is_in_folder(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Returns the error for a file that cannot be reached: a loop of links, or a folder without permission.
SPAWNFIELD_API FileError unreachable_file(const std::filesystem::filesystem_error& error);

/// Returns all bytes of a file. Throws FileError.
SPAWNFIELD_API std::string read_file(const std::filesystem::path& file);

/// Returns the first `most` bytes of a file, or all if there are fewer. Throws FileError.
SPAWNFIELD_API std::string read_start(const std::filesystem::path& file, std::size_t most);

}  // namespace spawnfield

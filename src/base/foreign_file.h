#pragma once

#include <filesystem>
#include <string>

namespace spawnfield {

/// Throw FileError if the file belongs to another program and is not read here, but users often give it. The message
/// names the kind of file and the way to convert it. The file must be a regular file.
void refuse_foreign_scene(const std::filesystem::path& file);
void refuse_foreign_robot(const std::filesystem::path& file);

}  // namespace spawnfield

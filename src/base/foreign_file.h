#pragma once

#include <filesystem>
#include <string>

namespace spawnfield {

/// Files of other programs that are not read, but that users give: the complaint names the kind and says how to get the
/// data in. Each throws FileError for such a file. The file must be regular.
void refuse_foreign_scene(const std::filesystem::path& file);
void refuse_foreign_robot(const std::filesystem::path& file);

}  // namespace spawnfield

#pragma once

#include "paths.h"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>

/// Folder of the real scenes beside the repository, or SPAWNFIELD_SCENES; says so where there is none.
inline std::optional<std::filesystem::path> shared_scenes()
{
    const char* const given = std::getenv("SPAWNFIELD_SCENES");
    const std::filesystem::path folder = given != nullptr
                                             ? given
                                             : std::filesystem::path(source_folder()) / ".." / "shared" / "scenes";
    if (std::filesystem::is_directory(folder)) return std::filesystem::canonical(folder);
    std::cout << "skipped: no shared scenes at " << folder.string() << " (SPAWNFIELD_SCENES says where they are)\n";
    return std::nullopt;
}

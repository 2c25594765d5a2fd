#pragma once

#include "paths.h"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>

/// Returns the folder of the real scenes: SPAWNFIELD_SCENES, or else the one beside the repository. Prints a line if it
/// does not exist.
inline std::optional<std::filesystem::path> shared_scenes()
{
    const char* const given = std::getenv("SPAWNFIELD_SCENES");
    const std::filesystem::path folder = given != nullptr
                                             ? given
                                             : std::filesystem::path(source_folder()) / ".." / "shared" / "scenes";
    if (std::filesystem::is_directory(folder)) return std::filesystem::canonical(folder);
    std::cout << "skipped: there are no shared scenes at " << folder.string()
              << "; set SPAWNFIELD_SCENES to their folder\n";
    return std::nullopt;
}

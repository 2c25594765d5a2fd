#pragma once

#include "this_build.h"
#include "skip.h"

#include <cstdlib>
#include <filesystem>
#include <optional>

/// Returns the folder of the real scenes: SPAWNFIELD_SCENES, or the one beside the repository. If it does not exist,
/// the running test is skipped. Tests that call this have the tag [real], unless all tests of their file call it (see
/// CMakeLists.txt).
inline std::optional<std::filesystem::path> shared_scenes()
{
    const char* const given = std::getenv("SPAWNFIELD_SCENES");
    const std::filesystem::path folder = given != nullptr
                                             ? given
                                             : std::filesystem::path(source_folder()) / ".." / "shared" / "scenes";
    if (std::filesystem::is_directory(folder)) return std::filesystem::canonical(folder);
    skip_test("no shared scenes at " + folder.string() + "; set SPAWNFIELD_SCENES to their folder");
    return std::nullopt;
}

#pragma once

#include <fnmatch.h>

#include <string>

namespace spawnfield {

/// Returns whether a shell glob matches the whole name, ignoring case (POSIX fnmatch).
inline bool matches(const std::string& pattern, const std::string& name)
{
    return fnmatch(pattern.c_str(), name.c_str(), FNM_CASEFOLD) == 0;
}

}  // namespace spawnfield

#pragma once

#include <string>

namespace spawnfield::cli {

/// Returns the version of the program on the first line, then the versions of the libraries: those that are loaded now
/// for libraries that have a function for it, and those found at build time for the others. Loads no module.
std::string version_text();

}  // namespace spawnfield::cli

#pragma once

#include "model/sdf_includes.h"

namespace spawnfield {

/// Throws FileError, with the line, if a number in a pose or a shape of a collision is malformed or missing, or if
/// there are too many. libsdformat would read "1,5" as 1, and use its defaults for missing numbers.
void check_numbers(const std::filesystem::path& file, const Xml& root);

}  // namespace spawnfield

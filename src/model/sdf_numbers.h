#pragma once

#include "model/sdf_includes.h"

namespace spawnfield {

/// Throws FileError, with the line, where a number that says what is solid and where is none, or stands there too often
/// or too rarely: libsdformat reads "1,5" as 1 and takes its defaults for the rest.
void check_numbers(const std::filesystem::path& file, const Xml& root);

}  // namespace spawnfield

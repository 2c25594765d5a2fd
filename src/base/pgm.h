#pragma once

#include "base/grey_image.h"

#include <filesystem>
#include <string_view>

namespace spawnfield {

/// Returns whether a file that starts with these bytes (2 or more) is a PGM image: P2 or P5.
bool is_pgm(std::string_view start);

/// Reads grey pixels as text (P2) or bytes (P5), of one or two bytes each (largest value 1 .. 65535). The header may
/// contain comments. Throws FileError; an image of more than `most` pixels is refused before its pixels are read.
/// Source: netpbm's pgm(5).
GreyImage read_pgm(const std::filesystem::path& file, std::uint64_t most = max_pixels);

}  // namespace spawnfield

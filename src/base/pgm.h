#pragma once

#include "base/grey_image.h"

#include <filesystem>
#include <string_view>

namespace spawnfield {

bool is_pgm(std::string_view start);  ///< its first 2 bytes or more: P2 or P5

/// Grey pixels in text (P2) or bytes (P5), of one byte or two (largest value 1 .. 65535), with comments in the head.
/// Throws FileError; for more than `most` pixels before any is read. Source: netpbm's pgm(5).
GreyImage read_pgm(const std::filesystem::path& file, std::uint64_t most = max_pixels);

}  // namespace spawnfield

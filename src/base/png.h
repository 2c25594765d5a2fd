#pragma once

#include "base/grey_image.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

bool is_png(std::string_view start);  ///< its first 8 bytes or more

/// 1 to 16 bits, interlaced or not; pixels of fewer than 8 bits are spread over 0 .. 255. Gamma and transparency are
/// not applied. Of images stored in colours all pixels need to be grey, and opaque. Throws FileError; for more than
/// `most` pixels before any is read.
GreyImage read_grey_png(const std::filesystem::path& file, std::uint64_t most = max_pixels);

/// 1 to 4 channels: grey or red, green, blue, then alpha.
struct ColourImage {
    int rows = 0, cols = 0, channels = 1, largest = 255;  ///< largest: 255 or 65535
    std::vector<std::uint16_t> samples;                   ///< pixel after pixel, rows from the top
};

/// Of any kind: palettes become colours, transparency alpha, fewer than 8 bits 8. Gamma is not applied. Throws
/// FileError; for more than `most` pixels before any is read.
ColourImage read_colour_png(const std::filesystem::path& file, std::uint64_t most = max_pixels);

/// Bytes of a PNG file of 8-bit blue, green, red. Same pixels, same bytes. Throws OutputError that begins
/// with `name`.
std::string bgr_png(const std::string& name, int rows, int cols, const std::uint8_t* pixels);

/// Writes those bytes to a file. Throws OutputError.
void write_bgr_png(const std::filesystem::path& file, int rows, int cols, const std::uint8_t* pixels);

/// 16-bit pixels. Same pixels, same bytes. Throws OutputError.
void write_grey_png(const std::filesystem::path& file, int rows, int cols, const std::uint16_t* pixels);

}  // namespace spawnfield

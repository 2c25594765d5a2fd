#pragma once

#include "base/grey_image.h"

#include <spawnfield/export.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// Returns whether a file that starts with these bytes (8 or more) is a PNG image.
bool is_png(std::string_view start);

/// Reads an image of 1 to 16 bits, interlaced or not. Pixels of fewer than 8 bits are scaled to 0 .. 255. Gamma and
/// transparency are not applied. In an image that is stored in colours, each pixel must be grey and opaque. Throws
/// FileError; an image of more than `most` pixels is refused before its pixels are read.
GreyImage read_grey_png(const std::filesystem::path& file, std::uint64_t most = max_pixels);

/// An image of 1 to 4 channels: grey, or red, green and blue; then perhaps alpha.
struct ColourImage {
    int rows = 0, cols = 0, channels = 1, largest = 255;  ///< largest: value of white, 255 or 65535
    std::vector<std::uint16_t> samples;                   ///< pixel after pixel, rows from the top
};

/// Reads a PNG image of any kind. Palettes become colours, transparency becomes alpha, and samples of fewer than 8 bits
/// become 8 bits. Gamma is not applied. Throws FileError; an image of more than `most` pixels is refused before its
/// pixels are read.
ColourImage read_colour_png(const std::filesystem::path& file, std::uint64_t most = max_pixels);

/// Returns the bytes of a PNG file. `pixels` are 8-bit blue, green, red. Equal pixels give equal bytes. Throws
/// OutputError, which begins with `name`.
SPAWNFIELD_MODULE_API std::string bgr_png(const std::string& name, int rows, int cols, const std::uint8_t* pixels);

/// Writes the bytes of bgr_png() to a file. Throws OutputError.
SPAWNFIELD_MODULE_API void write_bgr_png(const std::filesystem::path& file, int rows, int cols,
                                         const std::uint8_t* pixels);

/// Writes 16-bit grey pixels. Equal pixels give equal bytes. Throws OutputError.
void write_grey_png(const std::filesystem::path& file, int rows, int cols, const std::uint16_t* pixels);

}  // namespace spawnfield

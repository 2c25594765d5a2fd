#pragma once

#include "base/grey_image.h"

#include <tiffio.h>

#include <filesystem>
#include <memory>
#include <string_view>

namespace spawnfield {

struct TiffCloser {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, TiffCloser>;

/// Calls TIFFOpen and turns off libtiff's own messages, because ours name the file and the remedy. Returns null if the
/// file cannot be opened.
Tiff open_tiff(const std::filesystem::path& file, const char* mode);

/// Returns whether a file that starts with these bytes (4 or more) is a TIFF or BigTIFF image.
bool is_tiff(std::string_view start);

/// Reads the first page as it is stored: signed or unsigned integers of 8, 16 or 32 bits, or floats of 32 or 64 bits,
/// in strips or tiles, in any compression that libtiff decodes. In unsigned images of 8 and 16 bits the largest value
/// is white, or black if zero_is_white; other images have no white. Throws FileError; an image of more than `most`
/// pixels is refused before its pixels are read.
GreyImage read_grey_tiff(const std::filesystem::path& file, std::uint64_t most = max_pixels);

}  // namespace spawnfield

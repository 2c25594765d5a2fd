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

/// TIFFOpen, without libtiff's own messages: ours name the file and what to do. Null if it cannot be opened.
Tiff open_tiff(const std::filesystem::path& file, const char* mode);

bool is_tiff(std::string_view start);  ///< its first 4 bytes or more; BigTIFF too

/// The first page: integers of 8, 16 or 32 bits, with sign or without, or float of 32 or 64, in strips or tiles, of any
/// compression that libtiff decodes; all as they are stored. White is the largest value of unsigned ones of 8 and 16
/// bits (or 0, of which the image tells), the others have none. Throws FileError; for more than `most` pixels before
/// any is read.
GreyImage read_grey_tiff(const std::filesystem::path& file, std::uint64_t most = max_pixels);

}  // namespace spawnfield

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

/// The first page: 8- or 16-bit unsigned or float of 32 or 64 bits, in strips or tiles, of any compression that libtiff
/// decodes. Throws FileError.
GreyImage read_grey_tiff(const std::filesystem::path& file);

}  // namespace spawnfield

#pragma once

#include "base/grey_image.h"
#include "base/module.h"

#include <tiffio.h>

#include <filesystem>
#include <memory>
#include <string_view>

namespace spawnfield {

/// The interface of the module src/tiff: the functions of libtiff that this library calls, under libtiff's names
/// without the prefix TIFF. They are in a module because libtiff needs seven other libraries, one for each kind of
/// compression: loading them would take a tenth of the time of a short command.
namespace tiff_module {
struct Functions {
    static constexpr const char *module = "tiff", *failure = "TIFF files cannot be read or written";
    decltype(&TIFFOpen) open;
    decltype(&TIFFClose) close;
    decltype(&TIFFFlush) flush;
    decltype(&TIFFSetErrorHandler) set_error_handler;
    decltype(&TIFFSetWarningHandler) set_warning_handler;
    decltype(&TIFFSetTagExtender) set_tag_extender;
    decltype(&TIFFMergeFieldInfo) merge_field_info;
    decltype(&TIFFGetField) get_field;
    decltype(&TIFFGetFieldDefaulted) get_field_defaulted;
    decltype(&TIFFSetField) set_field;
    decltype(&TIFFReadDirectory) read_directory;
    decltype(&TIFFWriteDirectory) write_directory;
    decltype(&TIFFIsCODECConfigured) is_codec_configured;
    decltype(&TIFFIsTiled) is_tiled;
    decltype(&TIFFScanlineSize) scanline_size;
    decltype(&TIFFReadScanline) read_scanline;
    decltype(&TIFFTileSize) tile_size;
    decltype(&TIFFReadTile) read_tile;
    decltype(&TIFFNumberOfTiles) number_of_tiles;
    decltype(&TIFFGetStrileByteCount) get_strile_byte_count;
    decltype(&TIFFReadRawTile) read_raw_tile;
    decltype(&TIFFWriteRawTile) write_raw_tile;
};
}  // namespace tiff_module

inline const tiff_module::Functions& libtiff() { return module_functions<tiff_module::Functions>(); }

struct TiffCloser {
    void operator()(TIFF* tiff) const { libtiff().close(tiff); }
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

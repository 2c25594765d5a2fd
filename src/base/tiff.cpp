#include "base/tiff.h"

#include "base/geo_tags.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cstring>
#include <mutex>

namespace spawnfield {
namespace {

/// Properties of a page's pixels, from its tags.
struct Layout {
    std::uint32_t rows = 0, cols = 0, tile_rows = 0, tile_cols = 0;
    std::uint16_t bits = 0, format = 0, channels = 0, photometric = 0, orientation = 0, compression = 0;

    std::size_t pixel_bytes() const { return bits / 8u; }
};

Layout layout(TIFF* tiff)
{
    Layout found;
    libtiff().get_field(tiff, TIFFTAG_IMAGELENGTH, &found.rows);
    libtiff().get_field(tiff, TIFFTAG_IMAGEWIDTH, &found.cols);
    libtiff().get_field(tiff, TIFFTAG_TILELENGTH, &found.tile_rows);
    libtiff().get_field(tiff, TIFFTAG_TILEWIDTH, &found.tile_cols);
    libtiff().get_field_defaulted(tiff, TIFFTAG_BITSPERSAMPLE, &found.bits);
    libtiff().get_field_defaulted(tiff, TIFFTAG_SAMPLEFORMAT, &found.format);
    libtiff().get_field_defaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &found.channels);
    libtiff().get_field_defaulted(tiff, TIFFTAG_ORIENTATION, &found.orientation);
    libtiff().get_field_defaulted(tiff, TIFFTAG_COMPRESSION, &found.compression);
    if (libtiff().get_field(tiff, TIFFTAG_PHOTOMETRIC, &found.photometric) != 1)
        found.photometric = PHOTOMETRIC_MINISBLACK;
    return found;
}

bool is_float(const Layout& l) { return l.format == SAMPLEFORMAT_IEEEFP && (l.bits == 32 || l.bits == 64); }
bool is_unsigned(const Layout& l)
{
    return l.format == SAMPLEFORMAT_UINT && (l.bits == 8 || l.bits == 16 || l.bits == 32);
}
bool is_signed(const Layout& l)
{
    return l.format == SAMPLEFORMAT_INT && (l.bits == 8 || l.bits == 16 || l.bits == 32);
}
/// Returns whether the image may be a picture, whose largest value is white.
bool has_white(const Layout& l) { return is_unsigned(l) && l.bits < 32; }

void check(const Layout& l, const std::string& file, std::uint64_t most)
{
    if (l.photometric == PHOTOMETRIC_PALETTE) throw FileError(file, "has a palette, needs 1 channel (grey)");
    if (l.channels != 1)
        throw FileError(file, "has " + std::to_string(l.channels) +
                                  " channels, needs 1 (grey); extract one with gdal_translate -b 1");
    if (!is_float(l) && !is_unsigned(l) && !is_signed(l))
        throw FileError(file, "has pixels of " + std::to_string(l.bits) +
                                  (l.format == SAMPLEFORMAT_UINT     ? " bits"
                                   : l.format == SAMPLEFORMAT_INT    ? " bits (signed)"
                                   : l.format == SAMPLEFORMAT_IEEEFP ? "-bit float"
                                                                     : " bits of an unknown kind") +
                                  ", needs integers of 8, 16 or 32 bits, or float of 32 or 64");
    if (l.orientation != ORIENTATION_TOPLEFT)
        throw FileError(file, "is stored rotated or mirrored (orientation " + std::to_string(l.orientation) +
                                  "), needs its upper left corner first (1)");
    if (std::max({std::uint64_t(l.rows), std::uint64_t(l.cols), std::uint64_t(l.rows) * l.cols}) > most)
        throw FileError(file, "has " + std::to_string(l.cols) + " x " + std::to_string(l.rows) +
                                  " pixels, needs at most " + std::to_string(most));
    if (!libtiff().is_codec_configured(l.compression))
        throw FileError(file, "is compressed with a scheme that libtiff cannot decode here (" +
                                  std::to_string(l.compression) + "); save it with deflate compression");
}

template <typename Pixel>
double value(const std::byte* bytes)
{
    Pixel pixel;
    std::memcpy(&pixel, bytes, sizeof pixel);
    return double(pixel);
}

double value(const Layout& l, const std::byte* bytes)
{
    if (l.format == SAMPLEFORMAT_IEEEFP) return l.bits == 32 ? value<float>(bytes) : value<double>(bytes);
    if (is_signed(l))
        return l.bits == 8    ? value<std::int8_t>(bytes)
               : l.bits == 16 ? value<std::int16_t>(bytes)
                              : value<std::int32_t>(bytes);
    return l.bits == 8    ? value<std::uint8_t>(bytes)
           : l.bits == 16 ? value<std::uint16_t>(bytes)
                          : value<std::uint32_t>(bytes);
}

/// Adds the pixels of all rows, row after row. Returns false if they cannot be decoded.
bool read_lines(TIFF* tiff, const Layout& l, std::vector<double>& pixels)
{
    const auto line = std::make_unique_for_overwrite<std::byte[]>(std::size_t(libtiff().scanline_size(tiff)));
    for (std::uint32_t row = 0; row < l.rows; ++row) {
        if (libtiff().read_scanline(tiff, line.get(), row, 0) != 1) return false;
        for (std::size_t col = 0; col < l.cols; ++col) pixels.push_back(value(l, line.get() + col * l.pixel_bytes()));
    }
    return true;
}

bool read_tiles(TIFF* tiff, const Layout& l, std::vector<double>& pixels)
{
    const auto tile = std::make_unique_for_overwrite<std::byte[]>(std::size_t(libtiff().tile_size(tiff)));
    for (std::uint32_t top = 0; top < l.rows; top += l.tile_rows) {
        const std::uint32_t rows = std::min(l.tile_rows, l.rows - top);
        pixels.resize(std::size_t(top + rows) * l.cols);
        for (std::uint32_t left = 0; left < l.cols; left += l.tile_cols) {
            if (libtiff().read_tile(tiff, tile.get(), left, top, 0, 0) < 0) return false;
            const std::uint32_t cols = std::min(l.tile_cols, l.cols - left);
            for (std::size_t row = 0; row < rows; ++row)
                for (std::size_t col = 0; col < cols; ++col)
                    pixels[(top + row) * l.cols + left + col] = value(
                        l, tile.get() + (row * l.tile_cols + col) * l.pixel_bytes());
        }
    }
    return true;
}

}  // namespace

Tiff open_tiff(const std::filesystem::path& file, const char* mode)
{
    static std::once_flag once;
    std::call_once(once, [] {
        libtiff().set_error_handler(nullptr);
        libtiff().set_warning_handler(nullptr);
        register_geo_tags();
    });
    return Tiff(libtiff().open(file.c_str(), mode));
}

bool is_tiff(std::string_view start)
{
    using namespace std::string_view_literals;
    const std::string_view four = start.substr(0, 4);
    return four == "II*\0"sv || four == "MM\0*"sv || four == "II+\0"sv || four == "MM\0+"sv;
}

GreyImage read_grey_tiff(const std::filesystem::path& file, std::uint64_t most)
{
    const auto damaged = [&] { return FileError(file.string(), "is cut short or a damaged TIFF image"); };
    const Tiff tiff = open_tiff(file, "r");
    if (!tiff) throw damaged();
    const Layout found = layout(tiff.get());
    check(found, file.string(), most);
    GreyImage image{int(found.rows), int(found.cols), !has_white(found) ? 0.0 : found.bits == 8 ? 255.0 : 65535.0, {}};
    image.zero_is_white = has_white(found) && found.photometric == PHOTOMETRIC_MINISWHITE;
    image.is_float32 = is_float(found) && found.bits == 32;
    const bool tiled = libtiff().is_tiled(tiff.get());
    const tmsize_t piece = tiled ? libtiff().tile_size(tiff.get()) : libtiff().scanline_size(tiff.get());
    const std::size_t wanted = tiled ? std::size_t(found.tile_rows) * found.tile_cols : found.cols;
    if (piece <= 0 || std::size_t(piece) != wanted * found.pixel_bytes()) throw damaged();
    if (!(tiled ? read_tiles : read_lines)(tiff.get(), found, image.pixels)) throw damaged();
    return image;
}

}  // namespace spawnfield

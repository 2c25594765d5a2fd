#include "base/tiff.h"
#include "catch.h"
#include "temp_folder.h"

#include <spawnfield/error.h>

#include <functional>

using namespace spawnfield;

namespace {

using Pixels = std::vector<double>;

struct TiffTags {
    std::uint32_t cols = 3, rows = 2;
    int bits = 16, format = SAMPLEFORMAT_UINT, channels = 1, photometric = PHOTOMETRIC_MINISBLACK;
    int compression = COMPRESSION_NONE, orientation = ORIENTATION_TOPLEFT,
        tile = 0;  ///< tile: its side, 0: strips of a row
    const char* mode = "w";
};

/// Writes a TIFF image. All pixels are 0 if no function is given.
std::filesystem::path write_tiff(const TempFolder& folder, const TiffTags& tags,
                                 const std::function<double(std::uint32_t row, std::uint32_t col)>& pixel = {})
{
    const auto put = [&](std::string& to, std::uint32_t row, std::uint32_t col) {
        const double value = pixel ? pixel(row, col) : 0;
        const auto add = [&](auto typed) { to.append(reinterpret_cast<const char*>(&typed), sizeof typed); };
        for (int c = 0; c < tags.channels; ++c) {
            if (tags.format == SAMPLEFORMAT_IEEEFP && tags.bits == 64)
                add(value);
            else if (tags.format == SAMPLEFORMAT_IEEEFP && tags.bits == 32)
                add(float(value));
            else if (tags.bits == 32)
                add(std::uint32_t(std::int64_t(value)));
            else if (tags.bits == 16)
                add(std::uint16_t(std::int64_t(value)));
            else
                add(std::uint8_t(std::int64_t(value)));
        }
    };
    const std::filesystem::path file = folder / "a.tiff";
    const Tiff tiff = open_tiff(file, tags.mode);
    REQUIRE(tiff);
    TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, tags.cols);
    TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, tags.rows);
    TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, tags.bits);
    TIFFSetField(tiff.get(), TIFFTAG_SAMPLEFORMAT, tags.format);
    TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, tags.channels);
    TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, tags.photometric);
    TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, tags.compression);
    TIFFSetField(tiff.get(), TIFFTAG_ORIENTATION, tags.orientation);
    TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    std::vector<std::uint16_t> colours(256);
    if (tags.photometric == PHOTOMETRIC_PALETTE)
        TIFFSetField(tiff.get(), TIFFTAG_COLORMAP, colours.data(), colours.data(), colours.data());
    if (tags.tile > 0) {
        TIFFSetField(tiff.get(), TIFFTAG_TILEWIDTH, tags.tile);
        TIFFSetField(tiff.get(), TIFFTAG_TILELENGTH, tags.tile);
        const auto side = std::uint32_t(tags.tile);
        for (std::uint32_t top = 0; top < tags.rows; top += side)
            for (std::uint32_t left = 0; left < tags.cols; left += side) {
                std::string bytes;
                for (std::uint32_t row = top; row < top + side; ++row)
                    for (std::uint32_t col = left; col < left + side; ++col) put(bytes, row, col);
                REQUIRE(TIFFWriteTile(tiff.get(), bytes.data(), left, top, 0, 0) > 0);
            }
    } else {
        TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, 1);
        for (std::uint32_t row = 0; row < tags.rows; ++row) {
            std::string bytes;
            for (std::uint32_t col = 0; col < tags.cols; ++col) put(bytes, row, col);
            bytes.resize(std::size_t(TIFFScanlineSize(tiff.get())));  // put() writes too little in unusual formats
            REQUIRE(TIFFWriteScanline(tiff.get(), bytes.data(), row) == 1);
        }
    }
    return file;
}

}  // namespace

TEST_CASE("TIFF images of every layout, byte order and compression are read")
{
    const TempFolder folder;
    const auto [bits, format] = GENERATE(std::pair{8, SAMPLEFORMAT_UINT}, std::pair{16, SAMPLEFORMAT_UINT},
                                         std::pair{32, SAMPLEFORMAT_IEEEFP}, std::pair{64, SAMPLEFORMAT_IEEEFP});
    const int tile = GENERATE(0, 16), compression = GENERATE(COMPRESSION_NONE, COMPRESSION_LZW,
                                                             COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS);
    const char* const mode = GENERATE("wl", "wb", "w8");
    const auto pixel = [](std::uint32_t row, std::uint32_t col) { return double(row * 7 + col * 3); };
    const GreyImage image = read_grey_tiff(write_tiff(folder,
                                                      {.cols = 37,
                                                       .rows = 19,
                                                       .bits = bits,
                                                       .format = format,
                                                       .compression = compression,
                                                       .tile = tile,
                                                       .mode = mode},
                                                      pixel));
    CAPTURE(bits, tile, compression, mode);
    REQUIRE((image.rows == 19 && image.cols == 37 && image.pixels.size() == 19 * 37));
    CHECK(image.largest == (bits == 8 ? 255 : bits == 16 ? 65535 : 0));
    bool same = true;
    for (std::uint32_t row = 0; row < 19; ++row)
        for (std::uint32_t col = 0; col < 37; ++col) same = same && image.pixels[row * 37 + col] == pixel(row, col);
    CHECK(same);
}

TEST_CASE("signed integers and integers of 32 bits keep their values")
{
    const TempFolder folder;
    const int bits = GENERATE(8, 16, 32);
    const auto pixel = [](std::uint32_t row, std::uint32_t col) { return double(row * 3 + col) - 4; };
    const GreyImage image = read_grey_tiff(write_tiff(folder, {.bits = bits, .format = SAMPLEFORMAT_INT}, pixel));
    CHECK(image.largest == 0);
    CHECK(image.pixels == Pixels{-4, -3, -2, -1, 0, 1});
    const auto far = [](std::uint32_t row, std::uint32_t col) { return 4294967290.0 + double(row * 3 + col); };
    CHECK(read_grey_tiff(write_tiff(folder, {.bits = 32}, far)).pixels ==
          Pixels{4294967290, 4294967291, 4294967292, 4294967293, 4294967294, 4294967295});
}

TEST_CASE("a TIFF image whose 0 is white keeps its stored values, and is marked as such")
{
    const TempFolder folder;
    const auto pixel = [](std::uint32_t row, std::uint32_t col) { return double(row * 3 + col); };
    const auto [bits, format] = GENERATE(std::pair{8, SAMPLEFORMAT_UINT}, std::pair{16, SAMPLEFORMAT_UINT},
                                         std::pair{16, SAMPLEFORMAT_INT}, std::pair{32, SAMPLEFORMAT_UINT},
                                         std::pair{32, SAMPLEFORMAT_IEEEFP});
    const GreyImage image = read_grey_tiff(
        write_tiff(folder, {.bits = bits, .format = format, .photometric = PHOTOMETRIC_MINISWHITE}, pixel));
    CHECK(image.pixels == Pixels{0, 1, 2, 3, 4, 5});
    CHECK(image.zero_is_white == (image.largest > 0));  // only a picture has a white value
    CHECK_FALSE(read_grey_tiff(write_tiff(folder, {.bits = 8}, pixel)).zero_is_white);
}

TEST_CASE("TIFF images that are damaged or not grey heights are refused with their name and the reason")
{
    const TempFolder folder;
    const std::string file = (folder / "a.tiff").string() + ": ";
    const auto check_refused = [&](const TiffTags& tags, const std::string& reason) {
        CHECK_THROWS_WITH(read_grey_tiff(write_tiff(folder, tags)), file + reason);
    };
    const std::string wanted = ", needs integers of 8, 16 or 32 bits, or float of 32 or 64";
    check_refused({.bits = 8, .channels = 3, .photometric = PHOTOMETRIC_RGB},
                  "has 3 channels, needs 1 (grey); extract one with gdal_translate -b 1");
    check_refused({.bits = 8, .channels = 2}, "has 2 channels, needs 1 (grey); extract one with gdal_translate -b 1");
    check_refused({.bits = 8, .photometric = PHOTOMETRIC_PALETTE}, "has a palette, needs 1 channel (grey)");
    check_refused({.bits = 64, .format = SAMPLEFORMAT_INT}, "has pixels of 64 bits (signed)" + wanted);
    check_refused({.bits = 4}, "has pixels of 4 bits" + wanted);
    CHECK_THROWS_WITH(read_grey_tiff(write_tiff(folder, {.cols = 90, .rows = 70}), 6299),
                      file + "has 90 x 70 pixels, needs at most 6299");
    check_refused({.format = SAMPLEFORMAT_IEEEFP}, "has pixels of 16-bit float" + wanted);
    check_refused({.orientation = ORIENTATION_BOTLEFT},
                  "is stored rotated or mirrored (orientation 4), needs its upper left corner first (1)");

    const std::filesystem::path whole = write_tiff(folder, {.cols = 90, .rows = 70});
    const std::string good = bytes_of(whole);
    folder.write("a.tiff", good.substr(0, good.size() / 2));  // libtiff writes its tags at the end
    CHECK_THROWS_WITH(read_grey_tiff(whole), file + "is cut short or a damaged TIFF image");
    folder.write("a.tiff", "II*");
    CHECK_THROWS_WITH(read_grey_tiff(whole), file + "is cut short or a damaged TIFF image");
}

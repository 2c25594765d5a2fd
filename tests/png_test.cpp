#include "base/png.h"
#include "catch.h"
#include "temp_folder.h"

#include <spawnfield/error.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <zlib.h>

#include <algorithm>

using namespace spawnfield;

namespace {

using Pixels = std::vector<double>;

std::string big_endian(std::uint32_t number)
{
    return {char(number >> 24), char(number >> 16), char(number >> 8), char(number)};
}

std::string chunk(const std::string& name, const std::string& data)
{
    const std::string named = name + data;
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(named.data()), uInt(named.size()));
    return big_endian(std::uint32_t(data.size())) + named + big_endian(std::uint32_t(sum));
}

struct PngText {
    std::uint32_t cols = 2, rows = 2;
    char bits = 8, colour = 0, interlace = 0;  ///< values of the header
    std::string lines = "";                    ///< a filter byte and the pixels, for each row
    std::string before = "";                   ///< chunks in front of the pixels
};

std::string png_bytes(const PngText& png)
{
    uLongf size = compressBound(uLong(png.lines.size()));
    std::string packed(size, '\0');
    REQUIRE(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(png.lines.data()),
                     uLong(png.lines.size())) == Z_OK);
    packed.resize(size);
    return "\x89PNG\r\n\x1a\n" +
           chunk("IHDR",
                 big_endian(png.cols) + big_endian(png.rows) + png.bits + png.colour + '\0' + '\0' + png.interlace) +
           png.before + chunk("IDAT", packed) + chunk("IEND", "");
}

GreyImage read_png(const TempFolder& folder, const PngText& png)
{
    return read_grey_png(folder.write("a.png", png_bytes(png)));
}

}  // namespace

TEST_CASE("PNG pixels of fewer than 8 bits are scaled to 0 .. 255")
{
    const TempFolder folder;
    CHECK(read_png(folder, {.bits = 1, .lines = {0, '\x40', 0, '\x80'}}).pixels == Pixels{0, 255, 255, 0});
    CHECK(read_png(folder, {.bits = 2, .lines = {0, '\x10', 0, '\xb0'}}).pixels == Pixels{0, 85, 170, 255});
    const GreyImage four = read_png(folder, {.bits = 4, .lines = {0, '\x01', 0, '\x2f'}});
    CHECK(four.pixels == Pixels{0, 17, 34, 255});
    CHECK(four.largest == 255);
}

TEST_CASE("an interlaced PNG is read like a plain one")
{
    const TempFolder folder;
    // For 2 x 2 pixels, the first pass of Adam7 has the first pixel, the sixth pass the second pixel, and the last pass
    // the second row.
    CHECK(read_png(folder, {.interlace = 1, .lines = {0, 1, 0, 2, 0, 3, 4}}).pixels == Pixels{1, 2, 3, 4});
    const GreyImage deep = read_png(folder, {.bits = 16, .interlace = 1, .lines = {0, 1, 0, 0, 2, 0, 0, 3, 0, 4, 5}});
    CHECK(deep.pixels == Pixels{256, 512, 768, 1029});
    CHECK(deep.largest == 65535);
}

TEST_CASE("gamma and transparency leave PNG pixels as they are")
{
    const TempFolder folder;
    const std::string chunks = chunk("gAMA", big_endian(100000)) + chunk("tRNS", {0, 2});
    CHECK(read_png(folder, {.lines = {0, 1, 2, 0, 3, 4}, .before = chunks}).pixels == Pixels{1, 2, 3, 4});
}

TEST_CASE("a grey PNG image is read as grey, with any colour type")
{
    const TempFolder folder;
    CHECK(read_png(folder, {.colour = 2, .lines = {0, 1, 1, 1, 2, 2, 2, 0, 3, 3, 3, 4, 4, 4}}).pixels ==
          Pixels{1, 2, 3, 4});
    CHECK(read_png(folder, {.colour = 4, .lines = {0, 1, '\xff', 2, '\xff', 0, 3, '\xff', 4, '\xff'}}).pixels ==
          Pixels{1, 2, 3, 4});
    CHECK(read_png(folder, {.colour = 3, .lines = {0, 0, 1, 0, 1, 0}, .before = chunk("PLTE", "aaabbb")}).pixels ==
          Pixels{'a', 'b', 'b', 'a'});
}

TEST_CASE("PNG images that are damaged or not grey are refused with their name and the reason")
{
    const TempFolder folder;
    const std::string file = (folder / "a.png").string() + ": ";
    const auto check_refused = [&](const PngText& png, const std::string& reason) {
        CHECK_THROWS_WITH(read_png(folder, png), file + reason);
    };
    check_refused({.colour = 2, .lines = {0, 7, 7, 7, 8, 8, 8, 0, 9, 9, 9, 9, 9, 8}},
                  "has a pixel that is coloured (column 1, row 1), needs only grey, opaque pixels");
    check_refused({.colour = 4, .lines = {0, 7, '\xff', 8, '\xfe', 0, 9, '\xff', 9, '\xff'}},
                  "has a pixel that is transparent (column 1, row 0), needs only grey, opaque pixels");
    check_refused({.colour = 6, .lines = std::string(18, '\0')},
                  "has a pixel that is transparent (column 0, row 0), needs only grey, opaque pixels");
    check_refused({.colour = 3, .lines = std::string(6, '\0'), .before = chunk("PLTE", "abcdef")},
                  "has a pixel that is coloured (column 0, row 0), needs only grey, opaque pixels");
    check_refused({.lines = {0, 1, 2}}, "is a damaged PNG image: Not enough image data");
    check_refused({.cols = 0, .lines = {0, 0}}, "is a damaged PNG image: Invalid IHDR data");
    check_refused({.cols = 1000000, .rows = 1000000, .lines = {0}},
                  "has 1000000 x 1000000 pixels, needs at most 1073741824");

    const std::string good = png_bytes({.lines = {0, 1, 2, 0, 3, 4}});
    folder.write("a.png", good.substr(0, good.size() - 20));
    CHECK_THROWS_WITH(read_grey_png(folder / "a.png"), file + "is a damaged PNG image: cut short");
    std::string bad = good;
    bad[good.size() - 13] ^= 1;  // the last byte of the checksum before IEND
    folder.write("a.png", bad);
    CHECK_THROWS_WITH(read_grey_png(folder / "a.png"), file + "is a damaged PNG image: IDAT: CRC error");
}

TEST_CASE("PNG images are written as OpenCV reads them")
{
    const TempFolder folder;
    constexpr int rows = 31, cols = 45;
    std::vector<std::uint8_t> colours(3 * rows * cols);
    std::vector<std::uint16_t> greys(rows * cols);
    for (std::size_t i = 0; i < colours.size(); ++i) colours[i] = std::uint8_t(i * i);
    for (std::size_t i = 0; i < greys.size(); ++i) greys[i] = std::uint16_t(i * i * i);
    write_bgr_png(folder / "colour.png", rows, cols, colours.data());
    write_grey_png(folder / "grey.png", rows, cols, greys.data());
    const cv::Mat colour = cv::imread((folder / "colour.png").string(), cv::IMREAD_UNCHANGED);
    const cv::Mat grey = cv::imread((folder / "grey.png").string(), cv::IMREAD_UNCHANGED);
    REQUIRE((colour.type() == CV_8UC3 && colour.rows == rows && colour.cols == cols));
    REQUIRE((grey.type() == CV_16UC1 && grey.rows == rows && grey.cols == cols));
    CHECK(std::equal(colours.begin(), colours.end(), colour.data));
    CHECK(std::equal(greys.begin(), greys.end(), grey.ptr<std::uint16_t>()));
    CHECK(read_grey_png(folder / "grey.png").pixels == Pixels(greys.begin(), greys.end()));
    const std::string far = (folder / "none/a.png").string();
    CHECK_THROWS_WITH(write_bgr_png(far, rows, cols, colours.data()),
                      far + ": cannot be written: No such file or directory");
    CHECK_THROWS_WITH(write_grey_png(folder / "wide.png", 1, 1000001, greys.data()),
                      (folder / "wide.png").string() +
                          ": cannot be written as PNG: it has 1000001 x 1 pixels, needs 1 to 1000000 along each side");
}

#include "base/png.h"

#include "base/deflate.h"
#include "base/input_file.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

#include <libdeflate.h>
#include <png.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

// libpng reports errors with longjmp, which skips destructors. So the functions that call setjmp, and those that libpng
// calls back, have only local variables without destructors. Their callers own everything else.
namespace spawnfield {
namespace {

struct Message {
    char text[100] = "";
};

[[noreturn]] void on_error(png_structp png, png_const_charp text)
{
    auto& message = *static_cast<Message*>(png_get_error_ptr(png));
    std::snprintf(message.text, sizeof message.text, "%s", text);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

class PngReader {
public:
    explicit PngReader(std::string_view bytes) : remaining_(bytes)
    {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message_, on_error, on_warning);
        if (png_) info_ = png_create_info_struct(png_);
        if (!info_) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, &remaining_, read_bytes);
    }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

    bool read_header()
    {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_info(png_, info_);
        return true;
    }

    /// Sets up the conversion of each sample to whole bytes. With in_full, palettes become colours, and transparency
    /// alpha.
    bool prepare(bool in_full)
    {
        if (setjmp(png_jmpbuf(png_))) return false;
        if (in_full)
            png_set_expand(png_);
        else
            png_set_expand_gray_1_2_4_to_8(png_);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }

    bool read_rows(png_bytepp rows)
    {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_image(png_, rows);
        png_read_end(png_, nullptr);
        return true;
    }

    int rows() const { return int(png_get_image_height(png_, info_)); }
    int cols() const { return int(png_get_image_width(png_, info_)); }
    int channels() const { return png_get_channels(png_, info_); }
    int bits() const { return png_get_bit_depth(png_, info_); }
    bool has_palette() const { return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE; }
    const char* message() const { return message_.text; }

private:
    static void read_bytes(png_structp png, png_bytep to, std::size_t count)
    {
        auto& remaining = *static_cast<std::string_view*>(png_get_io_ptr(png));
        if (count > remaining.size()) png_error(png, "cut short");
        std::memcpy(to, remaining.data(), count);
        remaining.remove_prefix(count);
    }

    std::string_view remaining_;
    Message message_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

void append_big_endian(std::string& out, std::uint32_t value)
{
    for (int shift = 24; shift >= 0; shift -= 8) out += char(value >> shift & 0xff);
}

void append_chunk(std::string& out, const char* type, std::string_view data)
{
    append_big_endian(out, std::uint32_t(data.size()));
    const std::size_t start = out.size();
    out.append(type, 4).append(data);
    append_big_endian(out, libdeflate_crc32(0, out.data() + start, out.size() - start));
}

/// Returns a PNG file whose rows are all stored as differences from the row above (filter 2), which suits heights and
/// pictures. The bytes are compressed with libdeflate, three times as fast as libpng, which uses zlib. put_row(row,
/// out) writes the bytes of one row.
template <class PutRow>
std::string png_bytes(const std::string& name, int rows, int cols, int bits, int colour, std::size_t row_bytes,
                      const PutRow& put_row)
{
    constexpr int most = 1000000;  // libpng's limit for reading
    if (rows < 1 || cols < 1 || rows > most || cols > most)
        throw OutputError(name, "cannot be written as PNG: it has " + std::to_string(cols) + " x " +
                                    std::to_string(rows) + " pixels, needs 1 to " + std::to_string(most) +
                                    " along each side");
    const std::size_t count = std::size_t(rows);
    std::string filtered(count * (row_bytes + 1), '\2');
    std::vector<std::uint8_t> above(row_bytes), here(row_bytes);
    for (std::size_t row = 0; row < count; ++row) {
        put_row(row, here.data());
        char* const out = filtered.data() + row * (row_bytes + 1) + 1;
        for (std::size_t byte = 0; byte < row_bytes; ++byte) out[byte] = char(here[byte] - above[byte]);
        std::swap(here, above);
    }
    const std::string pixels = deflate_bytes(filtered);
    if (pixels.size() > PNG_UINT_31_MAX)
        throw OutputError(name, "cannot be written as PNG: its pixels need more than 2 GB");
    std::string head, bytes = "\x89PNG\r\n\x1a\n";
    append_big_endian(head, std::uint32_t(cols));
    append_big_endian(head, std::uint32_t(rows));
    head += {char(bits), char(colour), PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT, PNG_INTERLACE_NONE};
    append_chunk(bytes, "IHDR", head);
    append_chunk(bytes, "IDAT", pixels);
    append_chunk(bytes, "IEND", {});
    return bytes;
}

}  // namespace

bool is_png(std::string_view start)
{
    return start.size() >= 8 && png_sig_cmp(reinterpret_cast<png_const_bytep>(start.data()), 0, 8) == 0;
}

namespace {

using PngBytes = std::unique_ptr<png_byte[]>;

void require(bool good, const PngReader& reader, const std::string& file)
{
    if (!good) throw FileError(file, std::string("is a damaged PNG image: ") + reader.message());
}

void check_size(const PngReader& reader, const std::string& file, std::uint64_t most)
{
    if (std::uint64_t(reader.rows()) * std::uint64_t(reader.cols()) > most)
        throw FileError(file, "has " + std::to_string(reader.cols()) + " x " + std::to_string(reader.rows()) +
                                  " pixels, needs at most " + std::to_string(most));
}

/// Reads all samples, of one byte or two, row after row. The reader must be prepared.
PngBytes read_samples(PngReader& reader, const std::string& file)
{
    const std::size_t rows = std::size_t(reader.rows());
    const std::size_t row_bytes = std::size_t(reader.cols()) * std::size_t(reader.channels()) *
                                  (reader.bits() == 16 ? 2 : 1);
    // The memory is not cleared, so that a damaged header with a giant image size costs almost nothing.
    PngBytes data = std::make_unique_for_overwrite<png_byte[]>(rows * row_bytes);
    const auto starts = std::make_unique_for_overwrite<png_bytep[]>(rows);
    for (std::size_t row = 0; row < rows; ++row) starts[row] = data.get() + row * row_bytes;
    require(reader.read_rows(starts.get()), reader, file);
    return data;
}

std::uint16_t sample(const PngBytes& data, std::size_t i, bool wide)
{
    return wide ? std::uint16_t(data[2 * i] * 256 + data[2 * i + 1]) : data[i];
}

/// Converts an image that is stored with colours or alpha. Throws FileError unless all pixels are grey and opaque.
GreyImage grey_of(const ColourImage& image, const std::string& file)
{
    GreyImage grey{image.rows, image.cols, double(image.largest), {}};
    grey.pixels.reserve(image.samples.size() / std::size_t(image.channels));
    const bool has_alpha = image.channels % 2 == 0;
    const std::size_t colours = std::size_t(image.channels - has_alpha);
    for (std::size_t i = 0; i < image.samples.size(); i += std::size_t(image.channels)) {
        const std::uint16_t* const pixel = &image.samples[i];
        const auto refuse = [&](const char* what) {
            const std::size_t index = grey.pixels.size(), cols = std::size_t(image.cols);
            throw FileError(file, "has a pixel that is " + std::string(what) + " (column " +
                                      std::to_string(index % cols) + ", row " + std::to_string(index / cols) +
                                      "), needs only grey, opaque pixels");
        };
        if (std::any_of(pixel + 1, pixel + colours, [&](std::uint16_t value) { return value != pixel[0]; }))
            refuse("coloured");
        if (has_alpha && pixel[colours] != image.largest) refuse("transparent");
        grey.pixels.push_back(pixel[0]);
    }
    return grey;
}

}  // namespace

GreyImage read_grey_png(const std::filesystem::path& path, std::uint64_t most)
{
    const std::string bytes = read_file(path), file = path.string();
    PngReader reader(bytes);
    require(reader.read_header(), reader, file);
    if (reader.has_palette() || reader.channels() != 1) return grey_of(read_colour_png(path, most), file);
    check_size(reader, file, most);
    require(reader.prepare(false), reader, file);
    const PngBytes data = read_samples(reader, file);
    const bool wide = reader.bits() == 16;
    GreyImage image{reader.rows(), reader.cols(), wide ? 65535.0 : 255.0, {}};
    image.pixels.resize(std::size_t(image.rows) * std::size_t(image.cols));
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = sample(data, i, wide);
    return image;
}

ColourImage read_colour_png(const std::filesystem::path& path, std::uint64_t most)
{
    const std::string bytes = read_file(path), file = path.string();
    PngReader reader(bytes);
    require(reader.read_header(), reader, file);
    check_size(reader, file, most);
    require(reader.prepare(true), reader, file);
    const PngBytes data = read_samples(reader, file);
    const bool wide = reader.bits() == 16;
    ColourImage image{reader.rows(), reader.cols(), reader.channels(), wide ? 65535 : 255, {}};
    image.samples.resize(std::size_t(image.rows) * std::size_t(image.cols) * std::size_t(image.channels));
    for (std::size_t i = 0; i < image.samples.size(); ++i) image.samples[i] = sample(data, i, wide);
    return image;
}

std::string bgr_png(const std::string& name, int rows, int cols, const std::uint8_t* pixels)
{
    const std::size_t row_bytes = 3 * std::size_t(cols);
    return png_bytes(name, rows, cols, 8, PNG_COLOR_TYPE_RGB, row_bytes, [&](std::size_t row, std::uint8_t* out) {
        const std::uint8_t* const from = pixels + row * row_bytes;
        for (std::size_t byte = 0; byte < row_bytes; byte += 3) {
            out[byte] = from[byte + 2];
            out[byte + 1] = from[byte + 1];
            out[byte + 2] = from[byte];
        }
    });
}

void write_bgr_png(const std::filesystem::path& file, int rows, int cols, const std::uint8_t* pixels)
{
    write_file_atomically(file, bgr_png(file.string(), rows, cols, pixels));
}

void write_grey_png(const std::filesystem::path& file, int rows, int cols, const std::uint16_t* pixels)
{
    const auto put_row = [&](std::size_t row, std::uint8_t* out) {
        const std::uint16_t* const from = pixels + row * std::size_t(cols);
        for (std::size_t col = 0; col < std::size_t(cols); ++col) {
            out[2 * col] = std::uint8_t(from[col] >> 8);
            out[2 * col + 1] = std::uint8_t(from[col]);
        }
    };
    const std::size_t row_bytes = 2 * std::size_t(cols);
    write_file_atomically(file, png_bytes(file.string(), rows, cols, 16, PNG_COLOR_TYPE_GRAY, row_bytes, put_row));
}

}  // namespace spawnfield

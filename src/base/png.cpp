#include "base/png.h"

#include "base/input_file.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

#include <png.h>
#include <zlib.h>

#include <bit>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string>

// libpng reports errors with longjmp. The functions that set the place to jump back to, and those that libpng calls,
// hold plain data only, so that no destructor is jumped over; what has one lives in their callers.
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

class Reader {
public:
    explicit Reader(std::string_view bytes) : left_(bytes)
    {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message_, on_error, on_warning);
        if (png_) info_ = png_create_info_struct(png_);
        if (!info_) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, &left_, take);
    }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }

    bool read_header()
    {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_read_info(png_, info_);
        return true;
    }

    bool prepare()  ///< whole bytes for each pixel
    {
        if (setjmp(png_jmpbuf(png_))) return false;
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
    static void take(png_structp png, png_bytep to, std::size_t count)
    {
        auto& left = *static_cast<std::string_view*>(png_get_io_ptr(png));
        if (count > left.size()) png_error(png, "cut short");
        std::memcpy(to, left.data(), count);
        left.remove_prefix(count);
    }

    std::string_view left_;
    Message message_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

class Writer {
public:
    Writer()
    {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message_, on_error, on_warning);
        if (png_) info_ = png_create_info_struct(png_);
        if (!info_) {
            png_destroy_write_struct(&png_, nullptr);
            throw std::bad_alloc();
        }
        png_set_write_fn(png_, &bytes_, append, nullptr);
    }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { png_destroy_write_struct(&png_, &info_); }

    /// Fast rather than small, and one filter for all rows: what libpng would choose may differ between its versions.
    bool write(int rows, int cols, int bits, int colour, const png_byte* pixels, std::size_t row_bytes)
    {
        if (setjmp(png_jmpbuf(png_))) return false;
        png_set_IHDR(png_, info_, png_uint_32(cols), png_uint_32(rows), bits, colour, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
        png_set_compression_level(png_, Z_BEST_SPEED);
        png_set_compression_strategy(png_, Z_DEFAULT_STRATEGY);
        png_write_info(png_, info_);
        if (colour == PNG_COLOR_TYPE_RGB) png_set_bgr(png_);
        if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
        for (std::size_t row = 0; row < std::size_t(rows); ++row) png_write_row(png_, pixels + row * row_bytes);
        png_write_end(png_, nullptr);
        return true;
    }

    const std::string& bytes() const { return bytes_; }
    const char* message() const { return message_.text; }

private:
    static void append(png_structp png, png_bytep from, std::size_t count)
    {
        if (!appended(*static_cast<std::string*>(png_get_io_ptr(png)), from, count)) png_error(png, "no memory is left");
    }

    static bool appended(std::string& bytes, const png_byte* from, std::size_t count) noexcept
    {
        try {
            bytes.append(reinterpret_cast<const char*>(from), count);
            return true;
        } catch (const std::bad_alloc&) {
            return false;
        }
    }

    std::string bytes_;
    Message message_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

void write_png(const std::filesystem::path& file, int rows, int cols, int bits, int colour, const void* pixels, std::size_t row_bytes)
{
    Writer writer;
    if (!writer.write(rows, cols, bits, colour, static_cast<const png_byte*>(pixels), row_bytes))
        throw OutputError(file.string(), std::string("cannot be written as PNG: ") + writer.message());
    write_file_atomically(file, writer.bytes());
}

}  // namespace

bool is_png(std::string_view start)
{
    return start.size() >= 8 && png_sig_cmp(reinterpret_cast<png_const_bytep>(start.data()), 0, 8) == 0;
}

GreyImage read_grey_png(const std::filesystem::path& file)
{
    const std::string bytes = read_file(file);
    Reader reader(bytes);
    const auto require = [&](bool good) {
        if (!good) throw FileError(file.string(), std::string("is a damaged PNG image: ") + reader.message());
    };
    require(reader.read_header());
    if (reader.has_palette()) throw FileError(file.string(), "has a palette, needs 1 channel (grey)");
    if (reader.channels() != 1)
        throw FileError(file.string(), "has " + std::to_string(reader.channels()) + " channels, needs 1 (grey)");
    if (std::uint64_t(reader.rows()) * std::uint64_t(reader.cols()) > max_pixels)
        throw FileError(file.string(), "has " + std::to_string(reader.cols()) + " x " + std::to_string(reader.rows()) + " pixels, needs at most " +
                                           std::to_string(max_pixels));
    require(reader.prepare());

    const std::size_t rows = std::size_t(reader.rows()), row_pixels = std::size_t(reader.cols());
    const std::size_t pixel_bytes = reader.bits() == 16 ? 2 : 1, row_bytes = row_pixels * pixel_bytes;
    // Not cleared, so that a damaged header which tells of a giant costs nothing.
    const auto data = std::make_unique_for_overwrite<png_byte[]>(rows * row_bytes);
    const auto starts = std::make_unique_for_overwrite<png_bytep[]>(rows);
    for (std::size_t row = 0; row < rows; ++row) starts[row] = data.get() + row * row_bytes;
    require(reader.read_rows(starts.get()));

    GreyImage image{reader.rows(), reader.cols(), pixel_bytes == 2 ? 65535.0 : 255.0, {}};
    image.pixels.resize(rows * row_pixels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = pixel_bytes == 2 ? data[2 * i] * 256 + data[2 * i + 1] : data[i];
    return image;
}

void write_bgr_png(const std::filesystem::path& file, int rows, int cols, const std::uint8_t* pixels)
{
    write_png(file, rows, cols, 8, PNG_COLOR_TYPE_RGB, pixels, 3 * std::size_t(cols));
}

void write_grey_png(const std::filesystem::path& file, int rows, int cols, const std::uint16_t* pixels)
{
    write_png(file, rows, cols, 16, PNG_COLOR_TYPE_GRAY, pixels, 2 * std::size_t(cols));
}

}  // namespace spawnfield

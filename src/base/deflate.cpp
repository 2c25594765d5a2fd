#include "base/deflate.h"

#include <libdeflate.h>

#include <bit>
#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>

namespace spawnfield {
namespace {

constexpr int fast = 1, small = 9;  // levels

template <auto release>
struct Releaser {
    void operator()(auto* object) const { release(object); }
};
using Compressor = std::unique_ptr<libdeflate_compressor, Releaser<libdeflate_free_compressor>>;
using Decompressor = std::unique_ptr<libdeflate_decompressor, Releaser<libdeflate_free_decompressor>>;

void inflate_into(std::string_view stream, char* out, std::size_t size)
{
    thread_local const Decompressor decompressor(libdeflate_alloc_decompressor());
    if (!decompressor) throw std::bad_alloc();
    if (libdeflate_zlib_decompress(decompressor.get(), stream.data(), stream.size(), out, size, nullptr) !=
        LIBDEFLATE_SUCCESS)
        throw std::runtime_error("a compressed tile is damaged");
}

/// Calls the functions of libdeflate for a format.
template <int level = fast, class Bound, class Compress>
std::string compressed(std::string_view bytes, const Bound& bound_of, const Compress& compress)
{
    thread_local const Compressor compressor(libdeflate_alloc_compressor(level));
    if (!compressor) throw std::bad_alloc();
    const std::size_t bound = bound_of(compressor.get(), bytes.size());
    const auto out = std::make_unique_for_overwrite<char[]>(bound);
    const std::size_t size = compress(compressor.get(), bytes.data(), bytes.size(), out.get(), bound);
    if (size == 0) throw std::runtime_error("libdeflate cannot compress");
    return {out.get(), size};
}

}  // namespace

std::string deflate_bytes(std::string_view bytes)
{
    return compressed(bytes, libdeflate_zlib_compress_bound, libdeflate_zlib_compress);
}

std::string deflate_small(std::string_view bytes)
{
    return compressed<small>(bytes, libdeflate_zlib_compress_bound, libdeflate_zlib_compress);
}

std::string gzip_bytes(std::string_view bytes)
{
    return compressed(bytes, libdeflate_gzip_compress_bound, libdeflate_gzip_compress);
}

std::string inflate_bytes(std::string_view stream, std::size_t size)
{
    std::string out(size, '\0');
    inflate_into(stream, out.data(), size);
    return out;
}

std::string deflate_floats(std::span<const float> values, std::size_t cols)
{
    const auto bytes = std::make_unique_for_overwrite<char[]>(values.size_bytes());
    for (std::size_t first = 0; first < values.size(); first += cols) {
        auto* const row = reinterpret_cast<std::uint8_t*>(bytes.get()) + first * sizeof(float);
        for (std::size_t col = 0; col < cols; ++col) {
            const auto bits = std::bit_cast<std::uint32_t>(values[first + col]);
            for (std::size_t plane = 0; plane < 4; ++plane)
                row[plane * cols + col] = std::uint8_t(bits >> (24 - 8 * plane));
        }
        for (std::size_t byte = 4 * cols - 1; byte > 0; --byte) row[byte] = std::uint8_t(row[byte] - row[byte - 1]);
    }
    return deflate_bytes({bytes.get(), values.size_bytes()});
}

void inflate_floats(std::string_view stream, std::size_t cols, std::span<float> values)
{
    const auto bytes = std::make_unique_for_overwrite<char[]>(values.size_bytes());
    inflate_into(stream, bytes.get(), values.size_bytes());
    for (std::size_t first = 0; first < values.size(); first += cols) {
        auto* const row = reinterpret_cast<std::uint8_t*>(bytes.get()) + first * sizeof(float);
        for (std::size_t byte = 1; byte < 4 * cols; ++byte) row[byte] = std::uint8_t(row[byte] + row[byte - 1]);
        for (std::size_t col = 0; col < cols; ++col) {
            std::uint32_t bits = 0;
            for (std::size_t plane = 0; plane < 4; ++plane) bits = bits << 8 | row[plane * cols + col];
            values[first + col] = std::bit_cast<float>(bits);
        }
    }
}

}  // namespace spawnfield

#pragma once

#include <span>
#include <string>
#include <string_view>

namespace spawnfield {

/// Returns the bytes as a zlib stream (RFC 1950), compressed for speed rather than size. Equal bytes give equal
/// streams.
std::string deflate_bytes(std::string_view bytes);

/// The same, compressed for size rather than speed.
std::string deflate_small(std::string_view bytes);

/// Returns the bytes as a gzip file (RFC 1952) without a name and a time. Equal bytes give equal files.
std::string gzip_bytes(std::string_view bytes);

/// Returns the bytes of a zlib stream. Throws std::runtime_error unless it is complete and contains exactly `size`
/// bytes.
std::string inflate_bytes(std::string_view stream, std::size_t size);

/// Compresses rows of `cols` numbers as in TIFF's predictor 3. Each row is reordered: first the highest byte of every
/// number, then the second highest, and so on. Then each byte is replaced by its difference from the byte before.
/// Similar neighbours become zeros. Source: Adobe, TIFF Technical Note 3, 2005.
std::string deflate_floats(std::span<const float> values, std::size_t cols);

/// Fills `values` from a stream of deflate_floats(). Throws std::runtime_error unless the stream is complete and
/// contains exactly that many numbers.
void inflate_floats(std::string_view stream, std::size_t cols, std::span<float> values);

}  // namespace spawnfield

#pragma once

#include <span>
#include <string>
#include <string_view>

namespace spawnfield {

/// A zlib stream (RFC 1950), fast rather than small. Same bytes, same stream.
std::string deflate_bytes(std::string_view bytes);

/// Throws std::runtime_error unless the stream is whole and holds exactly `size` bytes.
std::string inflate_bytes(std::string_view stream, std::size_t size);

/// Rows of `cols` numbers as TIFF's predictor 3 has them: of each row first the highest bytes, then the next, and of
/// all of these the differences. Neighbours that are alike become zeros. Source: Adobe, TIFF Technical Note 3, 2005.
std::string deflate_floats(std::span<const float> values, std::size_t cols);

/// Fills `values`. Throws std::runtime_error unless the stream is whole and holds as many.
void inflate_floats(std::string_view stream, std::size_t cols, std::span<float> values);

}  // namespace spawnfield

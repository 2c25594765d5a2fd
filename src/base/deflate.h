#pragma once

#include <string>
#include <string_view>

namespace spawnfield {

/// A zlib stream (RFC 1950) at its fastest level.
std::string deflate_bytes(std::string_view bytes);

/// Throws std::runtime_error unless the stream is whole and holds exactly `size` bytes.
std::string inflate_bytes(std::string_view stream, std::size_t size);

}  // namespace spawnfield

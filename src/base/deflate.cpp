#include "base/deflate.h"

#include <zlib.h>

#include <stdexcept>

namespace spawnfield {

std::string deflate_bytes(std::string_view bytes)
{
    uLongf size = compressBound(uLong(bytes.size()));
    std::string out(size, '\0');
    const int status = compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                                 uLong(bytes.size()), Z_BEST_SPEED);
    if (status != Z_OK) throw std::runtime_error("zlib cannot compress");
    out.resize(size);
    return out;
}

std::string inflate_bytes(std::string_view stream, std::size_t size)
{
    uLongf found = uLongf(size);
    std::string out(size, '\0');
    const int status = uncompress(reinterpret_cast<Bytef*>(out.data()), &found, reinterpret_cast<const Bytef*>(stream.data()),
                                  uLong(stream.size()));
    if (status != Z_OK || found != size) throw std::runtime_error("a compressed tile is damaged");
    return out;
}

}  // namespace spawnfield

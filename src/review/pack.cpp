#include "review/pack.h"

#include "base/deflate.h"

#include <meshoptimizer.h>

namespace spawnfield {

static_assert(std::endian::native == std::endian::little, "packs are little-endian");

Json PackWriter::add(const char* type, std::size_t count, std::size_t width, const char* coding, std::string_view bytes)
{
    const std::string stream = is_fast_ ? deflate_bytes(bytes) : deflate_small(bytes);
    Json out{{"type", type}, {"count", count}};
    if (width != 1) out["width"] = width;
    out["coding"] = coding;
    out["at"] = blocks_.size();
    out["bytes"] = stream.size();
    blocks_ += stream;
    return out;
}

Json PackWriter::corners(std::span<const std::array<std::uint16_t, 4>> corners)
{
    constexpr std::size_t size = sizeof(corners[0]);
    meshopt_encodeVertexVersion(0);
    std::string bytes(meshopt_encodeVertexBufferBound(corners.size(), size), '\0');
    bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(),
                                            corners.data(), corners.size(), size));
    return add("u16", corners.size(), 4, "vertex", bytes);
}

Json PackWriter::triangles(std::span<const std::uint32_t> indices, std::size_t corners)
{
    meshopt_encodeIndexVersion(1);
    std::string bytes(meshopt_encodeIndexBufferBound(indices.size(), corners), '\0');
    bytes.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), indices.data(),
                                           indices.size()));
    return add("u32", indices.size(), 1, "index", bytes);
}

std::string PackWriter::finish(const Json& head) const
{
    const std::string json = json_text(head, -1);
    const auto length = std::uint32_t(json.size());
    return "SPAWNRV1" + std::string(reinterpret_cast<const char*>(&length), sizeof length) + json + blocks_;
}

}  // namespace spawnfield

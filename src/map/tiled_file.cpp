#include "map/tiled_file.h"

#include "base/binary.h"
#include "base/checksum.h"

#include <spawnfield/error.h>

namespace spawnfield {
namespace {

constexpr std::size_t alignment = 64;
constexpr std::size_t fixed_size = 24;  // magic, version, 0, size of the head

}  // namespace

std::string tiled_head(std::string_view magic, std::uint32_t version, const std::string& head)
{
    BinaryWriter fixed;
    fixed.put(version);
    fixed.put(std::uint32_t{0});
    const std::size_t size = (fixed_size + head.size() + alignment - 1) / alignment * alignment;
    fixed.put(std::uint64_t(size));
    std::string out = std::string(magic) + fixed.take() + head;
    out.resize(size, '\0');
    return out;
}

TiledFile open_tiled(const std::filesystem::path& file, std::string_view magic, std::uint32_t version,
                     const std::string& head_sum)
{
    const Bytes bytes = map_file(file);
    if (!bytes.view.starts_with(magic) || bytes.view.size() < fixed_size)
        throw FileError(file.string(), "is not the file that map.yaml lists (it does not start with " +
                                           std::string(magic) + "); bake the map again");
    BinaryReader fixed(bytes.view.substr(magic.size()));
    if (const auto found = fixed.get<std::uint32_t>(); found != version)
        throw FileError(file.string(), "has format version " + std::to_string(found) + ", this program reads " +
                                           std::to_string(version) + "; bake the map again");
    fixed.get<std::uint32_t>();
    const auto size = fixed.get<std::uint64_t>();
    if (size < fixed_size || size > bytes.view.size())
        throw FileError(file.string(), "is cut short; bake the map again");
    if (checksum(bytes.view.substr(0, size)) != head_sum)
        throw FileError(file.string(),
                        "is damaged (the checksum of its head differs from map.yaml's); bake the map again");
    return {std::string(bytes.view.substr(fixed_size, size - fixed_size)), bytes.part(size, bytes.view.size() - size)};
}

std::string head_checksum(std::string_view bytes)
{
    if (!bytes.starts_with("SPAWN") || bytes.size() < fixed_size) return {};
    const auto size = BinaryReader(bytes.substr(fixed_size - 8)).get<std::uint64_t>();
    return checksum(bytes.substr(0, size));
}

}  // namespace spawnfield

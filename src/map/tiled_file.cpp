#include "map/tiled_file.h"

#include "base/checksum.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

#include <algorithm>

namespace spawnfield {
namespace {

constexpr std::size_t fixed_size = 24;  // bytes: magic, version, 0, size of the head

/// Returns whether the levels are valid and every tile lies within the bytes. A file with correct checksums may still
/// come from another program.
bool is_consistent(const TileStore& store)
{
    constexpr std::uint32_t most = 1u << 30;  // cells along one side
    const auto is_within = [&](const TileEntry& tile) {
        const std::size_t size = store.bytes().size();
        return tile.offset % 8 == 0 && tile.offset <= size && tile.size <= size - tile.offset;
    };
    const auto is_valid = [&](const TileLevel& level) {
        return level.cell > 0 && level.cols > 0 && level.cols <= most && level.rows > 0 && level.rows <= most &&
               level.tiles.size() == std::uint64_t{level.tile_cols} * level.tile_rows &&
               std::all_of(level.tiles.begin(), level.tiles.end(), is_within);
    };
    return std::all_of(store.levels().begin(), store.levels().end(), is_valid);
}

}  // namespace

void put_levels(BinaryWriter& head, const std::vector<TileLevel>& levels)
{
    head.put(std::uint32_t(levels.size()));
    for (const TileLevel& level : levels) {
        head.put(level.cell);
        head.put(level.cols);
        head.put(level.rows);
        head.put_array(level.tiles);
    }
}

std::vector<TileLevel> get_levels(BinaryReader& head, std::uint32_t tile_side)
{
    std::vector<TileLevel> levels;
    for (auto count = head.get<std::uint32_t>(); count > 0; --count) {
        const auto cell = head.get<double>();
        const auto cols = head.get<std::uint32_t>(), rows = head.get<std::uint32_t>();
        levels.emplace_back(cell, cols, rows, tile_side).tiles = head.get_array<TileEntry>();
    }
    return levels;
}

ListedFile write_tiled(const std::filesystem::path& file, const TiledFormat& format, const std::string& head,
                       const TileStore& tiles)
{
    BinaryWriter fixed;
    fixed.put(format.version);
    fixed.put(std::uint32_t{0});
    const std::size_t size = (fixed_size + head.size() + tile_alignment - 1) / tile_alignment * tile_alignment;
    fixed.put(std::uint64_t(size));
    std::string start = std::string(format.magic) + fixed.take() + head;
    start.resize(size, '\0');
    OutputFile out(file);
    out.write(start);
    out.write(tiles.bytes());
    out.commit();
    return {file.filename().string(), checksum({start, tiles.bytes()}), checksum(start),
            start.size() + tiles.bytes().size()};
}

TileStore open_tiled(const std::filesystem::path& file, const TiledFormat& format, const std::string& head_checksum,
                     const std::function<std::vector<TileLevel>(BinaryReader&)>& read_head)
{
    const Bytes bytes = map_file(file);
    if (!bytes.view.starts_with(format.magic) || bytes.view.size() < fixed_size)
        throw FileError(file.string(), "is not the file that map.yaml lists (it does not start with " +
                                           std::string(format.magic) + "); bake the map again");
    BinaryReader fixed(bytes.view.substr(format.magic.size()));
    if (const auto found = fixed.get<std::uint32_t>(); found != format.version)
        throw FileError(file.string(), "has format version " + std::to_string(found) + ", this program reads " +
                                           std::to_string(format.version) + "; bake the map again");
    fixed.get<std::uint32_t>();
    const auto size = fixed.get<std::uint64_t>();
    if (size < fixed_size || size > bytes.view.size())
        throw FileError(file.string(), "is cut short; bake the map again");
    if (checksum(bytes.view.substr(0, size)) != head_checksum)
        throw FileError(file.string(),
                        "is damaged (the checksum of its head differs from map.yaml's); bake the map again");
    BinaryReader head(bytes.view.substr(fixed_size, size - fixed_size));
    try {
        TileStore store(read_head(head), bytes.part(size, bytes.view.size() - size), file.string());
        if (!is_consistent(store)) store.fail_inconsistent();
        return store;
    } catch (const std::out_of_range&) {
        throw FileError(file.string(), "is cut short; bake the map again");
    }
}

}  // namespace spawnfield

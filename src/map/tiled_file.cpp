#include "map/tiled_file.h"

#include "base/checksum.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr std::size_t prefix_size = 24;  // bytes: magic word, version, 0, size of the head

/// Returns whether each level is valid by itself and every tile lies within the bytes. A file with correct checksums
/// may still come from another program.
bool has_valid_levels(const TileStore& store)
{
    constexpr std::uint32_t max_cells = 1u << 30;  // along one side
    const auto is_within = [&](const TileEntry& tile) {
        const std::size_t size = store.bytes().size();
        return tile.offset % tile_alignment == 0 && tile.offset <= size && tile.size <= size - tile.offset;
    };
    const auto is_valid = [&](const TileLevel& level) {
        return level.cell > 0 && std::isfinite(level.cell) && level.cols > 0 && level.cols <= max_cells &&
               level.rows > 0 && level.rows <= max_cells &&
               level.tiles.size() == std::uint64_t{level.tile_cols} * level.tile_rows &&
               std::all_of(level.tiles.begin(), level.tiles.end(), is_within);
    };
    return std::all_of(store.levels().begin(), store.levels().end(), is_valid);
}

}  // namespace

void put_levels(BinaryWriter& content, const std::vector<TileLevel>& levels)
{
    content.put(std::uint32_t(levels.size()));
    for (const TileLevel& level : levels) {
        content.put(level.cell);
        content.put(level.cols);
        content.put(level.rows);
        content.put_array(level.tiles);
    }
}

std::vector<TileLevel> get_levels(BinaryReader& content, std::uint32_t tile_side)
{
    std::vector<TileLevel> levels;
    for (auto count = content.get<std::uint32_t>(); count > 0; --count) {
        const auto cell = content.get<double>();
        const auto cols = content.get<std::uint32_t>(), rows = content.get<std::uint32_t>();
        TileLevel level(cell, cols, rows, tile_side);
        level.tiles = content.get_array<TileEntry>();
        levels.push_back(std::move(level));
    }
    return levels;
}

ListedFile write_tiled(const std::filesystem::path& file, const TiledFormat& format, const std::string& content,
                       const TileStore& tiles)
{
    BinaryWriter prefix;  // without the magic word
    prefix.put(format.version);
    prefix.put(std::uint32_t{0});
    const std::size_t size = (prefix_size + content.size() + tile_alignment - 1) / tile_alignment * tile_alignment;
    prefix.put(std::uint64_t(size));
    std::string head = std::string(format.magic) + prefix.take() + content;
    head.resize(size, '\0');
    OutputFile out(file);
    out.write(head);
    out.write(tiles.bytes());
    out.commit();
    return {file.filename().string(), checksum({head, tiles.bytes()}), checksum(head),
            head.size() + tiles.bytes().size()};
}

TileStore open_tiled(const std::filesystem::path& file, const TiledFormat& format, const std::string& head_checksum,
                     const std::function<std::vector<TileLevel>(BinaryReader&, std::uint32_t)>& read_content)
{
    const Bytes bytes = map_file(file);
    const auto fail = [&](const std::string& what) { throw FileError(file.string(), what + "; bake the map again"); };
    if (!bytes.view.starts_with(format.magic))
        fail("is not the file that map.yaml lists (it does not start with " + std::string(format.magic) + ")");
    if (bytes.view.size() < prefix_size) fail("is cut short");
    BinaryReader prefix(bytes.view.substr(format.magic.size()));
    const auto version = prefix.get<std::uint32_t>();
    if (version < format.oldest_version || version > format.version)
        fail("has format version " + std::to_string(version) + ", this program reads " +
             (format.oldest_version < format.version ? std::to_string(format.oldest_version) + " to " : "") +
             std::to_string(format.version));
    prefix.get<std::uint32_t>();  // always 0
    const auto size = prefix.get<std::uint64_t>();
    if (size < prefix_size || size % tile_alignment != 0) fail("has an invalid size of its head");
    if (size > bytes.view.size()) fail("is cut short");
    if (checksum(bytes.view.substr(0, size)) != head_checksum)
        fail("is damaged (the checksum of its head differs from the one in map.yaml)");
    BinaryReader content(bytes.view.substr(prefix_size, size - prefix_size));
    const Bytes tiles = bytes.part(size, bytes.view.size() - size);
    std::vector<TileLevel> levels;
    try {
        levels = read_content(content, version);
    } catch (const std::out_of_range&) {
        TileStore({}, tiles, file.string()).fail_inconsistent();
    }
    bytes.forget_pages();  // the head of a large map has megabytes, and is not needed any more
    TileStore store(std::move(levels), tiles, file.string());
    if (!has_valid_levels(store)) store.fail_inconsistent();
    return store;
}

}  // namespace spawnfield

#pragma once

#include "base/binary.h"
#include "base/tile_store.h"
#include "map/listed_file.h"

#include <functional>

namespace spawnfield {

/// The kind of a file of the map that queries read tile by tile. Such a file begins with a head: magic (8 bytes), u32
/// version, u32 0, u64 size of the head, then the places and checksums of the tiles, with what else the kind contains.
/// The tiles follow, at multiples of 64 bytes. map.yaml contains the checksum of the head (docs/map-format.md).
struct TiledFormat {
    std::string_view magic;
    std::uint32_t version;
};

/// Appends the levels of a store to the head of a file.
void put_levels(BinaryWriter& head, const std::vector<TileLevel>& levels);

/// Reads what put_levels() wrote. `tile_side` is the number of cells along the side of a tile.
std::vector<TileLevel> get_levels(BinaryReader& head, std::uint32_t tile_side);

/// Writes a file. `head` is its head behind the size. Returns its entry for map.yaml. Throws OutputError.
ListedFile write_tiled(const std::filesystem::path& file, const TiledFormat& format, const std::string& head,
                       const TileStore& tiles);

/// Opens a file. read_head(head) reads the bytes behind the size and returns the levels. Throws FileError for a file
/// that is cut short, altered, of another kind or of another version.
TileStore open_tiled(const std::filesystem::path& file, const TiledFormat& format, const std::string& head_checksum,
                     const std::function<std::vector<TileLevel>(BinaryReader&)>& read_head);

}  // namespace spawnfield

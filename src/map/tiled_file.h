#pragma once

#include "base/binary.h"
#include "base/tile_store.h"
#include "map/listed_file.h"

#include <functional>

namespace spawnfield {

/// The format of geometry.bin or of bounds.bin. Queries read such a file tile by tile. It begins with a head: the magic
/// word (8 bytes), u32 version, u32 0, u64 size of the whole head, then the content of the format, which includes the
/// positions and checksums of all tiles. The head ends with zero bytes up to a multiple of 64 bytes. The tiles follow,
/// each at a multiple of 64 bytes. map.yaml contains the checksum of the head (docs/map-format.md).
struct TiledFormat {
    std::string_view magic;
    std::uint32_t version;         ///< that is written
    std::uint32_t oldest_version;  ///< that is read
};

/// Appends the levels of a store to the content of a head.
void put_levels(BinaryWriter& content, const std::vector<TileLevel>& levels);

/// Reads what put_levels() wrote. `tile_side` is the number of cells along the side of a tile.
std::vector<TileLevel> get_levels(BinaryReader& content, std::uint32_t tile_side);

/// Writes a file, and returns its entry for map.yaml. `content` is the part of the head after its size. Throws
/// OutputError.
ListedFile write_tiled(const std::filesystem::path& file, const TiledFormat& format, const std::string& content,
                       const TileStore& tiles);

/// Opens a file. read_content(content, version) reads what write_tiled() got, and returns the levels. Checks the head:
/// throws FileError for a file that is cut short, of another kind or of another version, or whose head was altered.
/// Each tile is checked when it is opened for the first time.
TileStore open_tiled(const std::filesystem::path& file, const TiledFormat& format, const std::string& head_checksum,
                     const std::function<std::vector<TileLevel>(BinaryReader&, std::uint32_t)>& read_content);

}  // namespace spawnfield

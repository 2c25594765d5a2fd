#pragma once

#include "base/bytes.h"

#include <filesystem>

namespace spawnfield {

/// A file of the map that queries read tile by tile. It begins with a head: magic (8 bytes), u32 version, u32 0, u64
/// size of the head, then the places and checksums of the tiles. The tiles follow, at multiples of 64 bytes. map.yaml
/// contains the checksum of the head.
struct TiledFile {
    std::string head;  ///< without its first 24 bytes
    Bytes tiles;
};

/// Returns the bytes of such a file up to its tiles. `head` is the head without its first 24 bytes.
std::string tiled_head(std::string_view magic, std::uint32_t version, const std::string& head);

/// Opens such a file and reads its head. Throws FileError for a file that is cut short, altered, of another kind or of
/// another version.
TiledFile open_tiled(const std::filesystem::path& file, std::string_view magic, std::uint32_t version,
                     const std::string& head_checksum);

/// Returns the checksum of a tiled file's head; an empty text for other files.
std::string head_checksum(std::string_view bytes);

}  // namespace spawnfield

#pragma once

#include "base/bytes.h"

#include <filesystem>

namespace spawnfield {

/// A file of the map that queries read tile by tile: magic (8 bytes), u32 version, u32 0, u64 size of the head; the
/// rest of the head, which tells where the tiles are; then the tiles, at multiples of 64 bytes. map.yaml holds the
/// head's checksum, the head those of the tiles.
struct TiledFile {
    std::string head;  ///< without its first 24 bytes
    Bytes tiles;
};

/// The bytes of such a file up to its tiles.
std::string tiled_head(std::string_view magic, std::uint32_t version, const std::string& head);

/// Throws FileError for a file that is cut short, altered, of another kind or newer.
TiledFile open_tiled(const std::filesystem::path& file, std::string_view magic, std::uint32_t version,
                     const std::string& head_checksum);

/// Checksum of a tiled file's head, or nothing for another file.
std::string head_checksum(std::string_view bytes);

}  // namespace spawnfield

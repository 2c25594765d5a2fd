#pragma once

#include "base/bytes.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace spawnfield {

constexpr std::size_t tile_alignment = 64;  // bytes: each tile starts at a multiple of it; zero bytes fill up its end

/// The position of a tile in TileStore::bytes(), and the XXH64 hash of its bytes. An empty tile has size 0. Files
/// contain this struct as it is.
struct TileEntry {
    std::uint64_t offset = 0, size = 0, checksum = 0;
};
static_assert(sizeof(TileEntry) == 24);

/// A grid of square cells, cut into square tiles. Row 0 of the cells and of the tiles is the smallest y.
struct TileLevel {
    double cell = 0;                   ///< side of a cell, m
    std::uint32_t cols = 0, rows = 0;  ///< cells
    std::uint32_t tile_cols = 0, tile_rows = 0;
    std::vector<TileEntry> tiles;  ///< row after row

    TileLevel() = default;
    /// Computes the numbers of tiles. `tiles` has no entries yet. `tile_side` is the number of cells along the side of
    /// a tile.
    TileLevel(double cell, std::uint32_t cols, std::uint32_t rows, std::uint32_t tile_side);
};

/// The tiles of several levels, in memory or in a file. A tile of a file is read and checked when it is opened for the
/// first time; tiles in memory are trusted. Any number of threads may open tiles at the same time.
///
/// A tile of a file is used in place, in the mapping, except the first small tiles of a large file: they are copied,
/// until the copies take a quarter of the file's size. With a page, Linux maps up to 15 others around it, so a query of
/// few small tiles, far apart, would use 30 times the memory of their bytes. A copy takes 1 microsecond more. The pages
/// of other tiles of a large file are returned to the system each time that 1 MB of tiles were opened.
class TileStore {
public:
    TileStore() = default;
    /// `file` is the name of the mapped file that contains the bytes. It is empty for bytes in memory, whose tiles are
    /// not checked.
    TileStore(std::vector<TileLevel> levels, Bytes bytes, std::string file = {});

    const std::vector<TileLevel>& levels() const { return levels_; }
    std::string_view bytes() const { return bytes_.view; }

    /// From now on, no tile is copied, and all pages are kept: most of them will be needed.
    void expect_all() const
    {
        if (!opened_) return;
        opened_->bytes_to_copy = 0;
        opened_->forgets_pages = false;
    }

    /// Returns the bytes of a tile; none for an empty tile. They are valid as long as the store lives. The first call
    /// for a tile of a file checks its checksum, and then is_consistent(bytes). If one of them is wrong, it throws
    /// FileError.
    template <class IsConsistent>
    std::string_view open(std::size_t level, std::size_t tile, const IsConsistent& is_consistent) const
    {
        const TileEntry& entry = levels_[level].tiles[tile];
        if (!opened_) return bytes_.view.substr(entry.offset, entry.size);
        if (const char* const known = opened_->tiles[level][tile].load(std::memory_order_acquire))
            return {known, entry.size};
        if (entry.size == 0) return {};
        const std::string_view bytes = fetch(level, tile);
        if (!is_consistent(bytes)) fail_inconsistent();
        return keep(level, tile, bytes);
    }

    /// Returns where a tile is that was opened before; nullptr if it was not.
    const char* opened(std::size_t level, std::size_t tile) const
    {
        if (!opened_) return bytes_.view.data() + levels_[level].tiles[tile].offset;
        return opened_->tiles[level][tile].load(std::memory_order_relaxed);
    }

    /// Throws FileError: the checksums of the file are right, but its values contradict each other.
    [[noreturn]] void fail_inconsistent() const;

private:
    using Block = std::unique_ptr<std::uint64_t[]>;  // aligned like the records in tiles
    /// The tiles of a file that were opened.
    struct Opened {
        std::vector<std::unique_ptr<std::atomic<const char*>[]>> tiles;  ///< of each level; nullptr: not opened yet
        std::atomic<std::size_t> bytes_to_copy;                          ///< limit of further copies
        std::atomic<bool> forgets_pages{false};
        std::atomic<std::size_t> bytes_in_place{0};  ///< opened since pages were returned
        std::mutex mutex;                            ///< for what follows
        std::vector<Block> copies;                   ///< tiles, one after the other
        std::size_t room = 0;                        ///< bytes that are left in the last block

        char* room_for(std::size_t size);
    };

    std::string_view fetch(std::size_t level, std::size_t tile) const;
    std::string_view copy_of(const TileEntry& entry) const;
    void count_in_place(std::size_t size) const;
    std::string_view keep(std::size_t level, std::size_t tile, std::string_view bytes) const;

    std::vector<TileLevel> levels_;
    Bytes bytes_;
    std::string file_;
    std::unique_ptr<Opened> opened_;  ///< empty for a store in memory
};

/// Makes a store in memory, level by level.
class TileStoreBuilder {
public:
    /// `checksum_of_empty` is what the file format stores for an empty tile. Nothing reads it.
    explicit TileStoreBuilder(std::uint64_t checksum_of_empty) : checksum_of_empty_(checksum_of_empty) {}

    const std::vector<TileLevel>& levels() const { return levels_; }

    /// Returns the bytes of a tile of the level that was added last. They are valid until the next call of add().
    std::string_view tile_of_last_level(std::size_t tile) const
    {
        const TileEntry& entry = levels_.back().tiles[tile];
        return std::string_view(bytes_).substr(entry.offset, entry.size);
    }

    /// Adds a level. `tiles` has the bytes of each tile, row after row; an empty text is an empty tile.
    void add(TileLevel level, std::vector<std::string> tiles, int threads);

    TileStore build();

private:
    const std::uint64_t checksum_of_empty_;
    std::vector<TileLevel> levels_;
    std::string bytes_;
};

}  // namespace spawnfield

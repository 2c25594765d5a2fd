#include "base/tile_store.h"

#include "base/large_list.h"
#include "base/parallel.h"

#include <spawnfield/error.h>

#include <xxhash.h>

#include <algorithm>

namespace spawnfield {
namespace {

constexpr std::size_t large_file = 64 << 20, page = 4096, most_in_place = 1 << 20;  // bytes

}  // namespace

TileLevel::TileLevel(double cell_size, std::uint32_t col_count, std::uint32_t row_count, std::uint32_t tile_side)
    : cell(cell_size), cols(col_count), rows(row_count), tile_cols(cols / tile_side + (cols % tile_side != 0)),
      tile_rows(rows / tile_side + (rows % tile_side != 0))
{
}

TileStore::TileStore(std::vector<TileLevel> levels, Bytes bytes, std::string file)
    : levels_(std::move(levels)), bytes_(std::move(bytes)), file_(std::move(file))
{
    if (file_.empty()) return;
    opened_ = std::make_unique<Opened>();
    opened_->forgets_pages = bytes_.view.size() > large_file;
    opened_->bytes_to_copy = opened_->forgets_pages ? bytes_.view.size() / 4 : 0;
    for (const TileLevel& level : levels_)
        opened_->tiles.push_back(std::make_unique<std::atomic<const char*>[]>(level.tiles.size()));
}

/// Returns memory for a tile of this size, a multiple of 8 bytes. Blocks of many tiles spare malloc the system calls by
/// which it gets memory.
char* TileStore::Opened::room_for(std::size_t size)
{
    constexpr std::size_t block = 1 << 20;  // bytes
    const std::lock_guard lock(mutex);
    if (size > room) {
        copies.push_back(std::make_unique_for_overwrite<std::uint64_t[]>(block / 8));
        room = block;
    }
    char* const out = reinterpret_cast<char*>(copies.back().get()) + (block - room);
    room -= size;
    return out;
}

/// Returns a copy of a small tile; nothing for a large one, or if enough was copied.
std::string_view TileStore::copy_of(const TileEntry& entry) const
{
    std::size_t rest = opened_->bytes_to_copy;
    do {
        if (entry.size > std::min(page, rest)) return {};
    } while (!opened_->bytes_to_copy.compare_exchange_weak(rest, rest - entry.size));
    char* const copy = opened_->room_for((entry.size + 7) / 8 * 8);
    if (!bytes_.copy(entry.offset, entry.size, copy))
        throw FileError(file_, "cannot be read any more, or was cut short; bake the map again");
    return {copy, entry.size};
}

/// Returns pages to the system if enough tiles of a large file were opened in the mapping. Then the memory of a query
/// does not grow with the file. Pages that are still in use are mapped again, without reading the disk.
void TileStore::count_in_place(std::size_t size) const
{
    if (!opened_->forgets_pages || (opened_->bytes_in_place += size) < most_in_place) return;
    opened_->bytes_in_place = 0;
    bytes_.forget_pages();
}

/// Reads a tile and checks its checksum.
std::string_view TileStore::fetch(std::size_t level, std::size_t tile) const
{
    const TileEntry& entry = levels_[level].tiles[tile];
    std::string_view out = copy_of(entry);
    if (out.empty()) {
        count_in_place(entry.size);
        out = bytes_.view.substr(entry.offset, entry.size);
    }
    if (XXH64(out.data(), out.size(), 0) != entry.checksum)
        throw FileError(file_, "is damaged (tile " + std::to_string(tile) + " of level " + std::to_string(level) +
                                   " has another checksum than the head of the file lists); bake the map again");
    return out;
}

/// Keeps these bytes for the next calls, unless another thread has opened the tile meanwhile. Returns what is kept.
std::string_view TileStore::keep(std::size_t level, std::size_t tile, std::string_view bytes) const
{
    const char* known = nullptr;
    const bool is_first = opened_->tiles[level][tile].compare_exchange_strong(known, bytes.data(),
                                                                              std::memory_order_acq_rel);
    return is_first ? bytes : std::string_view(known, bytes.size());
}

void TileStore::fail_inconsistent() const
{
    throw FileError(file_, "is not a valid map file: its values contradict each other; bake the map again");
}

void TileStoreBuilder::add(TileLevel level, std::vector<std::string> tiles, int threads)
{
    level.tiles.resize(tiles.size());
    parallel_for(tiles.size(), threads, {}, [&](std::size_t t) {
        level.tiles[t].checksum = checksum_of_empty_;
        if (tiles[t].empty()) return;
        tiles[t].resize((tiles[t].size() + tile_alignment - 1) / tile_alignment * tile_alignment, '\0');
        level.tiles[t].checksum = XXH64(tiles[t].data(), tiles[t].size(), 0);
    });
    std::size_t size = bytes_.size();
    for (const std::string& tile : tiles) size += tile.size();
    if (bytes_.capacity() < size)
        reserve_large(bytes_, size + size / 2);  // coarser levels will take about a third of this one
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        level.tiles[t].offset = bytes_.size();
        level.tiles[t].size = tiles[t].size();
        bytes_ += tiles[t];
        std::string().swap(tiles[t]);  // frees its memory before the next tile is copied; `= {}` would keep it
    }
    levels_.push_back(std::move(level));
}

TileStore TileStoreBuilder::build() { return {std::move(levels_), bytes_of(std::move(bytes_))}; }

}  // namespace spawnfield

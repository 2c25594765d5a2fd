#include "base/tile_store.h"

#include "base/parallel.h"

#include <spawnfield/error.h>

#include <xxhash.h>

namespace spawnfield {

TileLevel::TileLevel(double cell_size, std::uint32_t col_count, std::uint32_t row_count, std::uint32_t tile_side)
    : cell(cell_size), cols(col_count), rows(row_count), tile_cols(cols / tile_side + (cols % tile_side != 0)),
      tile_rows(rows / tile_side + (rows % tile_side != 0))
{
}

TileStore::TileStore(std::vector<TileLevel> levels, Bytes bytes, std::string file)
    : levels_(std::move(levels)), bytes_(std::move(bytes)), file_(std::move(file))
{
    if (file_.empty()) return;
    for (const TileLevel& level : levels_)
        checked_.push_back(std::make_unique<std::atomic<std::uint8_t>[]>(level.tiles.size()));
}

void TileStore::verify_checksum(std::size_t level, std::size_t tile) const
{
    const TileEntry& entry = levels_[level].tiles[tile];
    if (XXH64(bytes_.view.data() + entry.offset, entry.size, 0) != entry.checksum)
        throw FileError(file_, "is damaged (tile " + std::to_string(tile) + " of level " + std::to_string(level) +
                                   " has another checksum than the head of the file lists); bake the map again");
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

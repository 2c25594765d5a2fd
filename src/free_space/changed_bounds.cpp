#include "free_space/changed_bounds.h"

#include "base/parallel.h"
#include "free_space/bounds_raster.h"

#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace spawnfield {

/// The tiles of changed images that differ from those of the unchanged ones, or may differ.
class SolidBounds::Impl::ChangedTiles {
public:
    /// `raster` owns this object. All but its member `changed` is set.
    ChangedTiles(const SolidBounds::Impl& raster, const Geometry& geometry, std::span<const ElementBox> boxes)
        : raster_(raster), geometry_(geometry)
    {
        const std::vector<TileLevel>& levels = raster_.levels();
        std::vector<std::uint32_t> numbers;
        if (!levels.empty())
            for (const ElementBox& box : boxes) add_tiles_of(box, numbers);
        for (std::size_t l = 0; l < levels.size(); ++l) {
            std::sort(numbers.begin(), numbers.end());
            numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
            changed_.push_back({numbers, std::make_unique<LazyTile[]>(numbers.size())});
            if (l + 1 == levels.size()) break;
            for (std::uint32_t& number : numbers)
                number = number / levels[l].tile_cols / 2 * levels[l + 1].tile_cols + number % levels[l].tile_cols / 2;
        }
    }

    BoundsTile open(std::size_t level, std::uint32_t col, std::uint32_t row) const
    {
        const std::string* const bytes = bytes_of(level, col, row);
        if (bytes == nullptr) return raster_.base->open(level, col, row);
        return bytes->empty() ? BoundsTile() : BoundsTile(*bytes);
    }

    /// Returns the bytes of a tile that may differ; nullptr for a tile of the unchanged images.
    const std::string* bytes_of(std::size_t level, std::uint32_t col, std::uint32_t row) const
    {
        const std::uint32_t number = row * raster_.levels()[level].tile_cols + col;
        const std::vector<std::uint32_t>& numbers = changed_[level].numbers;
        const auto place = std::lower_bound(numbers.begin(), numbers.end(), number);
        if (place == numbers.end() || *place != number) return nullptr;
        LazyTile& tile = changed_[level].tiles[std::size_t(place - numbers.begin())];
        std::call_once(tile.is_made, [&] { tile.bytes = made(level, col, row); });
        return &tile.bytes;
    }

private:
    struct LazyTile {
        std::once_flag is_made;
        std::string bytes;
    };
    struct Level {
        std::vector<std::uint32_t> numbers;  ///< of the changed tiles, ascending
        std::unique_ptr<LazyTile[]> tiles;
    };

    /// Adds the numbers of the tiles of the finest level that meet a box, or come within a cell of it.
    void add_tiles_of(const ElementBox& box, std::vector<std::uint32_t>& numbers) const
    {
        const TileLevel& level = raster_.levels()[0];
        const auto tile_of = [&](double place, double origin, double pad, std::uint32_t count) {
            const double tile = std::floor(((place - origin) / level.cell + pad) / BoundsTile::side);
            return std::clamp(tile, -1.0, double(count));
        };
        const double first_col = std::max(0.0, tile_of(box.min[0], raster_.x0, -1, level.tile_cols)),
                     last_col = std::min(level.tile_cols - 1.0, tile_of(box.max[0], raster_.x0, 1, level.tile_cols)),
                     first_row = std::max(0.0, tile_of(box.min[1], raster_.y0, -1, level.tile_rows)),
                     last_row = std::min(level.tile_rows - 1.0, tile_of(box.max[1], raster_.y0, 1, level.tile_rows));
        for (double row = first_row; row <= last_row; ++row)
            for (double col = first_col; col <= last_col; ++col)
                numbers.push_back(std::uint32_t(row) * level.tile_cols + std::uint32_t(col));
    }

    std::string made(std::size_t level, std::uint32_t col, std::uint32_t row) const
    {
        const std::vector<TileLevel>& levels = raster_.levels();
        if (level == 0) return rasterized_tile(geometry_, raster_, levels[0], col, row);
        return pooled_tile(four_tiles(levels[level - 1], col, row, [&](std::uint32_t fine_col, std::uint32_t fine_row) {
            return open(level - 1, fine_col, fine_row);
        }));
    }

    const SolidBounds::Impl& raster_;
    const Geometry geometry_;
    std::vector<Level> changed_;
};

SolidBounds::Impl::Impl() = default;
SolidBounds::Impl::~Impl() = default;

BoundsTile SolidBounds::Impl::open(std::size_t level, std::uint32_t col, std::uint32_t row) const
{
    if (changed) return changed->open(level, col, row);
    const std::string_view bytes = bytes_of(level, col, row);
    return bytes.empty() ? BoundsTile() : BoundsTile(bytes, tile_version);
}

std::string_view SolidBounds::Impl::bytes_of(std::size_t level, std::uint32_t col, std::uint32_t row) const
{
    if (changed) {
        const std::string* const bytes = changed->bytes_of(level, col, row);
        return bytes != nullptr ? std::string_view(*bytes) : base->bytes_of(level, col, row);
    }
    const std::size_t number = std::size_t{row} * tiles.levels()[level].tile_cols + col;
    if (tiles.levels()[level].tiles[number].size == 0) return {};
    return tiles.open(level, number,
                      [&](std::string_view bytes) { return BoundsTile::is_consistent(bytes, tile_version); });
}

SolidBounds changed_bounds(const SolidBounds& base, const Geometry& geometry, const Bounds& bounds,
                           std::span<const ElementBox> boxes)
{
    auto impl = std::make_shared<SolidBounds::Impl>();
    impl->x0 = base.impl().x0;
    impl->y0 = base.impl().y0;
    impl->is_whole = is_whole_in(geometry.bounds(), bounds);
    impl->base = base.shared_impl();
    impl->changed = std::make_unique<const SolidBounds::Impl::ChangedTiles>(*impl, geometry, boxes);
    return SolidBounds(std::move(impl));
}

SolidBounds made_bounds(const SolidBounds& changed, int threads)
{
    const SolidBounds::Impl& from = changed.impl();
    auto impl = std::make_shared<SolidBounds::Impl>();
    impl->x0 = from.x0;
    impl->y0 = from.y0;
    impl->is_whole = from.is_whole;
    TileStoreBuilder store(XXH64(nullptr, 0, 0));
    for (std::size_t l = 0; l < from.levels().size(); ++l) {
        const TileLevel& old = from.levels()[l];
        TileLevel level(old.cell, old.cols, old.rows, BoundsTile::side);
        std::vector<std::string> tiles(std::size_t{level.tile_cols} * level.tile_rows);
        parallel_for(tiles.size(), threads, {}, [&](std::size_t t) {
            tiles[t] = from.bytes_of(l, std::uint32_t(t % level.tile_cols), std::uint32_t(t / level.tile_cols));
        });
        store.add(std::move(level), std::move(tiles), threads);
    }
    impl->tiles = store.build();
    return SolidBounds(std::move(impl));
}

}  // namespace spawnfield

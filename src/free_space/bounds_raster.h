#pragma once

#include "free_space/bounds_tile.h"

#include <array>
#include <string>

namespace spawnfield {

/// Returns the bytes of one tile of the finest level; none if nothing in it is solid. Its cells beyond the raster stay
/// empty.
std::string rasterized_tile(const Geometry& geometry, const SolidBounds::Impl& raster, const TileLevel& level,
                            std::uint32_t tile_col, std::uint32_t tile_row);

/// Returns the bytes of a tile of the next coarser level. Each of its cells is the union of four finer cells, so a gap
/// remains only where all four have a gap. Solids are not kept.
std::string pooled_tile(const std::array<BoundsTile, 4>& finer);

/// Returns the four finer tiles of which a tile consists: tile_at(col, row), or an empty tile beyond the level.
template <class TileAt>
std::array<BoundsTile, 4> four_tiles(const TileLevel& finer, std::uint32_t tile_col, std::uint32_t tile_row,
                                     const TileAt& tile_at)
{
    std::array<BoundsTile, 4> out;
    for (std::uint32_t t = 0; t < 4; ++t) {
        const std::uint32_t col = 2 * tile_col + t % 2, row = 2 * tile_row + t / 2;
        if (col < finer.tile_cols && row < finer.tile_rows) out[t] = tile_at(col, row);
    }
    return out;
}

/// Returns whether nothing solid is beyond the raster of these bounds (SolidBounds::Impl::is_whole).
bool is_whole_in(const Bounds& solid, const Bounds& bounds);

}  // namespace spawnfield

#include "map/bounds_file.h"

#include "free_space/bounds_tile.h"
#include "map/tiled_file.h"

#include <cmath>

namespace spawnfield {
namespace {

constexpr TiledFormat bounds_format{"SPAWNBND", BoundsTile::version, 1};

/// Returns whether each level has cells of twice the size of the level before it, and as many as needed, down to at
/// most 4 x 4 cells. The mask relies on this.
bool are_halved(const std::vector<TileLevel>& levels)
{
    constexpr std::size_t most = 31;  // levels: more than a raster of 2^30 cells along a side needs
    if (levels.size() > most) return false;
    for (std::size_t l = 1; l < levels.size(); ++l) {
        const TileLevel &finer = levels[l - 1], &level = levels[l];
        if (level.cell != 2 * finer.cell || level.cols != (finer.cols + 1) / 2 || level.rows != (finer.rows + 1) / 2)
            return false;
    }
    return true;
}

/// Returns whether numbers of cells of robots fit into 32 bits.
bool is_plausible(const SolidBounds::Impl& impl)
{
    constexpr double least_cell = 1e-6, farthest = 1e9;                      // m
    const auto is_place = [](double x) { return std::abs(x) <= farthest; };  // not NaN
    const bool has_cells = impl.levels().empty() || impl.levels()[0].cell >= least_cell;
    return has_cells && is_place(impl.x0) && is_place(impl.y0);
}

}  // namespace

ListedFile write_bounds(const std::filesystem::path& file, const SolidBounds& bounds)
{
    const SolidBounds::Impl& impl = bounds.impl();
    BinaryWriter head;
    head.put(impl.x0);
    head.put(impl.y0);
    head.put(std::uint32_t(impl.is_whole));
    put_levels(head, impl.levels());
    return write_tiled(file, bounds_format, head.take(), impl.tiles);
}

SolidBounds open_bounds(const std::filesystem::path& file, const std::string& head_checksum)
{
    auto impl = std::make_shared<SolidBounds::Impl>();
    impl->tiles = open_tiled(file, bounds_format, head_checksum, [&](BinaryReader& head, std::uint32_t version) {
        impl->tile_version = version;
        impl->x0 = head.get<double>();
        impl->y0 = head.get<double>();
        impl->is_whole = head.get<std::uint32_t>() != 0;
        return get_levels(head, BoundsTile::side);
    });
    if (!are_halved(impl->levels()) || !is_plausible(*impl)) impl->tiles.fail_inconsistent();
    return SolidBounds(std::move(impl));
}

}  // namespace spawnfield

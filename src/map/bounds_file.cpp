#include "map/bounds_file.h"

#include "base/binary.h"
#include "free_space/bounds_tile.h"
#include "map/tiled_file.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

namespace spawnfield {
namespace {

constexpr std::string_view bounds_magic = "SPAWNBND";
constexpr std::uint32_t bounds_version = 1;

std::string written_head(const SolidBounds::Impl& bounds)
{
    BinaryWriter out;
    out.put(bounds.x0);
    out.put(bounds.y0);
    out.put(std::uint32_t(bounds.is_whole));
    out.put(std::uint32_t(bounds.levels.size()));
    for (const BoundsLevel& level : bounds.levels) {
        out.put(level.cell);
        out.put(level.cols);
        out.put(level.rows);
        out.put_array(level.tiles);
    }
    return out.take();
}

/// Returns whether the levels are valid and every tile lies within the bytes.
bool is_consistent(const SolidBounds::Impl& bounds)
{
    constexpr std::uint32_t most = 1u << 30;  // cells along one side
    for (const BoundsLevel& level : bounds.levels) {
        if (!(level.cell > 0) || level.cols == 0 || level.rows == 0 || level.cols > most || level.rows > most)
            return false;
        if (level.tiles.size() != std::uint64_t{level.tile_cols} * level.tile_rows) return false;
        for (const TileEntry& tile : level.tiles)
            if (tile.offset % 8 != 0 || tile.offset > bounds.bytes.view.size() ||
                tile.size > bounds.bytes.view.size() - tile.offset)
                return false;
    }
    return true;
}

}  // namespace

void write_bounds(const std::filesystem::path& file, const SolidBounds& bounds)
{
    OutputFile out(file);
    out.write(tiled_head(bounds_magic, bounds_version, written_head(bounds.impl())));
    out.write(bounds.impl().bytes.view);
    out.commit();
}

SolidBounds open_bounds(const std::filesystem::path& file, const std::string& head_checksum)
{
    const TiledFile tiled = open_tiled(file, bounds_magic, bounds_version, head_checksum);
    auto impl = std::make_shared<SolidBounds::Impl>();
    try {
        BinaryReader in(tiled.head);
        impl->x0 = in.get<double>();
        impl->y0 = in.get<double>();
        impl->is_whole = in.get<std::uint32_t>() != 0;
        const auto levels = in.get<std::uint32_t>();
        for (std::uint32_t l = 0; l < levels; ++l) {
            BoundsLevel level;
            level.cell = in.get<double>();
            level.cols = in.get<std::uint32_t>();
            level.rows = in.get<std::uint32_t>();
            level.tile_cols = (level.cols + BoundsTile::side - 1) / BoundsTile::side;
            level.tile_rows = (level.rows + BoundsTile::side - 1) / BoundsTile::side;
            level.tiles = in.get_array<TileEntry>();
            impl->levels.push_back(std::move(level));
        }
    } catch (const std::out_of_range&) {
        throw FileError(file.string(), "is cut short; bake the map again");
    }
    impl->bytes = tiled.tiles;
    impl->file = file.string();
    if (!is_consistent(*impl)) throw FileError(file.string(), "contradicts itself; bake the map again");
    impl->make_states();
    return SolidBounds(std::move(impl));
}

}  // namespace spawnfield

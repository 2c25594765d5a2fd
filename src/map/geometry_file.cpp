#include "map/geometry_file.h"

#include "base/binary.h"
#include "geometry/tile.h"
#include "map/tiled_file.h"

#include <spawnfield/error.h>
#include <spawnfield/output_file.h>

namespace spawnfield {
namespace {

constexpr std::string_view geometry_magic = "SPAWNGEO";
constexpr std::uint32_t geometry_version = 2;

std::string written_head(const Geometry::Impl& geometry)
{
    BinaryWriter out;
    out.put(geometry.x0);
    out.put(geometry.y0);
    out.put(geometry.elements);
    for (const double limit : geometry.bounds.min) out.put(limit);
    for (const double limit : geometry.bounds.max) out.put(limit);
    out.put(std::uint32_t(geometry.has_filled_meshes));
    out.put(std::uint32_t(geometry.levels.size()));
    for (const TileLevel& level : geometry.levels) {
        out.put(level.cell);
        out.put(level.cols);
        out.put(level.rows);
        out.put_array(level.tiles);
    }
    for (const LabelCount& count : geometry.labels) {
        out.put(count.triangles);
        out.put(count.primitives);
    }
    out.put(std::uint32_t(geometry.parts.size()));
    for (const Part& part : geometry.parts) {
        out.put_text(part.name);
        out.put_text(part.kind);
        out.put(std::uint32_t(part.label));
        for (const std::uint32_t n : {part.solid_pieces, part.sheet_pieces, part.open_edges, part.triangles})
            out.put(n);
    }
    return out.take();
}

void read_parts(BinaryReader& in, Geometry::Impl& geometry)
{
    for (LabelCount& count : geometry.labels) {
        count.triangles = in.get<std::uint64_t>();
        count.primitives = in.get<std::uint64_t>();
    }
    for (auto parts = in.get<std::uint32_t>(); parts > 0; --parts) {
        Part part;
        part.name = in.get_text();
        part.kind = in.get_text();
        part.label = Label(std::min(in.get<std::uint32_t>(), std::uint32_t(Label::Ignore)));
        for (std::uint32_t* n : {&part.solid_pieces, &part.sheet_pieces, &part.open_edges, &part.triangles})
            *n = in.get<std::uint32_t>();
        geometry.parts.push_back(std::move(part));
    }
}

/// Returns whether the levels are valid and every tile lies within the bytes. A file with correct checksums may still
/// come from another program.
bool is_consistent(const Geometry::Impl& geometry)
{
    for (const TileLevel& level : geometry.levels) {
        if (!(level.cell > 0) || level.tiles.size() != std::uint64_t{level.cols} * level.rows || level.tiles.empty())
            return false;
        for (const TileEntry& tile : level.tiles)
            if (tile.offset % 8 != 0 || tile.offset > geometry.bytes.view.size() ||
                tile.size > geometry.bytes.view.size() - tile.offset)
                return false;
    }
    return true;
}

}  // namespace

void write_geometry(const std::filesystem::path& file, const Geometry& geometry)
{
    OutputFile out(file);
    out.write(tiled_head(geometry_magic, geometry_version, written_head(geometry.impl())));
    out.write(geometry.impl().bytes.view);
    out.commit();
}

Geometry open_geometry(const std::filesystem::path& file, const std::string& head_checksum)
{
    const TiledFile tiled = open_tiled(file, geometry_magic, geometry_version, head_checksum);
    auto impl = std::make_shared<Geometry::Impl>();
    try {
        BinaryReader in(tiled.head);
        impl->x0 = in.get<double>();
        impl->y0 = in.get<double>();
        impl->elements = in.get<std::uint64_t>();
        for (double& limit : impl->bounds.min) limit = in.get<double>();
        for (double& limit : impl->bounds.max) limit = in.get<double>();
        impl->has_filled_meshes = in.get<std::uint32_t>() != 0;
        const auto levels = in.get<std::uint32_t>();
        for (std::uint32_t l = 0; l < levels; ++l) {
            TileLevel level;
            level.cell = in.get<double>();
            level.cols = in.get<std::uint32_t>();
            level.rows = in.get<std::uint32_t>();
            level.tiles = in.get_array<TileEntry>();
            impl->levels.push_back(std::move(level));
        }
        read_parts(in, *impl);
    } catch (const std::out_of_range&) {
        throw FileError(file.string(), "is cut short; bake the map again");
    }
    impl->bytes = tiled.tiles;
    impl->file = file.string();
    if (!is_consistent(*impl)) throw FileError(file.string(), "contradicts itself; bake the map again");
    impl->make_states();
    return Geometry(std::move(impl));
}

}  // namespace spawnfield

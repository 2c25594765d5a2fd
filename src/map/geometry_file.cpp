#include "map/geometry_file.h"

#include "geometry/tile.h"
#include "map/tiled_file.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr TiledFormat geometry_format{"SPAWNGEO", 2, 2};

std::string written_head(const Geometry::Impl& geometry)
{
    BinaryWriter out;
    out.put(geometry.x0);
    out.put(geometry.y0);
    out.put(geometry.elements);
    for (const double limit : geometry.bounds.min) out.put(limit);
    for (const double limit : geometry.bounds.max) out.put(limit);
    out.put(std::uint32_t(geometry.has_filled_meshes));
    put_levels(out, geometry.levels());
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

}  // namespace

ListedFile write_geometry(const std::filesystem::path& file, const Geometry& geometry)
{
    return write_tiled(file, geometry_format, written_head(geometry.impl()), geometry.impl().tiles());
}

Geometry open_geometry(const std::filesystem::path& file, const std::string& head_checksum)
{
    auto impl = std::make_shared<Geometry::Impl>();
    impl->set_tiles(open_tiled(file, geometry_format, head_checksum, [&](BinaryReader& head, std::uint32_t) {
        impl->x0 = head.get<double>();
        impl->y0 = head.get<double>();
        impl->elements = head.get<std::uint64_t>();
        for (double& limit : impl->bounds.min) limit = head.get<double>();
        for (double& limit : impl->bounds.max) limit = head.get<double>();
        impl->has_filled_meshes = head.get<std::uint32_t>() != 0;
        std::vector<TileLevel> levels = get_levels(head, 1);
        read_parts(head, *impl);
        return levels;
    }));
    if (!std::isfinite(impl->x0) || !std::isfinite(impl->y0)) impl->tiles().fail_inconsistent();
    return Geometry(std::move(impl));
}

}  // namespace spawnfield

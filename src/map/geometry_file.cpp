#include "map/geometry_file.h"

#include "geometry/geometry_impl.h"
#include "map/old_geometry.h"
#include "map/tiled_file.h"

#include <algorithm>

namespace spawnfield {
namespace {

constexpr TiledFormat geometry_format{"SPAWNGEO", 6, 2};

std::string written_head(const Geometry::Impl& geometry)
{
    BinaryWriter out;
    out.put(geometry.elements);
    for (const double limit : geometry.bounds.min) out.put(limit);
    for (const double limit : geometry.bounds.max) out.put(limit);
    out.put(std::uint32_t(geometry.has_filled_meshes));
    const Forest& forest = *geometry.forests.front();
    put_levels(out, forest.tiles.levels());
    for (const TileTree& tree : forest.trees) out.put_array(tree.boxes());
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
    out.put_array(geometry.part_hashes);
    out.put(std::uint32_t(geometry.face_groups.size()));
    for (const FaceGroup& group : geometry.face_groups) {
        out.put(group.part);
        out.put_text(group.node);
        out.put_text(group.material);
        for (const std::uint64_t count : group.triangles) out.put(count);
        out.put(group.low);
        out.put(group.high);
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

void read_face_groups(BinaryReader& in, Geometry::Impl& geometry)
{
    for (auto groups = in.get<std::uint32_t>(); groups > 0; --groups) {
        FaceGroup group;
        group.part = in.get<std::uint32_t>();
        group.node = in.get_text();
        group.material = in.get_text();
        for (std::uint64_t& count : group.triangles) count = in.get<std::uint64_t>();
        group.low = in.get<double>();
        group.high = in.get<double>();
        geometry.face_groups.push_back(std::move(group));
    }
}

/// Returns a geometry with the tiles of this version. Reads all tiles on all cores, which takes about 0.5 s for a
/// million triangles.
Geometry of_version_2(const TileStore& tiles, const Geometry::Impl& head)
{
    Scene scene;
    scene.parts = head.parts;
    std::uint64_t triangles = 0;
    for (const LabelCount& count : head.labels) triangles += count.triangles;
    read_old_tiles(tiles, triangles, head.elements, scene);
    return Geometry(scene);
}

}  // namespace

ListedFile write_geometry(const std::filesystem::path& file, const Geometry& geometry)
{
    return write_tiled(file, geometry_format, written_head(geometry.impl()), geometry.impl().forests.front()->tiles);
}

Geometry open_geometry(const std::filesystem::path& file, const std::string& head_checksum)
{
    auto impl = std::make_shared<Geometry::Impl>();
    std::vector<TileTree> trees;
    std::uint32_t file_version = 0;
    TileStore tiles = open_tiled(file, geometry_format, head_checksum, [&](BinaryReader& head, std::uint32_t version) {
        file_version = version;
        if (version == 2) head.get<std::array<double, 2>>();  // the corner of the grids of tiles
        impl->elements = head.get<std::uint64_t>();
        for (double& limit : impl->bounds.min) limit = head.get<double>();
        for (double& limit : impl->bounds.max) limit = head.get<double>();
        impl->has_filled_meshes = head.get<std::uint32_t>() != 0;
        std::vector<TileLevel> levels = get_levels(head, 1);
        for (std::size_t tree = 0; version > 2 && tree < levels.size(); ++tree)
            trees.emplace_back(head.get_array<ElementBox>());
        read_parts(head, *impl);
        if (version > 3) impl->part_hashes = head.get_array<std::uint64_t>();
        if (version > 4) read_face_groups(head, *impl);
        return levels;
    });
    if (file_version == 2) return of_version_2(tiles, *impl);
    if (file_version > 3 && impl->part_hashes.size() != impl->parts.size()) tiles.fail_inconsistent();
    for (const FaceGroup& group : impl->face_groups)
        if (group.part >= impl->parts.size()) tiles.fail_inconsistent();
    for (std::size_t tree = 0; tree < trees.size(); ++tree) {
        const std::vector<TileEntry>& entries = tiles.levels()[tree].tiles;
        const auto is_empty = [](const TileEntry& tile) { return tile.size == 0; };
        if (trees[tree].boxes().size() != entries.size() || std::any_of(entries.begin(), entries.end(), is_empty))
            tiles.fail_inconsistent();
    }
    // The numbers of pieces are not in the head; each piece has at least one triangle.
    const auto elements = std::uint32_t(impl->elements);
    const TileLimits limits{impl->parts.size(), impl->face_groups.size()};
    impl->next = {elements, elements, std::uint32_t(limits.parts), std::uint32_t(limits.groups)};
    impl->forests = {std::make_shared<const Forest>(Forest{std::move(tiles), std::move(trees), limits})};
    return Geometry(std::move(impl));
}

}  // namespace spawnfield

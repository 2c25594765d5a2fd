#include "review/world_mesh.h"

#include "base/parallel.h"
#include "export/part_surfaces.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr std::size_t kept_triangles = 64;  // of a part that is not simplified

/// A mesh whose corners are not rounded yet.
struct FineMesh {
    std::vector<Point> corners;
    std::vector<std::uint32_t> indices;
};

/// The surface of a part that has one label.
struct PartMesh {
    std::uint32_t part;
    Label label;
    FineMesh mesh;

    std::size_t triangles() const { return mesh.indices.size() / 3; }
};

std::vector<PartMesh> part_meshes(const Geometry& geometry, const Vec3& origin, int threads)
{
    const auto to_point = [&](const Vec3& corner) {
        return Point{float(corner.x() - origin.x()), float(corner.y() - origin.y()), float(corner.z() - origin.z())};
    };
    std::vector<PartMesh> out;
    for_each_part(geometry, to_point, threads, [&](std::size_t part, const PartSurfaces& surfaces) {
        for (std::size_t label = 0; label < surfaces.size(); ++label)
            if (!surfaces[label].empty())
                out.push_back(
                    {std::uint32_t(part), Label(label), {surfaces[label].points(), surfaces[label].indices()}});
    });
    return out;
}

/// Leaves about this share of the triangles.
void simplify(FineMesh& mesh, double share)
{
    const std::size_t triangles = mesh.indices.size() / 3;
    if (share >= 1 || triangles <= kept_triangles) return;
    const std::size_t wanted = std::max(kept_triangles, std::size_t(share * double(triangles)));
    constexpr float largest_error = 1;  // of the mesh's size: the number of triangles decides
    mesh.indices.resize(meshopt_simplify(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(),
                                         mesh.corners[0].data(), mesh.corners.size(), sizeof(Point), 3 * wanted,
                                         largest_error));
}

/// Sorts the triangles and the corners so that neighbours follow each other, which compresses better, and leaves out
/// corners without a triangle.
void sort(FineMesh& mesh)
{
    meshopt_optimizeVertexCacheStrip(mesh.indices.data(), mesh.indices.data(), mesh.indices.size(),
                                     mesh.corners.size());
    std::vector<Point> corners(mesh.corners.size());
    corners.resize(meshopt_optimizeVertexFetch(corners.data(), mesh.indices.data(), mesh.indices.size(),
                                               mesh.corners.data(), mesh.corners.size(), sizeof(Point)));
    mesh.corners = std::move(corners);
}

/// Rounds the corners of a mesh.
LabelMesh rounded_mesh(Label label, const FineMesh& mesh)
{
    constexpr double most = 65535;
    LabelMesh out{.label = label};
    Bounds bounds;
    for (const Point& corner : mesh.corners) bounds.extend({corner[0], corner[1], corner[2]});
    out.offset = bounds.min;
    const double size = (bounds.max - bounds.min).maxCoeff();
    out.scale = size > 0 ? size / most : 1;
    for (const Point& corner : mesh.corners) {
        std::array<std::uint16_t, 4>& to = out.corners.emplace_back();
        for (int axis = 0; axis < 3; ++axis)
            to[std::size_t(axis)] = std::uint16_t(
                std::clamp(std::round((corner[std::size_t(axis)] - out.offset[axis]) / out.scale), 0.0, most));
    }
    out.indices = mesh.indices;
    return out;
}

}  // namespace

WorldMesh world_mesh(const Geometry& geometry, const Vec3& origin, std::size_t most_triangles, int threads)
{
    std::vector<PartMesh> parts = part_meshes(geometry, origin, threads);
    WorldMesh out;
    for (const PartMesh& part : parts) out.triangles += part.triangles();
    const double share = double(most_triangles) / double(std::max<std::size_t>(out.triangles, 1));
    parallel_for(parts.size(), threads, {}, [&](std::size_t p) {
        simplify(parts[p].mesh, share);
        sort(parts[p].mesh);
    });
    for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water}) {
        FineMesh all;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> firsts;
        for (const PartMesh& part : parts) {
            if (part.label != label || part.mesh.indices.empty()) continue;
            firsts.emplace_back(part.part, std::uint32_t(all.indices.size() / 3));
            const auto first = std::uint32_t(all.corners.size());
            for (const std::uint32_t index : part.mesh.indices) all.indices.push_back(first + index);
            all.corners.insert(all.corners.end(), part.mesh.corners.begin(), part.mesh.corners.end());
        }
        if (all.indices.empty()) continue;
        LabelMesh& mesh = out.meshes.emplace_back(rounded_mesh(label, all));
        mesh.parts = std::move(firsts);
        out.shown += mesh.indices.size() / 3;
    }
    return out;
}

}  // namespace spawnfield

#include "nav_mesh.h"

#include "../random_scene.h"

#include <recastnavigation/DetourNavMesh.h>
#include <recastnavigation/DetourNavMeshBuilder.h>
#include <recastnavigation/DetourNavMeshQuery.h>
#include <recastnavigation/Recast.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

using namespace spawnfield;

namespace bench {
namespace {

constexpr int tile_cells = 256;

template <class T>
using Owned = std::unique_ptr<T, void (*)(T*)>;

void require(bool done, const char* step)
{
    if (!done) throw std::runtime_error(std::string("Recast: ") + step + " failed");
}

/// Appends a point in Recast's frame, where y is up: (x, y, z) becomes (x, z, -y).
void append(std::vector<float>& out, const Vec3& p)
{
    for (const double value : {p.x(), p.z(), -p.y()}) out.push_back(float(value));
}

/// All solid triangles in the frame of Recast, and the boxes of water.
struct Soup {
    std::vector<float> vertices;  ///< 3 corners x 3 coordinates for each triangle
    std::vector<char> terrain;    ///< whether the triangle is terrain; one for each triangle
    std::vector<std::array<float, 6>> water;

    void add(const Vec3& a, const Vec3& b, const Vec3& c, Label label)
    {
        for (const Vec3& v : {a, b, c}) append(vertices, v);
        terrain.push_back(label == Label::Terrain);
    }
    void add_box(const Primitive& primitive);
    void add_water(const Scene& scene);
    std::array<float, 6> bounds() const;
};

void Soup::add_box(const Primitive& primitive)
{
    const Shape& box = primitive.shape;
    if (box.kind != ShapeKind::Box)
        throw std::invalid_argument(
            "Recast: the scene has a primitive that is not a box; only boxes and meshes are supported");
    const auto corner = [&](int i) -> Vec3 {
        const Vec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
        return box.pose.rotation * box.size.cwiseProduct(sign) + box.pose.position;
    };
    constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& [a, b, c, d] : faces) {
        add(corner(a), corner(b), corner(c), primitive.label);
        add(corner(a), corner(c), corner(d), primitive.label);
    }
}

/// Adds, for each part of water, the space below its highest point within the rectangle around it.
void Soup::add_water(const Scene& scene)
{
    std::vector<Bounds> around(scene.parts.size());
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        if (scene.triangle_labels[t] == Label::Water)
            for (const std::uint32_t v : scene.triangles[t])
                around[scene.pieces[scene.triangle_pieces[t]].part].extend(scene.vertices[v]);
    for (const Bounds& b : around)
        if (!b.is_empty())
            water.push_back(
                {float(b.min.x()), -1000, float(-b.max.y()), float(b.max.x()), float(b.max.z()), float(-b.min.y())});
}

std::array<float, 6> Soup::bounds() const
{
    std::array<float, 6> out{};
    rcCalcBounds(vertices.data(), int(vertices.size() / 3), out.data(), out.data() + 3);
    return out;
}

Soup soup_of(const Scene& scene)
{
    Soup soup;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const auto [a, b, c] = scene.triangles[t];
        const Label label = scene.triangle_labels[t];
        if (label != Label::Water) soup.add(scene.vertices[a], scene.vertices[b], scene.vertices[c], label);
    }
    for (const Primitive& primitive : scene.primitives)
        if (primitive.label != Label::Water) soup.add_box(primitive);
    soup.add_water(scene);
    return soup;
}

/// Returns Recast's settings, derived from the agent as in the sample program of Recast.
rcConfig config_of(const Walker& walker, const std::array<float, 6>& bounds)
{
    rcConfig config{};
    config.cs = float(walker.cell);
    config.ch = float(walker.cell_height);
    config.walkableSlopeAngle = float(walker.slope * 180 / std::numbers::pi);
    config.walkableHeight = std::max(3, int(std::ceil(walker.height / walker.cell_height)));
    config.walkableClimb = int(std::floor(walker.climb / walker.cell_height + 1e-9));
    config.walkableRadius = int(std::ceil(walker.radius / walker.cell - 1e-9));
    config.maxEdgeLen = int(12 / walker.cell);
    config.maxSimplificationError = 1.3f;
    config.minRegionArea = 8 * 8;
    config.mergeRegionArea = 20 * 20;
    config.maxVertsPerPoly = DT_VERTS_PER_POLYGON;
    config.borderSize = config.walkableRadius + 3;
    config.tileSize = tile_cells;
    config.width = config.height = config.tileSize + 2 * config.borderSize;
    config.detailSampleDist = 6 * config.cs;
    config.detailSampleMaxError = config.ch;
    config.bmin[1] = bounds[1];
    config.bmax[1] = bounds[4] + 1;
    return config;
}

class TileBuilder {
public:
    TileBuilder(const Soup& soup, const Walker& walker)
        : soup_(soup), walker_(walker), bounds_(soup.bounds()), config_(config_of(walker, bounds_))
    {
        cols_ = std::max(1, int(std::ceil((bounds_[3] - bounds_[0]) / side())));
        rows_ = std::max(1, int(std::ceil((bounds_[5] - bounds_[2]) / side())));
        sort_by_tile();
    }

    int cols() const { return cols_; }
    int rows() const { return rows_; }
    float side() const { return float(tile_cells * walker_.cell); }
    const float* origin() const { return bounds_.data(); }

    /// Returns the data of a tile in the format of Detour, allocated by dtAlloc; empty where nothing is walkable.
    std::pair<unsigned char*, int> build(int col, int row);

private:
    std::size_t slot(int col, int row) const { return std::size_t(row) * std::size_t(cols_) + std::size_t(col); }
    void sort_by_tile();
    void rasterize(const std::vector<std::uint32_t>& triangles, const rcConfig& config, rcHeightfield& solid);
    void erode(const rcConfig& config, rcCompactHeightfield& open);
    std::pair<unsigned char*, int> pack(int col, int row, const rcConfig& config, rcPolyMesh& mesh,
                                        const rcPolyMeshDetail& detail);

    const Soup& soup_;
    const Walker walker_;
    const std::array<float, 6> bounds_;
    const rcConfig config_;
    int cols_, rows_;
    std::vector<std::vector<std::uint32_t>> bins_;
    rcContext context_{false};
};

/// Collects the triangles of each tile, including its border.
void TileBuilder::sort_by_tile()
{
    bins_.resize(slot(0, rows_));
    const float border = float(config_.borderSize) * config_.cs;
    for (std::uint32_t t = 0; t < soup_.terrain.size(); ++t) {
        float low[3], high[3];
        rcCalcBounds(&soup_.vertices[9 * std::size_t(t)], 3, low, high);
        const auto tile_of = [&](float value, int axis, int count) {
            return std::clamp(int(std::floor((value - bounds_[std::size_t(axis)]) / side())), 0, count - 1);
        };
        for (int row = tile_of(low[2] - border, 2, rows_); row <= tile_of(high[2] + border, 2, rows_); ++row)
            for (int col = tile_of(low[0] - border, 0, cols_); col <= tile_of(high[0] + border, 0, cols_); ++col)
                bins_[slot(col, row)].push_back(t);
    }
}

void TileBuilder::rasterize(const std::vector<std::uint32_t>& triangles, const rcConfig& config, rcHeightfield& solid)
{
    std::vector<float> vertices;
    std::vector<int> indices;
    for (const std::uint32_t t : triangles)
        for (int i = 0; i < 9; ++i) vertices.push_back(soup_.vertices[9 * std::size_t(t) + std::size_t(i)]);
    for (int i = 0; i < int(vertices.size() / 3); ++i) indices.push_back(i);
    const int count = int(triangles.size());
    std::vector<unsigned char> areas(triangles.size(), RC_NULL_AREA);
    rcMarkWalkableTriangles(&context_, config.walkableSlopeAngle, vertices.data(), 3 * count, indices.data(), count,
                            areas.data());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (!soup_.terrain[triangles[i]]) areas[i] = RC_NULL_AREA;
    require(rcRasterizeTriangles(&context_, vertices.data(), 3 * count, indices.data(), areas.data(), count, solid,
                                 config.walkableClimb),
            "rcRasterizeTriangles");
    rcFilterLedgeSpans(&context_, config.walkableHeight, config.walkableClimb, solid);
    rcFilterWalkableLowHeightSpans(&context_, config.walkableHeight, solid);
}

void TileBuilder::erode(const rcConfig& config, rcCompactHeightfield& open)
{
    require(rcErodeWalkableArea(&context_, config.walkableRadius, open), "rcErodeWalkableArea");
    for (const auto& box : soup_.water) rcMarkBoxArea(&context_, box.data(), box.data() + 3, RC_NULL_AREA, open);
    require(rcBuildDistanceField(&context_, open), "rcBuildDistanceField");
    require(rcBuildRegions(&context_, open, config.borderSize, config.minRegionArea, config.mergeRegionArea),
            "rcBuildRegions");
}

std::pair<unsigned char*, int> TileBuilder::build(int col, int row)
{
    const std::vector<std::uint32_t>& triangles = bins_[slot(col, row)];
    if (triangles.empty()) return {nullptr, 0};
    rcConfig config = config_;
    const float border = float(config.borderSize) * config.cs;
    config.bmin[0] = bounds_[0] + float(col) * side() - border;
    config.bmin[2] = bounds_[2] + float(row) * side() - border;
    config.bmax[0] = config.bmin[0] + side() + 2 * border;
    config.bmax[2] = config.bmin[2] + side() + 2 * border;

    const Owned<rcHeightfield> solid(rcAllocHeightfield(), rcFreeHeightField);
    require(rcCreateHeightfield(&context_, *solid, config.width, config.height, config.bmin, config.bmax, config.cs,
                                config.ch),
            "rcCreateHeightfield");
    rasterize(triangles, config, *solid);
    const Owned<rcCompactHeightfield> open(rcAllocCompactHeightfield(), rcFreeCompactHeightfield);
    require(rcBuildCompactHeightfield(&context_, config.walkableHeight, config.walkableClimb, *solid, *open),
            "rcBuildCompactHeightfield");
    erode(config, *open);
    const Owned<rcContourSet> contours(rcAllocContourSet(), rcFreeContourSet);
    require(rcBuildContours(&context_, *open, config.maxSimplificationError, config.maxEdgeLen, *contours),
            "rcBuildContours");
    if (contours->nconts == 0) return {nullptr, 0};
    const Owned<rcPolyMesh> mesh(rcAllocPolyMesh(), rcFreePolyMesh);
    require(rcBuildPolyMesh(&context_, *contours, config.maxVertsPerPoly, *mesh), "rcBuildPolyMesh");
    if (mesh->npolys == 0) return {nullptr, 0};
    const Owned<rcPolyMeshDetail> detail(rcAllocPolyMeshDetail(), rcFreePolyMeshDetail);
    require(
        rcBuildPolyMeshDetail(&context_, *mesh, *open, config.detailSampleDist, config.detailSampleMaxError, *detail),
        "rcBuildPolyMeshDetail");
    return pack(col, row, config, *mesh, *detail);
}

std::pair<unsigned char*, int> TileBuilder::pack(int col, int row, const rcConfig& config, rcPolyMesh& mesh,
                                                 const rcPolyMeshDetail& detail)
{
    std::fill_n(mesh.flags, mesh.npolys, static_cast<unsigned short>(1));
    dtNavMeshCreateParams params{};
    params.verts = mesh.verts;
    params.vertCount = mesh.nverts;
    params.polys = mesh.polys;
    params.polyAreas = mesh.areas;
    params.polyFlags = mesh.flags;
    params.polyCount = mesh.npolys;
    params.nvp = mesh.nvp;
    params.detailMeshes = detail.meshes;
    params.detailVerts = detail.verts;
    params.detailVertsCount = detail.nverts;
    params.detailTris = detail.tris;
    params.detailTriCount = detail.ntris;
    params.walkableHeight = float(walker_.height);
    params.walkableRadius = float(walker_.radius);
    params.walkableClimb = float(walker_.climb);
    params.tileX = col;
    params.tileY = row;
    std::copy_n(mesh.bmin, 3, params.bmin);
    std::copy_n(mesh.bmax, 3, params.bmax);
    params.cs = config.cs;
    params.ch = config.ch;
    params.buildBvTree = true;
    unsigned char* data = nullptr;
    int size = 0;
    require(dtCreateNavMeshData(&params, &data, &size), "dtCreateNavMeshData");
    return {data, size};
}

/// Detour takes its random numbers from a plain function, so the generator is global.
thread_local Random detour_random{0};
float detour_unit() { return std::min(float(detour_random.between(0, 1)), 0.99999994f); }

}  // namespace

struct NavMesh::Impl {
    Owned<dtNavMesh> mesh{dtAllocNavMesh(), dtFreeNavMesh};
    Owned<dtNavMeshQuery> query{dtAllocNavMeshQuery(), dtFreeNavMeshQuery};
    int tiles = 0, polygons = 0;
};

bool NavMesh::is_available() { return true; }

NavMesh::NavMesh(const Scene& scene, const Walker& walker) : impl_(std::make_unique<Impl>())
{
    const Soup soup = soup_of(scene);
    TileBuilder builder(soup, walker);
    dtNavMeshParams params{};
    std::copy_n(builder.origin(), 3, params.orig);
    params.tileWidth = params.tileHeight = builder.side();
    params.maxTiles = builder.cols() * builder.rows();
    params.maxPolys = 1 << 12;
    require(dtStatusSucceed(impl_->mesh->init(&params)), "dtNavMesh::init");
    for (int row = 0; row < builder.rows(); ++row)
        for (int col = 0; col < builder.cols(); ++col) {
            const auto [data, size] = builder.build(col, row);
            if (data == nullptr) continue;
            dtTileRef tile = 0;
            require(dtStatusSucceed(impl_->mesh->addTile(data, size, DT_TILE_FREE_DATA, 0, &tile)),
                    "dtNavMesh::addTile");
            ++impl_->tiles;
            impl_->polygons += std::as_const(*impl_->mesh).getTileByRef(tile)->header->polyCount;
        }
    require(dtStatusSucceed(impl_->query->init(impl_->mesh.get(), 2048)), "dtNavMeshQuery::init");
}

NavMesh::~NavMesh() = default;

std::vector<Vec3> NavMesh::draw(std::size_t count, std::uint64_t seed) const
{
    detour_random = Random(seed);
    const dtQueryFilter filter;
    std::vector<Vec3> out;
    for (std::size_t tries = 0; out.size() < count && tries < 10 * count; ++tries) {
        dtPolyRef polygon = 0;
        float p[3] = {};  // sometimes Detour finds no height for a point on the edge of a polygon
        if (dtStatusSucceed(impl_->query->findRandomPoint(&filter, detour_unit, &polygon, p)))
            out.emplace_back(p[0], -p[2], p[1]);
    }
    return out;
}

bool NavMesh::covers(const Vec3& point) const
{
    const dtQueryFilter filter;
    const float centre[3] = {float(point.x()), float(point.z()), float(-point.y())}, reach[3] = {0.01f, 1, 0.01f};
    dtPolyRef polygon = 0;
    float nearest[3] = {};
    impl_->query->findNearestPoly(centre, reach, &filter, &polygon, nearest);
    return polygon != 0 && std::hypot(nearest[0] - centre[0], nearest[2] - centre[2]) < 1e-3f;
}

int NavMesh::tiles() const { return impl_->tiles; }
int NavMesh::polygons() const { return impl_->polygons; }

}  // namespace bench

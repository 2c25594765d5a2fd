#include "base/number.h"
#include "base/parallel.h"
#include "column/cell_clip.h"
#include "column/uniform_column.h"
#include "geometry/geometry_impl.h"
#include "map/changed_occupancy.h"
#include "map/occupancy_impl.h"
#include "map/occupancy_towers.h"
#include "scene/octomap_file.h"

#include <spawnfield/error.h>
#include <spawnfield/occupancy.h>
#include <spawnfield/output_file.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <sstream>

namespace spawnfield {
namespace {

constexpr int tower_side = 1 << tower_level;  // voxels

/// Voxels, counted from 0, 0, 0 of the scene.
struct VoxelBox {
    std::array<int, 3> low, high;  ///< inclusive
    std::array<int, 3> origin;     ///< the voxel with the key key_offset; a corner of a tower, so its cubes are whole

    int key(int axis, int voxel) const { return voxel - origin[std::size_t(axis)] + key_offset; }
    int voxel(int axis, int key) const { return key + origin[std::size_t(axis)] - key_offset; }
};

/// Returns the origin of one axis: 0, or the middle of the voxels if they are too far from 0 for OctoMap.
int origin_of(double low, double high)
{
    if (low >= -key_offset && high < key_offset) return 0;
    return int(std::floor((low + high) / 2 / tower_side)) * tower_side;
}

VoxelBox voxels_in(const Bounds& bounds, double resolution)
{
    constexpr double most = 2 * key_offset - 2 * tower_side;  // voxels, wherever the origin is
    constexpr double farthest = 1 << 30;
    VoxelBox box{};
    for (int axis = 0; axis < 3; ++axis) {
        const double low = std::floor(bounds.min[axis] / resolution + 1e-9);
        const double high = std::max(low, std::ceil(bounds.max[axis] / resolution - 1e-9) - 1);
        const double reach = std::max(std::abs(bounds.min[axis]), std::abs(bounds.max[axis]));
        if (!(high - low < most))
            throw ArgumentError("build_occupancy", "occupancy resolution", resolution,
                                "at least " + number((bounds.max[axis] - bounds.min[axis]) / (most - 1)) +
                                    " m here (OctoMap has 65536 voxels along each axis)");
        if (!(low > -farthest && high < farthest))
            throw ArgumentError("build_occupancy", "occupancy resolution", resolution,
                                "at least " + number(reach / farthest) + " m so far from the origin");
        box.low[axis] = int(low);
        box.high[axis] = int(high);
        box.origin[axis] = origin_of(low, high);
    }
    return box;
}

/// Columns of cubes with a side of 2^level voxels, over a rectangle. All cubes beyond the rectangle are unknown.
/// Coordinates are in cubes from OctoMap's lowest key.
class Profiles {
public:
    Profiles(int level, int x0, int y0, int cols, int rows) : level_(level), x0_(x0), y0_(y0), cols_(cols), rows_(rows)
    {
        starts_.reserve(std::size_t(cols) * std::size_t(rows) + 1);
        starts_.push_back(0);
    }

    int level() const { return level_; }
    std::span<const Stretch> stretches_at(int x, int y) const
    {
        if (x < x0_ || y < y0_ || x >= x0_ + cols_ || y >= y0_ + rows_) return {&beyond_, 1};
        const std::size_t column = std::size_t(y - y0_) * std::size_t(cols_) + std::size_t(x - x0_);
        return std::span(stretches_).subspan(starts_[column], starts_[column + 1] - starts_[column]);
    }
    Content content_at(int x, int y, int z) const
    {
        const auto column = stretches_at(x, y);
        return std::upper_bound(column.begin(), column.end(), z,
                                [](int cube, const Stretch& s) { return cube < s.end; })
            ->content;
    }

    void add(std::span<const Stretch> column)  ///< adds the next column, row after row
    {
        stretches_.insert(stretches_.end(), column.begin(), column.end());
        starts_.push_back(std::uint32_t(stretches_.size()));
    }

    /// Returns the same space in cubes twice as large. O(stretches).
    Profiles halved() const
    {
        const int x0 = x0_ >> 1, y0 = y0_ >> 1, x1 = (x0_ + cols_ - 1) >> 1, y1 = (y0_ + rows_ - 1) >> 1;
        Profiles out(level_ + 1, x0, y0, x1 - x0 + 1, y1 - y0 + 1);
        Profile common, coarse;
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                merge({stretches_at(2 * x, 2 * y), stretches_at(2 * x + 1, 2 * y), stretches_at(2 * x, 2 * y + 1),
                       stretches_at(2 * x + 1, 2 * y + 1)},
                      common);
                halve(common, coarse);
                out.add(coarse);
            }
        return out;
    }

private:
    /// Writes to `out` what four columns have in common; Mixed where they differ.
    static void merge(std::array<std::span<const Stretch>, 4> columns, Profile& out)
    {
        out.clear();
        while (!columns[0].empty()) {
            Content content = columns[0].front().content;
            int end = columns[0].front().end;
            for (const auto& column : columns) {
                end = std::min(end, column.front().end);
                if (column.front().content != content) content = Content::Mixed;
            }
            append(out, end, content);
            for (auto& column : columns)
                if (column.front().end == end) column = column.subspan(1);
        }
    }

    /// Writes to `out` the same column in cubes twice as high.
    static void halve(const Profile& fine, Profile& out)
    {
        out.clear();
        for (const Stretch& stretch : fine) {
            append(out, stretch.end / 2, stretch.content);
            append(out, (stretch.end + 1) / 2, Content::Mixed);  // appends nothing if the end is even
        }
    }

    int level_, x0_, y0_, cols_, rows_;
    Stretch beyond_{(2 * key_offset) >> level_, Content::Unknown};
    std::vector<std::uint32_t> starts_;
    std::vector<Stretch> stretches_;
};

/// Returns the profiles of cols x rows voxel columns of the box, from its column i0 and row j0 on.
Profiles voxel_profiles(const Geometry& geometry, const VoxelBox& box, double resolution, int i0, int j0, int cols,
                        int rows)
{
    const CellBlock block{(box.low[0] + i0) * resolution, (box.low[1] + j0) * resolution, resolution, cols, rows};
    const std::optional<Column> same = uniform_column(
        geometry, {block.x0, block.y0, block.x0 + cols * resolution, block.y0 + rows * resolution});
    std::optional<CellSpans> surfaces;
    if (!same) surfaces.emplace(geometry, block);
    thread_local Columns centres;  // its memory is used again for the next block
    const bool may_be_filled = !same && geometry.impl().has_filled_meshes;
    if (may_be_filled) centres.set(geometry, {block.x0, block.y0, resolution, 0, 0, cols, rows, 0.5});
    const auto voxel = [](double value) { return int(std::clamp(value, -2e9, 2e9)); };
    struct Run {
        int low, high;  // inclusive
    };
    std::vector<Run> runs;
    const auto add = [&](int low, int high) {
        low = std::max(low, box.low[2]);
        high = std::min(high, box.high[2]);
        if (low <= high) runs.push_back({low, high});
    };
    Profiles out(0, box.key(0, box.low[0] + i0), box.key(1, box.low[1] + j0), cols, rows);
    std::vector<Interval> touching;
    Profile profile;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < cols; ++i) {
            if (same && (i > 0 || j > 0)) {
                out.add(profile);
                continue;
            }
            runs.clear();
            if (same)
                touching = solid_intervals(*same);
            else
                surfaces->get(block.id(i, j), touching);
            for (const Interval& span : touching)  // all voxels that it touches; they are closed boxes
                add(voxel(std::ceil((span.bottom - touch_tolerance) / resolution) - 1),
                    voxel(std::floor((span.top + touch_tolerance) / resolution)));
            if (may_be_filled)
                for (const Span& span : centres.at(i, j).spans)  // all voxels whose centres are in it
                    add(voxel(std::ceil(span.bottom / resolution - 0.5)),
                        voxel(std::floor(span.top / resolution - 0.5)));
            if (runs.size() > 1)
                std::sort(runs.begin(), runs.end(), [](const Run& l, const Run& r) { return l.low < r.low; });
            profile.clear();
            append(profile, box.key(2, box.low[2]), Content::Unknown);
            for (const Run& run : runs) {
                append(profile, box.key(2, run.low), Content::Free);
                append(profile, box.key(2, run.high + 1), Content::Occupied);
            }
            append(profile, box.key(2, box.high[2] + 1), Content::Free);
            append(profile, 2 * key_offset, Content::Unknown);
            out.add(profile);
        }
    return out;
}

/// Writes the nodes of a Mixed cube. `levels` ends with the profiles of the cube's level. A Mixed cube of levels[0] is
/// written by under(x, y, z, out) instead.
template <class Under>
void write_cube(std::span<const Profiles> levels, int x, int y, int z, const Under& under, TreeBytes& out)
{
    if (levels.size() == 1) return under(x, y, z, out);
    const Profiles& below = levels[levels.size() - 2];
    std::array<Content, 8> contents;
    unsigned bits = 0;
    for (int child = 0; child < 8; ++child) {
        const Content content = below.content_at(2 * x + (child & 1), 2 * y + (child >> 1 & 1), 2 * z + (child >> 2));
        contents[std::size_t(child)] = content;
        bits |= unsigned(content) << (2 * child);
        if (content == Content::Mixed)
            ++out.inner;
        else if (content != Content::Unknown)
            ++out.leaves;
    }
    out.nodes += char(bits & 0xff);
    out.nodes += char(bits >> 8);
    for (int child = 0; child < 8; ++child)
        if (contents[std::size_t(child)] == Content::Mixed)
            write_cube(levels.first(levels.size() - 1), 2 * x + (child & 1), 2 * y + (child >> 1 & 1),
                       2 * z + (child >> 2), under, out);
}

Tower build_tower(const Geometry& geometry, const VoxelBox& box, double resolution, int x, int y)
{
    // The voxels of the box that lie in a cube: the first one, counted from the box's lowest, and their number.
    const auto part = [&](int axis, int cube) {
        const int first = box.low[std::size_t(axis)], last = box.high[std::size_t(axis)];
        const int low = std::max(0, box.voxel(axis, cube * tower_side) - first);
        const int end = std::min(last + 1, box.voxel(axis, (cube + 1) * tower_side)) - first;
        return std::pair{low, end - low};
    };
    const auto [i0, cols] = part(0, x);
    const auto [j0, rows] = part(1, y);
    std::vector<Profiles> levels{voxel_profiles(geometry, box, resolution, i0, j0, cols, rows)};
    while (levels.back().level() < tower_level) levels.push_back(levels.back().halved());
    Tower tower;
    int z = 0;
    for (const Stretch& stretch : levels.back().stretches_at(x, y)) {
        tower.profile.push_back(stretch);
        for (; z < stretch.end; ++z)
            if (stretch.content == Content::Mixed) {
                TreeBytes& cube = tower.cubes[z];
                cube.inner = 0;
                write_cube(
                    std::span<const Profiles>(levels), x, y, z, [](int, int, int, TreeBytes&) {}, cube);
            }
    }
    return tower;
}

/// The voxels of a map, and the towers that contain them.
struct VoxelGrid {
    VoxelBox box;
    TowerGrid towers;
};

VoxelGrid voxel_grid(const Bounds& bounds, double resolution)
{
    if (!(resolution > 0) || !std::isfinite(resolution))
        throw ArgumentError("build_occupancy", "resolution", resolution, "> 0 m");
    const VoxelBox box = voxels_in(bounds, resolution);
    const auto cube_of = [&](int axis, int voxel) { return box.key(axis, voxel) >> tower_level; };
    const int x0 = cube_of(0, box.low[0]), y0 = cube_of(1, box.low[1]);
    return {box, {x0, y0, cube_of(0, box.high[0]) - x0 + 1, cube_of(1, box.high[1]) - y0 + 1}};
}

/// Makes those towers for which must_make(tower) is true.
template <class MustMake>
void make_towers(const Geometry& geometry, const VoxelGrid& grid, double resolution, int threads,
                 const Progress& progress, const MustMake& must_make, std::vector<Tower>& towers)
{
    parallel_for(towers.size(), threads, progress, [&](std::size_t t) {
        const int x = grid.towers.x0 + int(t) % grid.towers.cols, y = grid.towers.y0 + int(t) / grid.towers.cols;
        if (must_make(x, y)) towers[t] = build_tower(geometry, grid.box, resolution, x, y);
    });
}

TreeBytes tree_of(const std::vector<Tower>& towers, const TowerGrid& grid)
{
    std::vector<Profiles> levels{Profiles(tower_level, grid.x0, grid.y0, grid.cols, grid.rows)};
    for (const Tower& tower : towers) levels.back().add(tower.profile);
    while (levels.back().level() < tree_depth) levels.push_back(levels.back().halved());
    TreeBytes out;
    write_cube(
        std::span<const Profiles>(levels), 0, 0, 0,
        [&](int x, int y, int z, TreeBytes& tree) {
            const TreeBytes& cube = towers[grid.index(x, y)].cubes.at(z);
            tree.nodes += cube.nodes;
            tree.inner += cube.inner;
            tree.leaves += cube.leaves;
        },
        out);
    return out;
}

TreeBytes build_tree(const Geometry& geometry, const Bounds& bounds, double resolution, int threads,
                     const Progress& progress)
{
    const VoxelGrid grid = voxel_grid(bounds, resolution);
    std::vector<Tower> towers(grid.towers.count());
    make_towers(
        geometry, grid, resolution, threads, progress, [](int, int) { return true; }, towers);
    return tree_of(towers, grid.towers);
}

/// Returns the bytes of a .bt file. Its header is written here because octomap's writeBinary prints to standard error.
std::string bt_file(double resolution, std::size_t size, const std::string& nodes)
{
    return "# Octomap OcTree binary file\n# (feel free to add / change comments, but leave the first line as it "
           "is!)\n#\nid OcTree\nsize " +
           std::to_string(size) + "\nres " + number(resolution) + "\ndata\n" + nodes;
}

}  // namespace

OccupancyTree::OccupancyTree(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OccupancyTree::OccupancyTree(OccupancyTree&&) noexcept = default;
OccupancyTree::~OccupancyTree() = default;

Vec3 occupancy_origin(const Bounds& bounds, double resolution)
{
    const VoxelBox box = voxels_in(bounds, resolution);
    return Vec3(box.origin[0], box.origin[1], box.origin[2]) * resolution;
}

const Vec3& OccupancyTree::origin() const { return impl_->origin; }
double OccupancyTree::resolution() const { return impl_->tree->getResolution(); }
std::size_t OccupancyTree::leaves() const { return impl_->tree->getNumLeafNodes(); }

OccupancyTree::State OccupancyTree::at(const Vec3& point) const
{
    const Vec3 local = point - impl_->origin;
    const octomap::OcTreeNode* node = impl_->tree->search(local.x(), local.y(), local.z());
    if (node == nullptr) return State::Unknown;
    return impl_->tree->isNodeOccupied(node) ? State::Occupied : State::Free;
}

void OccupancyTree::write(const std::filesystem::path& file) const
{
    std::ostringstream nodes(std::ios::binary);
    if (impl_->tree->size() > 0) impl_->tree->writeBinaryNode(nodes, impl_->tree->getRoot());
    write_file_atomically(file, bt_file(resolution(), impl_->tree->size(), nodes.str()));
}

OccupancyTree build_occupancy(const Geometry& geometry, const Bounds& bounds, double resolution, int threads,
                              const Progress& progress)
{
    const TreeBytes bytes = build_tree(geometry, bounds, resolution, threads, progress);
    std::istringstream nodes(bytes.nodes, std::ios::binary);
    auto tree = std::make_shared<octomap::OcTree>(resolution);
    tree->readBinaryData(nodes);
    auto impl = std::make_unique<OccupancyTree::Impl>();
    impl->tree = std::move(tree);
    impl->origin = occupancy_origin(bounds, resolution);
    return OccupancyTree(std::move(impl));
}

namespace {

/// Returns the number of leaves.
std::size_t write_tree(const std::filesystem::path& file, double resolution, const TreeBytes& tree)
{
    write_file_atomically(file, bt_file(resolution, tree.inner + tree.leaves, tree.nodes));
    return tree.leaves;
}

}  // namespace

std::size_t write_occupancy(const std::filesystem::path& file, const Geometry& geometry, const Bounds& bounds,
                            double resolution, int threads, const Progress& progress)
{
    return write_tree(file, resolution, build_tree(geometry, bounds, resolution, threads, progress));
}

std::size_t write_changed_occupancy(const std::filesystem::path& file, const std::filesystem::path& old_file,
                                    const Geometry& geometry, const Bounds& bounds, double resolution,
                                    std::span<const ElementBox> boxes, int threads)
{
    const VoxelGrid grid = voxel_grid(bounds, resolution);
    std::vector<Tower> towers = read_towers(old_file, grid.towers);
    const double side = resolution * tower_side;
    const auto may_change = [&](int x, int y) {
        const double low_x = (grid.box.voxel(0, x << tower_level) - 1) * resolution,
                     low_y = (grid.box.voxel(1, y << tower_level) - 1) * resolution,
                     high_x = low_x + side + 2 * resolution, high_y = low_y + side + 2 * resolution;
        return std::any_of(boxes.begin(), boxes.end(), [&](const ElementBox& box) {
            return box.min[0] <= high_x && box.max[0] >= low_x && box.min[1] <= high_y && box.max[1] >= low_y;
        });
    };
    make_towers(geometry, grid, resolution, threads, {}, may_change, towers);
    return write_tree(file, resolution, tree_of(towers, grid.towers));
}

OccupancyTree read_occupancy(const std::filesystem::path& file, const Vec3& origin)
{
    auto impl = std::make_unique<OccupancyTree::Impl>();
    impl->tree = read_octomap(file);
    impl->origin = origin;
    return OccupancyTree(std::move(impl));
}

}  // namespace spawnfield

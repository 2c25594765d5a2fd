#include "base/number.h"
#include "base/parallel.h"
#include "map/cell_clip.h"
#include "map/occupancy_impl.h"
#include "scene/octomap_file.h"

#include <spawnfield/error.h>
#include <spawnfield/occupancy.h>
#include <spawnfield/output_file.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace spawnfield {
namespace {

constexpr int key_offset = 32768;  // OctoMap's key of the voxel from 0 to one resolution
constexpr int depth = 16;          // levels of an OcTree

/// Voxel indices low .. high of one column, inclusive.
struct Run {
    int low, high;
};

struct VoxelBox {
    std::array<int, 3> low, high;  ///< inclusive
};

VoxelBox voxels_in(const Bounds& bounds, double resolution)
{
    VoxelBox box{};
    for (int axis = 0; axis < 3; ++axis) {
        const double low = std::floor(bounds.min[axis] / resolution + 1e-9);
        const double high = std::max(low, std::ceil(bounds.max[axis] / resolution - 1e-9) - 1);
        if (!(low >= -key_offset && high < key_offset))
            throw ArgumentError("build_occupancy", "resolution", resolution,
                                "at least " + number(std::max(std::abs(bounds.min[axis]), std::abs(bounds.max[axis])) / (key_offset - 1)) +
                                    " m here (OctoMap reaches 32768 voxels from the origin)");
        box.low[axis] = int(low);
        box.high[axis] = int(high);
    }
    return box;
}

/// Occupied runs of every voxel column of a box.
class VoxelColumns {
public:
    VoxelColumns(const Geometry& geometry, const VoxelBox& box, double resolution, int threads,
                 const Progress& progress)
        : box_(box), resolution_(resolution), cols_(box.high[0] - box.low[0] + 1), rows_(box.high[1] - box.low[1] + 1)
    {
        constexpr int side = 128;
        columns_.resize(std::size_t(cols_) * std::size_t(rows_));
        const int blocks_x = (cols_ + side - 1) / side, blocks_y = (rows_ + side - 1) / side;
        parallel_for(std::size_t(blocks_x) * std::size_t(blocks_y), threads, progress, [&](std::size_t b) {
            const int i0 = int(b) % blocks_x * side, j0 = int(b) / blocks_x * side;
            fill_block(geometry, i0, j0, std::min(side, cols_ - i0), std::min(side, rows_ - j0));
        });
    }

    const VoxelBox& box() const { return box_; }
    const std::vector<Run>& runs(int x, int y) const
    {
        return columns_[std::size_t(y - box_.low[1]) * std::size_t(cols_) + std::size_t(x - box_.low[0])];
    }

private:
    void fill_block(const Geometry& geometry, int i0, int j0, int cols, int rows)
    {
        const CellBlock block{(box_.low[0] + i0) * resolution_, (box_.low[1] + j0) * resolution_, resolution_, cols, rows};
        const CellSpans surfaces(geometry, block);
        const Columns centres(geometry, {block.x0, block.y0, resolution_, 0, 0, cols, rows, 0.5});
        std::vector<Interval> touching;
        std::vector<Run> runs;
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < cols; ++i) {
                runs.clear();
                surfaces.get(block.id(i, j), touching);
                for (const Interval& span : touching) add(touched(span), runs);
                for (const Span& span : centres.at(i, j).spans) add(centres_in({span.bottom, span.top}), runs);
                columns_[std::size_t(j0 + j) * std::size_t(cols_) + std::size_t(i0 + i)] = joined(runs);
            }
    }

    int voxel(double value) const { return int(std::clamp(value, -1e6, 1e6)); }
    /// Voxels, as closed boxes, that a span of heights touches.
    Run touched(const Interval& span) const
    {
        return {voxel(std::ceil((span.bottom - touch_tolerance) / resolution_) - 1),
                voxel(std::floor((span.top + touch_tolerance) / resolution_))};
    }
    Run centres_in(const Interval& solid) const
    {
        return {voxel(std::ceil(solid.bottom / resolution_ - 0.5)), voxel(std::floor(solid.top / resolution_ - 0.5))};
    }

    void add(Run run, std::vector<Run>& runs) const
    {
        run.low = std::max(run.low, box_.low[2]);
        run.high = std::min(run.high, box_.high[2]);
        if (run.low <= run.high) runs.push_back(run);
    }

    static std::vector<Run> joined(std::vector<Run>& runs)
    {
        std::sort(runs.begin(), runs.end(), [](const Run& l, const Run& r) { return l.low < r.low; });
        std::vector<Run> out;
        for (const Run& run : runs) {
            if (!out.empty() && run.low <= out.back().high + 1) out.back().high = std::max(out.back().high, run.high);
            else out.push_back(run);
        }
        return out;
    }

    const VoxelBox box_;
    const double resolution_;
    const int cols_, rows_;
    std::vector<std::vector<Run>> columns_;
};

enum class Content { Unknown, Free, Occupied, Mixed };

Content merge(Content a, Content b) { return a == b ? a : Content::Mixed; }

/// An OcTree built from voxel columns from the top down, so that nothing is inserted that would be pruned again.
class ColumnOcTree : public octomap::OcTree {
public:
    ColumnOcTree(const VoxelColumns& columns, double voxel) : OcTree(voxel), columns_(columns)
    {
        root = new octomap::OcTreeNode();
        ++tree_size;
        fill(root, {-key_offset, -key_offset, -key_offset}, 1 << depth);
    }

private:
    void fill(octomap::OcTreeNode* node, const std::array<int, 3>& low, int side)
    {
        const int half = side / 2;
        for (unsigned child = 0; child < 8; ++child) {
            const std::array<int, 3> corner{low[0] + (child & 1 ? half : 0), low[1] + (child & 2 ? half : 0),
                                            low[2] + (child & 4 ? half : 0)};
            const Content content = content_of(corner, half);
            if (content == Content::Unknown) continue;
            octomap::OcTreeNode* const made = createNodeChild(node, child);
            if (content == Content::Mixed) fill(made, corner, half);
            else made->setLogOdds(content == Content::Occupied ? getClampingThresMaxLog() : getClampingThresMinLog());
        }
        node->updateOccupancyChildren();
    }

    Content content_of(const std::array<int, 3>& low, int side) const
    {
        const VoxelBox& box = columns_.box();
        bool whole = true;  // whether the cube lies in the box
        for (int axis = 0; axis < 3; ++axis) {
            if (low[axis] > box.high[axis] || low[axis] + side - 1 < box.low[axis]) return Content::Unknown;
            whole = whole && low[axis] >= box.low[axis] && low[axis] + side - 1 <= box.high[axis];
        }
        if (!whole) return Content::Mixed;
        Content all = run_content(columns_.runs(low[0], low[1]), low[2], side);
        for (int y = low[1]; y < low[1] + side && all != Content::Mixed; ++y)
            for (int x = low[0]; x < low[0] + side && all != Content::Mixed; ++x)
                all = merge(all, run_content(columns_.runs(x, y), low[2], side));
        return all;
    }

    static Content run_content(const std::vector<Run>& runs, int low, int side)
    {
        const auto run = std::find_if(runs.begin(), runs.end(), [&](const Run& r) { return r.high >= low; });
        if (run == runs.end() || run->low > low + side - 1) return Content::Free;
        return run->low <= low && run->high >= low + side - 1 ? Content::Occupied : Content::Mixed;
    }

    const VoxelColumns& columns_;
};

}  // namespace

OccupancyTree::OccupancyTree(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OccupancyTree::OccupancyTree(OccupancyTree&&) noexcept = default;
OccupancyTree::~OccupancyTree() = default;

double OccupancyTree::resolution() const { return impl_->tree->getResolution(); }
std::size_t OccupancyTree::leaves() const { return impl_->tree->getNumLeafNodes(); }

OccupancyTree::State OccupancyTree::at(const Vec3& point) const
{
    const octomap::OcTreeNode* node = impl_->tree->search(point.x(), point.y(), point.z());
    if (node == nullptr) return State::Unknown;
    return impl_->tree->isNodeOccupied(node) ? State::Occupied : State::Free;
}

void OccupancyTree::write(const std::filesystem::path& file) const
{
    // octomap's own writeBinary tells standard error about it, so its header is written here.
    std::ostringstream bytes(std::ios::binary);
    bytes << "# Octomap OcTree binary file\n# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
          << "id " << impl_->tree->getTreeType() << "\nsize " << impl_->tree->size() << "\nres " << number(resolution())
          << "\ndata\n";
    if (impl_->tree->size() > 0) impl_->tree->writeBinaryNode(bytes, impl_->tree->getRoot());
    write_file_atomically(file, bytes.str());
}

OccupancyTree build_occupancy(const Geometry& geometry, const Bounds& bounds, double resolution,
                              int threads, const Progress& progress)
{
    if (!(resolution > 0) || !std::isfinite(resolution)) throw ArgumentError("build_occupancy", "resolution", resolution, "> 0 m");
    const VoxelColumns columns(geometry, voxels_in(bounds, resolution), resolution, threads, progress);
    auto impl = std::make_unique<OccupancyTree::Impl>();
    auto tree = std::make_shared<octomap::OcTree>(resolution);
    ColumnOcTree(columns, resolution).swapContent(*tree);
    impl->tree = std::move(tree);
    return OccupancyTree(std::move(impl));
}

OccupancyTree read_occupancy(const std::filesystem::path& file)
{
    auto impl = std::make_unique<OccupancyTree::Impl>();
    impl->tree = read_octomap(file);
    return OccupancyTree(std::move(impl));
}

}  // namespace spawnfield

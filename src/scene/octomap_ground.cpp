#include "scene/octomap_ground.h"

#include <spawnfield/error.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>

namespace spawnfield {
namespace {

constexpr int reach = 3;        // number of columns to each side
constexpr int least_tops = 16;  // (reach + 1)^2, as at the corner of a level floor
constexpr std::size_t most_tops = 100000000;

/// The open upper side of an occupied voxel.
struct Top {
    std::uint16_t x, y;  ///< voxels from the tree's lowest corner
    std::int32_t z;
    std::size_t leaf;  ///< index of its leaf among the occupied leaves
};

class OpenTops {
public:
    OpenTops(const octomap::OcTree& tree, const std::string& file)
    {
        for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end && !knows_free_; ++leaf)
            knows_free_ = !tree.isNodeOccupied(*leaf);
        std::size_t top_count = 0;
        for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
            if (!tree.isNodeOccupied(*leaf)) continue;
            const octomap::OcTreeKey low = leaf.getIndexKey();
            const int side = 1 << (tree.getTreeDepth() - leaf.getDepth());
            top_count += std::size_t(side) * std::size_t(side);
            if (top_count > most_tops)
                throw FileError(file,
                                "has leaves that are too large to be labelled by slope; give the whole OctoMap one "
                                "label with --label");
            add_leaf(tree, low, side);
            ++leaves_;
        }
        std::sort(tops_.begin(), tops_.end(),
                  [](const Top& l, const Top& r) { return std::tie(l.x, l.y, l.z) < std::tie(r.x, r.y, r.z); });
        for (std::size_t i = 0; i < tops_.size(); ++i) columns_.try_emplace(column(tops_[i].x, tops_[i].y), i);
    }

    const std::vector<Top>& all() const { return tops_; }
    std::size_t leaves() const { return leaves_; }

    /// Returns the top of a column that is nearest to a height; null if none is within `limit`.
    const Top* nearest(int x, int y, int z, double limit) const
    {
        const auto found = columns_.find(column(x, y));
        const Top* best = nullptr;
        for (std::size_t i = found == columns_.end() ? tops_.size() : found->second;
             i < tops_.size() && tops_[i].x == x && tops_[i].y == y; ++i)
            if (std::abs(tops_[i].z - z) <= limit &&
                (best == nullptr || std::abs(tops_[i].z - z) < std::abs(best->z - z)))
                best = &tops_[i];
        return best;
    }

private:
    static std::uint64_t column(int x, int y) { return (std::uint64_t(std::uint32_t(x)) << 32) | std::uint32_t(y); }

    void add_leaf(const octomap::OcTree& tree, const octomap::OcTreeKey& low, int side)
    {
        const int above = low[2] + side;
        for (int x = low[0]; x < low[0] + side; ++x)
            for (int y = low[1]; y < low[1] + side; ++y) {
                const octomap::OcTreeNode* const over =
                    above > 0xffff
                        ? nullptr
                        : tree.search(octomap::OcTreeKey(std::uint16_t(x), std::uint16_t(y), std::uint16_t(above)));
                const bool is_open = over == nullptr ? !knows_free_ : !tree.isNodeOccupied(over);
                if (is_open) tops_.push_back({std::uint16_t(x), std::uint16_t(y), above, leaves_});
            }
    }

    bool knows_free_ = false;
    std::vector<Top> tops_;                                   ///< sorted by column, then by height
    std::unordered_map<std::uint64_t, std::size_t> columns_;  ///< index of the column's first top
    std::size_t leaves_ = 0;
};

bool is_ground(const Top& top, const OpenTops& tops, double max_slope)
{
    const double rise = std::max(1.0, std::tan(max_slope));
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    int count = 0;
    for (int dx = -reach; dx <= reach; ++dx)
        for (int dy = -reach; dy <= reach; ++dy) {
            const double limit = 1 + rise * std::hypot(dx, dy);  // + 1, because heights are whole voxels
            const Top* const near = tops.nearest(top.x + dx, top.y + dy, top.z, limit);
            if (near == nullptr) continue;
            const Eigen::Vector3d row(dx, dy, 1);
            squares += row * row.transpose();
            right += row * double(near->z - top.z);
            ++count;
        }
    if (count < least_tops) return false;
    const Eigen::Vector3d plane = squares.ldlt().solve(right);
    return plane.head<2>().norm() < std::tan(max_slope);
}

}  // namespace

std::vector<bool> ground_leaves(const octomap::OcTree& tree, double max_slope, const std::string& file)
{
    const OpenTops tops(tree, file);
    std::vector<std::uint32_t> open(tops.leaves()), ground(tops.leaves());
    for (const Top& top : tops.all()) {
        ++open[top.leaf];
        ground[top.leaf] += is_ground(top, tops, max_slope) ? 1 : 0;
    }
    std::vector<bool> out(tops.leaves());
    for (std::size_t leaf = 0; leaf < out.size(); ++leaf) out[leaf] = open[leaf] > 0 && 2 * ground[leaf] >= open[leaf];
    return out;
}

}  // namespace spawnfield

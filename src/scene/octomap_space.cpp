#include "scene/octomap_space.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace spawnfield {
namespace {

constexpr std::uint32_t all_voxels = 1u << 16;  // along each axis of a tree

VoxelBox cube(const std::array<std::uint32_t, 3>& corner, std::uint32_t side)
{
    return {corner, {corner[0] + side, corner[1] + side, corner[2] + side}};
}

VoxelBox child_of(const VoxelBox& box, unsigned child)
{
    const std::uint32_t half = (box.hi[0] - box.lo[0]) / 2;
    std::array<std::uint32_t, 3> corner = box.lo;
    for (unsigned axis = 0; axis < 3; ++axis)
        if ((child >> axis & 1) != 0) corner[axis] += half;
    return cube(corner, half);
}

/// Calls known(box) for each leaf and missing(box) for each child that a node lacks.
template <class Known, class Missing>
void visit(const octomap::OcTree& tree, const octomap::OcTreeNode& node, const VoxelBox& box, const Known& known,
           const Missing& missing)
{
    if (!tree.nodeHasChildren(&node)) return known(box);
    for (unsigned child = 0; child < 8; ++child) {
        const VoxelBox inner = child_of(box, child);
        if (tree.nodeChildExists(&node, child))
            visit(tree, *tree.getNodeChild(&node, child), inner, known, missing);
        else
            missing(inner);
    }
}

template <class Known, class Missing>
void visit(const octomap::OcTree& tree, const Known& known, const Missing& missing)
{
    const VoxelBox all = cube({0, 0, 0}, all_voxels);
    if (tree.getRoot() == nullptr)
        missing(all);
    else
        visit(tree, *tree.getRoot(), all, known, missing);
}

/// Joins boxes that touch along an axis and have the same sides there. Returns whether there were any.
bool join(std::vector<VoxelBox>& boxes, std::size_t axis)
{
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto row = [&](const VoxelBox& box) { return std::tuple(box.lo[u], box.hi[u], box.lo[v], box.hi[v]); };
    std::sort(boxes.begin(), boxes.end(), [&](const VoxelBox& a, const VoxelBox& b) {
        return std::tuple(row(a), a.lo[axis]) < std::tuple(row(b), b.lo[axis]);
    });
    std::vector<VoxelBox> out;
    for (const VoxelBox& box : boxes) {
        if (!out.empty() && row(out.back()) == row(box) && out.back().hi[axis] == box.lo[axis])
            out.back().hi[axis] = box.hi[axis];
        else
            out.push_back(box);
    }
    const bool any = out.size() < boxes.size();
    boxes = std::move(out);
    return any;
}

}  // namespace

VoxelBox known_extent(const octomap::OcTree& tree)
{
    VoxelBox extent;
    extent.lo.fill(std::numeric_limits<std::uint32_t>::max());
    const auto known = [&](const VoxelBox& box) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            extent.lo[axis] = std::min(extent.lo[axis], box.lo[axis]);
            extent.hi[axis] = std::max(extent.hi[axis], box.hi[axis]);
        }
    };
    visit(tree, known, [](const VoxelBox&) {});
    return extent.hi[0] == 0 ? VoxelBox() : extent;
}

std::vector<VoxelBox> unknown_boxes(const octomap::OcTree& tree, const VoxelBox& within)
{
    std::vector<VoxelBox> out;
    const auto missing = [&](VoxelBox box) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = std::max(box.lo[axis], within.lo[axis]);
            box.hi[axis] = std::min(box.hi[axis], within.hi[axis]);
            if (box.lo[axis] >= box.hi[axis]) return;
        }
        out.push_back(box);
    };
    visit(
        tree, [](const VoxelBox&) {}, missing);
    return joined(std::move(out));
}

std::vector<VoxelBox> joined(std::vector<VoxelBox> boxes)
{
    for (bool any = true; any;) {
        any = false;
        for (const std::size_t axis : {2, 0, 1}) any |= join(boxes, axis);  // walls first
    }
    return boxes;
}

double known_volume(const octomap::OcTree& tree)
{
    double voxels = 0;
    visit(
        tree, [&](const VoxelBox& box) { voxels += box.volume(); }, [](const VoxelBox&) {});
    return voxels;
}

Bounds bounds_of(const octomap::OcTree& tree, const VoxelBox& box)
{
    Bounds bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bounds.min[int(axis)] = (double(box.lo[axis]) - all_voxels / 2) * tree.getResolution();
        bounds.max[int(axis)] = (double(box.hi[axis]) - all_voxels / 2) * tree.getResolution();
    }
    return bounds;
}

}  // namespace spawnfield

#pragma once

#include <spawnfield/types.h>

#include <octomap/OcTree.h>

#include <array>
#include <vector>

namespace spawnfield {

/// Voxels lo .. hi - 1 along each axis, counted from the tree's lowest corner.
struct VoxelBox {
    std::array<std::uint32_t, 3> lo{}, hi{};

    double volume() const { return double(hi[0] - lo[0]) * (hi[1] - lo[1]) * (hi[2] - lo[2]); }  ///< voxels
};

/// Smallest box around all that the tree knows, free or occupied; empty without any.
VoxelBox known_extent(const octomap::OcTree& tree);

/// What of the box the tree does not know, as few boxes that share no volume: the children that its nodes lack, joined
/// where they share a whole side. O(nodes log nodes).
std::vector<VoxelBox> unknown_boxes(const octomap::OcTree& tree, const VoxelBox& within);

/// What the tree knows, free or occupied, in voxels.
double known_volume(const octomap::OcTree& tree);

/// m, in the tree's frame.
Bounds bounds_of(const octomap::OcTree& tree, const VoxelBox& box);

}  // namespace spawnfield

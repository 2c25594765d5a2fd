#pragma once

#include <spawnfield/types.h>

#include <octomap/OcTree.h>

#include <array>
#include <vector>

namespace spawnfield {

/// A box of voxels lo .. hi - 1 along each axis, counted from the tree's lowest corner.
struct VoxelBox {
    std::array<std::uint32_t, 3> lo{}, hi{};

    double volume() const { return double(hi[0] - lo[0]) * (hi[1] - lo[1]) * (hi[2] - lo[2]); }  ///< voxels
};

/// Returns the smallest box around all known space, free or occupied; empty if nothing is known.
VoxelBox known_extent(const octomap::OcTree& tree);

/// Returns the same space as fewer boxes: those that share a whole side are joined. The boxes must not overlap.
/// O(boxes log boxes).
std::vector<VoxelBox> joined(std::vector<VoxelBox> boxes);

/// Returns the unknown space of a box as few boxes that do not overlap: the children that nodes lack, joined.
std::vector<VoxelBox> unknown_boxes(const octomap::OcTree& tree, const VoxelBox& within);

/// Returns the volume of the known space, free or occupied, in voxels.
double known_volume(const octomap::OcTree& tree);

/// Returns the box in the tree's frame, m.
Bounds bounds_of(const octomap::OcTree& tree, const VoxelBox& box);

}  // namespace spawnfield

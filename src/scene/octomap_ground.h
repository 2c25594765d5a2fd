#pragma once

#include <octomap/OcTree.h>

#include <string>
#include <vector>

namespace spawnfield {

/// Returns for each occupied leaf, in the order of the tree's leaves, whether it is ground by its slope.
///
/// The top of a voxel is level, so the slope is that of the plane that best fits the open tops in the 7 x 7 columns
/// around it. In each column this is the top that is nearest in height, if a slope of 45 degrees, or of `max_slope` if
/// that is more, reaches it. A top is ground if the plane is less steep than `max_slope` (rad) and at least 16 of the
/// columns have a top, as at the corner of a floor; the tops of walls of up to two voxels have only 14. A top is open
/// if the voxel above it is known to be free. If it is unknown, the top is not open, because no sensor has seen for
/// example the upper side of a ceiling; only in a tree without free voxels, unknown ones count as free. A leaf is
/// ground if at least half of its open tops are. O(open tops). Throws FileError, which begins with `file`, for leaves
/// with more than 100 million tops in total.
std::vector<bool> ground_leaves(const octomap::OcTree& tree, double max_slope, const std::string& file);

}  // namespace spawnfield

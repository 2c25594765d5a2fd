#pragma once

#include <octomap/OcTree.h>

#include <string>
#include <vector>

namespace spawnfield {

/// Which occupied leaves are ground by their slope: one for each, in the order of the tree's leaves.
///
/// Each voxel's top is level, so the slope is that of the plane that fits best the open tops in the 7 x 7 columns
/// around one: in each column the top that is nearest in height, if a slope of 45 degrees, or of `max_slope` if that
/// is more, reaches it. A top is ground if the plane is less steep than `max_slope` (rad) and at least 16 columns
/// have a top, as at the corner of a floor; the tops of walls of up to two voxels have 14. A top is open if the voxel
/// above is known to be free: nobody has seen a ceiling's upper side. Only in a tree that knows no free voxel unknown
/// ones count as free. A leaf is ground if at least half of its open tops are. O(open tops). Throws FileError, which
/// begins with `file`, for leaves with more than 100 million tops.
std::vector<bool> ground_leaves(const octomap::OcTree& tree, double max_slope, const std::string& file);

}  // namespace spawnfield

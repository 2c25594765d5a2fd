#pragma once

#include "settle/convex.h"

#include <spawnfield/geometry.h>

#include <vector>

namespace spawnfield {

/// Returns the length of the shortest horizontal shift of body a with which it touches body b, m. Returns 0 if they
/// touch already, infinity if no shift makes them touch, because one of them is higher than all of the other. Exact to
/// about 1e-9 m. Both must lie near the origin, so that their coordinates are precise.
///
/// A shift (x, y) makes them touch if the point (x, y, 0) is in the set of all q - p with p in a, q in b. This set is
/// convex. Its points that are farthest in some directions are found one after the other, as in Gilbert, Johnson,
/// Keerthi, A fast procedure for computing the distance between complex objects, 1988; but only the part of their hull
/// at height 0 counts.
double horizontal_distance(const Convex& a, const Convex& b);

/// Measures the clearance of robots: the length of the shortest horizontal shift with which a robot touches something
/// with the label obstacle. Terrain and water do not count.
class ClearanceMeter {
public:
    static constexpr double most = 10;  ///< m: larger clearances are not measured

    ClearanceMeter(const Geometry& geometry, const Robot& robot);

    /// Returns the clearance of the robot at a pose, 0 .. most.
    double clearance_at(const Pose& pose) const;

private:
    const Geometry geometry_;
    std::vector<Convex> parts_;  ///< in the robot's frame
};

}  // namespace spawnfield

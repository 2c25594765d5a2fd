#pragma once

#include "settle/convex.h"

#include <spawnfield/geometry.h>

#include <limits>
#include <vector>

namespace spawnfield {

/// Returns the length of the shortest horizontal shift of body a with which it touches body b, m. Returns 0 if they
/// touch already, infinity if no shift makes them touch, because one of them is higher than all of the other. Exact to
/// about 1e-9 m. If the length is more than `most`, may return infinity, which takes less time. Both must lie near the
/// origin, so that their coordinates are precise.
///
/// A shift (x, y) makes them touch if the point (x, y, 0) is in the set of all q - p with p in a, q in b. This set is
/// convex. Its points that are farthest in some directions are found one after the other, as in Gilbert, Johnson,
/// Keerthi, A fast procedure for computing the distance between complex objects, 1988; but only the part of their hull
/// at height 0 counts.
double horizontal_distance(const Convex& a, const Convex& b, double most = std::numeric_limits<double>::infinity());

/// Measures the clearance of robots: the length of the shortest horizontal shift with which a robot touches something
/// with the label obstacle. Terrain and water do not count.
class ClearanceMeter {
public:
    static constexpr double most = 10;  ///< m: larger clearances are not measured

    ClearanceMeter(const Geometry& geometry, const Robot& robot);

    /// What is nearest to the robot at a pose.
    struct Nearest {
        Convex body;  ///< relative to `origin`
        Vec3 origin;  ///< m
        bool is_known = false;
    };

    /// Returns the clearance of the robot at a pose, 0 .. most. `neighbour` is what is nearest at another pose, and
    /// then what is nearest here: poses near each other need less time if they share it. It does not change the
    /// clearance.
    double clearance_at(const Pose& pose, Nearest* neighbour = nullptr) const;

private:
    std::vector<Convex> parts_at(const Mat3& rotation) const;

    const Geometry geometry_;
    std::vector<Convex> parts_;  ///< in the robot's frame
};

}  // namespace spawnfield

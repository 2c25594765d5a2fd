#pragma once

#include "base/polygon2.h"

#include <spawnfield/robot.h>

#include <vector>

namespace spawnfield {

/// An upright prism.
struct Prism {
    Polygon2 polygon;
    double bottom = 0, top = 0;
};

/// A convex part of a robot as seen from above, relative to the robot's origin.
struct Footprint {
    Prism outer;  ///< holds all of the part grown by the touch margin, and FreeSpace::margin more
    Prism inner;  ///< lies in the part, FreeSpace::margin from its surface; no corners: none is known
};

/// Returns the lowest and highest point of the part with the robot turned by `rotation` about its origin.
Interval height_of(const RobotPart& part, const Mat3& rotation);

/// Returns the footprints of all parts with the robot turned by `rotation`; inner prisms only if with_inner is set.
std::vector<Footprint> footprints(const Robot& robot, const Mat3& rotation, bool with_inner);

/// Returns footprints that hold for every yaw of the upright robot: discs around its origin.
std::vector<Footprint> yaw_free_footprints(const Robot& robot);

}  // namespace spawnfield

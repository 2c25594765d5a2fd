#pragma once

#include "base/polygon2.h"

#include <spawnfield/robot.h>

#include <vector>

namespace spawnfield {

/// A prism with vertical sides: a polygon in the x-y plane, from bottom to top, m.
struct Prism {
    Polygon2 polygon;
    double bottom = 0, top = 0;
};

/// Two prisms for a convex part of a robot, relative to the robot's origin: one around the part, one inside it.
struct Footprint {
    Prism outer;  ///< contains the part, grown by touch_margin and then by FreeSpace::margin
    Prism inner;  ///< lies inside the part, at least FreeSpace::margin from its surface; no corners: not known
};

/// Returns the heights of the part's lowest and highest point above the robot's origin, m, when the robot is turned by
/// `rotation` about its origin.
Interval height_of(const RobotPart& part, const Mat3& rotation);

/// Returns the height of the robot's lowest point above its origin, m, when the robot is turned in the same way.
double lowest_point(const Robot& robot, const Mat3& rotation);

/// Returns the footprints of all parts when the robot is turned by `rotation`. Without `with_inner`, the inner prisms
/// have no corners.
std::vector<Footprint> footprints(const Robot& robot, const Mat3& rotation, bool with_inner);

/// Returns footprints that are valid for every yaw of the upright robot. Their polygons are approximate discs around
/// the robot's origin.
std::vector<Footprint> yaw_free_footprints(const Robot& robot);

}  // namespace spawnfield

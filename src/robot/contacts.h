#pragma once

#include "base/polygon2.h"

#include <spawnfield/robot.h>

#include <span>
#include <vector>

namespace spawnfield {

/// What lies so little above a robot's lowest point carries it too, m: tyres sink in, casters are a bit shorter.
inline constexpr double contact_depth = 0.02;

/// Whether points span an area as seen from above: their spread (rms) about any line is more than 1e-6 m.
bool span_area(std::span<const Vec3> points);

/// As seen from above, the convex hull of all that lies within contact_depth of the robot's lowest point; round parts
/// as polygons of 32 corners within them. In the robot's frame.
Polygon2 lowest_footprint(const Robot& robot);

/// Where the robot stands on the ground, in its own frame: its contacts if they span an area, or else the corners of
/// its lowest_footprint, contact_depth above its lowest point: under them the robot begins no lower.
std::vector<Vec3> contacts_of(const Robot& robot);

}  // namespace spawnfield

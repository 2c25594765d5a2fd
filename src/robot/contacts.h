#pragma once

#include "base/polygon2.h"

#include <spawnfield/robot.h>

#include <span>
#include <vector>

namespace spawnfield {

/// Parts of a robot that are at most this far above its lowest point also carry it, m: tyres sink in, and casters are a
/// bit shorter.
inline constexpr double contact_depth = 0.02;

/// Returns whether the points span an area, seen from above: their spread (rms) about every line is more than 1e-6 m.
bool span_area(std::span<const Vec3> points);

/// Returns the convex hull, seen from above, of everything within contact_depth of the robot's lowest point, in the
/// robot's frame. Circles are replaced by polygons of 32 corners inside them.
Polygon2 lowest_footprint(const Robot& robot);

/// Returns where the robot stands on the ground, in its own frame: its contacts if they span an area, otherwise the
/// corners of its lowest_footprint at contact_depth above its lowest point.
std::vector<Vec3> contacts_of(const Robot& robot);

}  // namespace spawnfield

#pragma once

#include <spawnfield/robot.h>

#include <functional>

namespace spawnfield {

using VisitTriangle = std::function<void(const Vec3&, const Vec3&, const Vec3&)>;

/// Visits the triangles of the shape's closed surface, counterclockwise from outside. Shared corners are equal to the
/// last bit. Circles are replaced by polygons of `sides` sides (a multiple of 4), whose corners lie on the surface.
/// Visits nothing for hulls.
void tessellate(const Shape& shape, int sides, const VisitTriangle& visit);

/// Does the same for a part of a robot. For a hull it visits the hull's own faces.
void tessellate(const RobotPart& part, int sides, const VisitTriangle& visit);

/// Does the same for a cone of `sides` sides. `base` is the centre of its base.
void tessellate_cone(const Vec3& base, const Vec3& tip, double radius, int sides, const VisitTriangle& visit);

}  // namespace spawnfield

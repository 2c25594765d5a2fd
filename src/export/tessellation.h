#pragma once

#include <spawnfield/robot.h>

#include <functional>

namespace spawnfield {

using VisitTriangle = std::function<void(const Vec3&, const Vec3&, const Vec3&)>;

/// Triangles of a closed surface around the shape, counterclockwise from outside; corners that are shared are the same
/// bits. Round shapes become polygons of `sides` sides, a multiple of 4, whose corners lie on the surface. Not for
/// hulls.
void tessellate(const Shape& shape, int sides, const VisitTriangle& visit);

/// Of a hull its own faces.
void tessellate(const RobotPart& part, int sides, const VisitTriangle& visit);

/// A cone of so many sides from the centre of its base to its tip.
void tessellate_cone(const Vec3& base, const Vec3& tip, double radius, int sides, const VisitTriangle& visit);

}  // namespace spawnfield

#pragma once

#include <spawnfield/robot.h>

#include <array>
#include <vector>

namespace spawnfield {

/// A convex body: the convex hull of points, or of equal balls or discs around points. So a sphere is a ball around one
/// point, a cylinder is two discs, a triangle three points.
struct Convex {
    struct Plane {
        Vec3 normal;  ///< outwards, of length 1
        double offset;
    };

    std::vector<Vec3> points;
    double ball = 0;            ///< radius of the balls, m
    double disc = 0;            ///< radius of the discs, m
    Vec3 axis = Vec3::UnitZ();  ///< perpendicular to the discs
    // Only of a polyhedron:
    std::vector<std::array<int, 2>> edges;  ///< indices in points
    std::vector<Plane> planes;              ///< of its faces. Those of a triangle: both sides, and three around it
    bool is_triangle = false;               ///< only the first two planes are faces

    bool is_polyhedron() const { return ball == 0 && disc == 0; }
    /// Returns a point of the body that is farthest in this direction (not 0).
    Vec3 support(const Vec3& direction) const;
    Bounds bounds() const;
    std::size_t face_count() const { return is_triangle && !planes.empty() ? 2 : planes.size(); }
};

Convex convex_of(const RobotPart& part);  ///< in the robot's frame
Convex convex_of(const Shape& shape);     ///< in the shape's parent frame; not for hulls
Convex convex_of(const std::array<Vec3, 3>& triangle);
Convex convex_of(const Vec3& point);

/// Sets `out` to what convex_of(triangle) returns. Uses the memory of `out` again.
void set_triangle(Convex& out, const std::array<Vec3, 3>& triangle);

/// Returns the body at another place: parent_from_body * body.
Convex moved(const Convex& body, const Pose& parent_from_body);

/// Sets `out`, which must be a copy of the body, to the body after a rotation about its frame's origin.
void set_rotated(Convex& out, const Convex& body, const Mat3& rotation);

/// Returns the body upside down: z becomes -z.
Convex upside_down(const Convex& body);

/// Returns the bodies around single points, if the body is round: the end discs of a cylinder, the end balls of a
/// capsule. Empty for others.
std::vector<Convex> ends_of(const Convex& body);

}  // namespace spawnfield

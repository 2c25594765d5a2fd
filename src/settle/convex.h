#pragma once

#include <spawnfield/robot.h>

#include <array>
#include <vector>

namespace spawnfield {

/// A convex body: the convex hull of points, or of equal balls or discs around points. So a sphere is a ball around one
/// point, a cylinder is two discs, a triangle three points.
struct Convex {
    struct Plane {
        Vec3 normal;    ///< outwards, of length 1
        double offset;  ///< m; normal . p <= offset for all points p of the body
    };

    std::vector<Vec3> points;
    double ball = 0;              ///< radius of the balls, m
    double disc = 0;              ///< radius of the discs, m
    Vec3 axis = Vec3::UnitZ();    ///< perpendicular to the discs, of length 1
    Vec3 across = Vec3::UnitX();  ///< perpendicular to the axis, of length 1
    // Only for polyhedra:
    std::vector<std::array<int, 2>> edges;  ///< indices in points
    std::vector<std::array<int, 2>>
        edge_planes;  ///< of each edge, indices of the planes that meet there; not for a triangle
    /// The planes of its faces. A triangle has five: one for each of its two sides, then one through each edge,
    /// perpendicular to the triangle. A triangle without area has none.
    std::vector<Plane> planes;
    bool is_triangle = false;  ///< only the first two planes are faces

    bool is_polyhedron() const { return ball == 0 && disc == 0; }
    /// Returns whether an edge belongs to a face that looks downwards. Other edges touch nothing that is below.
    bool is_lower_edge(std::size_t edge) const
    {
        if (edge_planes.empty()) return true;  // of a triangle
        const auto& [a, b] = edge_planes[edge];
        return planes[std::size_t(a)].normal.z() < 0 || planes[std::size_t(b)].normal.z() < 0;
    }
    /// Returns a point of the body that is farthest in this direction (not 0).
    Vec3 support(const Vec3& direction) const;
    Bounds bounds() const;
    std::size_t face_count() const { return is_triangle && !planes.empty() ? 2 : planes.size(); }
};

Convex convex_of(const RobotPart& part);  ///< in the robot's frame
Convex convex_of(const Shape& shape);     ///< in the shape's parent frame; not for hulls
Convex convex_of(const std::array<Vec3, 3>& triangle);
Convex convex_of(const Vec3& point);

/// Returns the body at another place: parent_from_body * body.
Convex moved(const Convex& body, const Pose& parent_from_body);

/// Sets `out` to the body, rotated about the origin of the body's frame. `out` must be a copy of the body or the result
/// of an earlier call for it: only its points, axes and planes are written.
void set_rotated(Convex& out, const Convex& body, const Mat3& rotation);

/// Returns the body upside down: z becomes -z.
Convex upside_down(const Convex& body);

/// Returns the two ends of a cylinder (discs) or a capsule (balls) as separate bodies. Empty for all other bodies, also
/// for a sphere.
std::vector<Convex> ends_of(const Convex& body);

}  // namespace spawnfield

#include "robot/ellipsoid.h"

#include "robot/convex_split.h"
#include "robot/hull.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace spawnfield {
namespace {

/// Corners and middles of edges of the icosahedron's faces cut in four, and again in four: on the unit sphere.
std::vector<Vec3> sphere_points()
{
    const double g = std::numbers::phi;
    std::vector<Vec3> corners;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-g, g})
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 corner = Vec3::Zero();
                corner[(axis + 1) % 3] = a;
                corner[(axis + 2) % 3] = b;
                corners.push_back(corner.normalized());
            }
    for (int round = 0; round < 2; ++round) {
        const RobotPart hull = convex_hull(corners);
        std::vector<Vec3> finer = hull.hull_vertices;
        for (const auto& face : hull.hull_faces)
            for (std::size_t k = 0; k < 3; ++k) {
                const int from = face[k], to = face[(k + 1) % 3];
                if (from < to) finer.push_back((hull.hull_vertices[std::size_t(from)] + hull.hull_vertices[std::size_t(to)]).normalized());
            }
        corners = std::move(finer);
    }
    return corners;
}

}  // namespace

RobotPart ellipsoid_hull(const Vec3& radii, const Pose& robot_from_ellipsoid)
{
    RobotPart hull = convex_hull(sphere_points());
    double nearest = std::numeric_limits<double>::infinity();  // of the faces to the centre
    for (const auto& face : hull.hull_faces) {
        const auto corner = [&](std::size_t k) { return hull.hull_vertices[std::size_t(face[k])]; };
        const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
        nearest = std::min(nearest, std::abs(normal.dot(corner(0))));
    }
    // An affine image of a polyhedron around the unit sphere is one around the sphere's image.
    for (Vec3& vertex : hull.hull_vertices)
        vertex = robot_from_ellipsoid.rotation * (vertex / nearest).cwiseProduct(radii) + robot_from_ellipsoid.position;
    return hull;
}

double ellipsoid_growth(const RobotPart& hull, const Vec3& radii)
{
    return hull_volume(hull) / (4.0 / 3 * std::numbers::pi * radii.prod()) - 1;
}

}  // namespace spawnfield

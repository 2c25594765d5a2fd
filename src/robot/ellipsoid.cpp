#include "robot/ellipsoid.h"

#include "mesh/sphere_mesh.h"
#include "robot/convex_split.h"
#include "robot/hull.h"

#include <numbers>

namespace spawnfield {

RobotPart ellipsoid_hull(const Vec3& radii, const Pose& robot_from_ellipsoid)
{
    RobotPart hull = convex_hull(mesh_around_unit_sphere(2).vertices);
    // An affine map turns a polyhedron around the unit sphere into a polyhedron around the ellipsoid.
    for (Vec3& vertex : hull.hull_vertices)
        vertex = robot_from_ellipsoid.rotation * vertex.cwiseProduct(radii) + robot_from_ellipsoid.position;
    return hull;
}

double ellipsoid_growth(const RobotPart& hull, const Vec3& radii)
{
    return hull_volume(hull) / (4.0 / 3 * std::numbers::pi * radii.prod()) - 1;
}

}  // namespace spawnfield

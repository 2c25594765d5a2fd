#include "scene/plausibility.h"

#include "base/number.h"
#include "scene/elements.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

std::string metres(double value)
{
    return value < 10 ? number(std::round(value * 1000) / 1000) : std::to_string(std::llround(value));
}

struct FaceSizes {
    Vec3 areas = Vec3::Zero();  ///< areas of all faces, seen along x, y and z, m2
    double wall = 0;            ///< height of the largest upright face of a mesh, m
};

FaceSizes measure_faces(const Scene& scene)
{
    constexpr double upright = 0.01;  // sine of the angle from vertical: half a degree, which excludes hillsides
    FaceSizes faces;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const auto [a, b, c] = corners_of(scene, t);
        const Vec3 normal = (b - a).cross(c - a);
        faces.areas += normal.cwiseAbs() / 2;
        const double height = std::max({a.z(), b.z(), c.z()}) - std::min({a.z(), b.z(), c.z()});
        if (height <= faces.wall || !(std::abs(normal.z()) < upright * normal.norm())) continue;
        if (scene.parts[scene.pieces[scene.triangle_pieces[t]].part].kind == "mesh") faces.wall = height;
    }
    return faces;
}

}  // namespace

std::vector<std::string> doubts_about(const Scene& scene, const std::string& file, const Remedies& remedies)
{
    // m across. No simulated world is larger, and no robot's world is smaller.
    constexpr double large = 20000, small = 0.5;
    constexpr double high = 1000;  // m; real walls are lower, but a wall of 1 m in millimetres has this number
    std::vector<std::string> out;
    const Bounds bounds = scene.map_bounds.is_empty() ? scene.bounds() : scene.map_bounds;
    const Vec3 size = bounds.max - bounds.min;
    const double across = size.head<2>().maxCoeff();
    if (across > large || across < small) {
        const bool is_large = across > large;
        out.push_back(
            file + ": is " + metres(size.x()) + " x " + metres(size.y()) + " x " + metres(size.z()) + " m, which is " +
            (is_large ? "large; is it in millimetres? " : "small; is it in other units than metres? ") +
            remedies.scale + (is_large ? " 0.001 converts it to metres" : " 1000 makes it a thousand times larger"));
    }
    const FaceSizes faces = measure_faces(scene);
    if (across <= large && faces.wall >= high)
        out.push_back(file + ": is " + metres(size.x()) + " x " + metres(size.y()) + " x " + metres(size.z()) +
                      " m and has a wall of " + metres(faces.wall) + " m height; is it in millimetres? " +
                      remedies.scale + " 0.001 converts it to metres");
    const Vec3& seen = faces.areas;
    const double sideways = seen.head<2>().maxCoeff(), other = seen.head<2>().minCoeff();
    // A tower has the same area along x and y. A scene on its side has most of its area along one of them.
    if (sideways > 2 * seen.z() && sideways > 2 * other)
        out.push_back(file + ": most of its faces look along " + (seen.y() > seen.x() ? "y" : "x") +
                      ", few up; does it lie on its side? " + remedies.up + " sets the axis that is up");
    return out;
}

}  // namespace spawnfield

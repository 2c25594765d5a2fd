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

struct Look {
    Vec3 areas = Vec3::Zero();  ///< of all faces as seen along x, y and z, m2
    double wall = 0;            ///< height of the highest upright face of a mesh, m
};

Look look_at(const Scene& scene)
{
    constexpr double upright = 0.01;  // sine of its slope against the vertical: half a degree, so no hillside
    Look look;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const auto [a, b, c] = corners_of(scene, t);
        const Vec3 normal = (b - a).cross(c - a);
        look.areas += normal.cwiseAbs() / 2;
        const double height = std::max({a.z(), b.z(), c.z()}) - std::min({a.z(), b.z(), c.z()});
        if (height <= look.wall || !(std::abs(normal.z()) < upright * normal.norm())) continue;
        if (scene.parts[scene.pieces[scene.triangle_pieces[t]].part].kind == "mesh") look.wall = height;
    }
    return look;
}

}  // namespace

std::vector<std::string> doubts_about(const Scene& scene, const std::string& file, const Remedies& remedies)
{
    constexpr double large = 20000, small = 0.5;  // m across: no simulated world is larger, no robot's world smaller
    constexpr double high = 1000;                 // m: nobody builds a wall as high, but 1 m in millimetres is
    std::vector<std::string> out;
    const Bounds bounds = scene.map_bounds.is_empty() ? scene.bounds() : scene.map_bounds;
    const Vec3 size = bounds.max - bounds.min;
    const double across = size.head<2>().maxCoeff();
    if (across > large || across < small) {
        const bool is_large = across > large;
        out.push_back(
            file + ": is " + metres(size.x()) + " x " + metres(size.y()) + " x " + metres(size.z()) + " m, which is " +
            (is_large ? "large: is it in millimetres? " : "small: is it in other units than metres? ") +
            remedies.scale + (is_large ? " 0.001 makes it metres" : " 1000 makes it a thousand times larger"));
    }
    const Look look = look_at(scene);
    if (across <= large && look.wall >= high)
        out.push_back(file + ": is " + metres(size.x()) + " x " + metres(size.y()) + " x " + metres(size.z()) +
                      " m and has a wall of " + metres(look.wall) + " m height: is it in millimetres? " +
                      remedies.scale + " 0.001 makes it metres");
    const Vec3& seen = look.areas;
    const double sideways = seen.head<2>().maxCoeff(), other = seen.head<2>().minCoeff();
    // Towers show as much along x as along y; what lies on its side shows most along one of them.
    if (sideways > 2 * seen.z() && sideways > 2 * other)
        out.push_back(file + ": most of its faces look along " + (seen.y() > seen.x() ? "y" : "x") +
                      ", few up: does it lie on its side? " + remedies.up + " says which axis is up");
    return out;
}

}  // namespace spawnfield

#pragma once

#include <spawnfield/types.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace bench {

using Vec3f = Eigen::Vector3f;

/// A box at a place, for tests against triangles.
struct TurnedBox {
    Vec3f centre, half;  ///< half: half of its side lengths
    Eigen::Matrix3f box_from_world;

    Vec3f reach() const { return box_from_world.cwiseAbs().transpose() * half; }  ///< half the size of its bounds
};

/// Returns whether the axis unit_k x edge separates the box from a triangle. `on_edge` is an end of the edge, `apart`
/// the triangle's third corner; the box is at the origin.
template <int k>
bool is_separated_across(const Vec3f& edge, const Vec3f& on_edge, const Vec3f& apart, const Vec3f& half)
{
    constexpr int u = (k + 1) % 3, v = (k + 2) % 3;
    const float p = edge[u] * on_edge[v] - edge[v] * on_edge[u], q = edge[u] * apart[v] - edge[v] * apart[u];
    const float radius = half[u] * std::abs(edge[v]) + half[v] * std::abs(edge[u]);
    return std::min(p, q) > radius || std::max(p, q) < -radius;
}

/// Returns whether a box and a triangle touch or overlap.
/// Source: Akenine-Moller, Fast 3D triangle-box overlap testing, 2001 (separating axes).
inline bool overlap(const TurnedBox& box, const Vec3f& a_world, const Vec3f& b_world, const Vec3f& c_world)
{
    const Vec3f a = box.box_from_world * (a_world - box.centre), b = box.box_from_world * (b_world - box.centre),
                c = box.box_from_world * (c_world - box.centre);
    const Vec3f low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    if ((low.array() > box.half.array()).any() || (high.array() < -box.half.array()).any()) return false;
    const Vec3f ab = b - a, bc = c - b, ca = a - c, normal = ab.cross(bc);
    if (std::abs(normal.dot(a)) > normal.cwiseAbs().dot(box.half)) return false;
    const auto is_separated = [&](const Vec3f& edge, const Vec3f& on_edge, const Vec3f& apart) {
        return is_separated_across<0>(edge, on_edge, apart, box.half) ||
               is_separated_across<1>(edge, on_edge, apart, box.half) ||
               is_separated_across<2>(edge, on_edge, apart, box.half);
    };
    return !is_separated(ab, a, c) && !is_separated(bc, b, a) && !is_separated(ca, c, b);
}

}  // namespace bench

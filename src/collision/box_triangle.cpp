#include "collision/box_triangle.h"

#include <spawnfield/free_space.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr double least_gap = FreeSpace::margin, least_depth = 2 * FreeSpace::margin;  // m
constexpr double least_angle = 1e-7;  // rad; rounding spoils the direction of axes that come from smaller angles

/// Collects what the axes prove. If an axis is not used, there is no proof of overlap.
class Gaps {
public:
    /// Adds an axis of this squared length. `gap` is the distance between the intervals that the bodies cover on it,
    /// multiplied by the length of the axis; it is negative if they overlap.
    void add(double gap, double squared_length)
    {
        const double squared_gap = gap * gap;
        is_apart |= gap > 0 && squared_gap > least_gap * least_gap * squared_length;
        overlaps &= gap < 0 && squared_gap > least_depth * least_depth * squared_length;
    }

    bool is_apart = false, overlaps = true;
};

/// Returns the gap between low .. high and -reach .. reach.
double gap_between(double low, double high, double reach) { return std::max(low - reach, -reach - high); }

/// Adds the cross products of an edge with the edges of the box. Both ends of the edge have the same coordinate on such
/// an axis, so one end and the opposite corner of the triangle are enough.
void add_edge(const Vec3& half, const Vec3& from, const Vec3& edge, const Vec3& opposite, Gaps& gaps)
{
    const double least = least_angle * least_angle * edge.squaredNorm();
    for (int u = 0; u < 3; ++u) {
        const int v = u == 2 ? 0 : u + 1;  // the axis lies in the plane of u and v
        const double squared_length = edge[u] * edge[u] + edge[v] * edge[v];
        if (squared_length == 0) continue;  // the edges are parallel, and other axes decide
        if (squared_length < least) {
            gaps.overlaps = false;
            continue;
        }
        const double a = edge[v] * from[u] - edge[u] * from[v], b = edge[v] * opposite[u] - edge[u] * opposite[v];
        const double reach = half[u] * std::abs(edge[v]) + half[v] * std::abs(edge[u]);
        gaps.add(gap_between(std::min(a, b), std::max(a, b), reach), squared_length);
    }
}

}  // namespace

AxisTest axis_test(const Vec3& half, const std::array<Vec3, 3>& corners)
{
    const auto& [a, b, c] = corners;
    Gaps gaps;
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    for (int axis = 0; axis < 3; ++axis) gaps.add(gap_between(low[axis], high[axis], half[axis]), 1);
    if (gaps.is_apart) return AxisTest::Apart;
    const Vec3 ab = b - a, bc = c - b, ca = a - c;
    const Vec3 normal = ab.cross(bc);
    const double squared_area = normal.squaredNorm(),
                 longest = std::max({ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm()});
    if (squared_area > least_angle * least_angle * longest * longest)
        gaps.add(std::abs(normal.dot(a)) - normal.cwiseAbs().dot(half), squared_area);
    else
        gaps.overlaps = false;
    if (gaps.is_apart) return AxisTest::Apart;
    add_edge(half, a, ab, c, gaps);
    add_edge(half, b, bc, a, gaps);
    add_edge(half, c, ca, b, gaps);
    return gaps.is_apart ? AxisTest::Apart : gaps.overlaps ? AxisTest::Overlap : AxisTest::Unclear;
}

}  // namespace spawnfield

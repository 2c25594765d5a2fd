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

FourBoxes::FourBoxes(const Vec3& half, const Pose& pose)
{
    const auto three = [](const Vec3& of) { return Three{all(float(of.x())), all(float(of.y())), all(float(of.z()))}; };
    half_ = three(half);
    for (int axis = 0; axis < 3; ++axis) axes_[std::size_t(axis)] = three(pose.rotation.col(axis));
    centre_ = three(pose.rotation.transpose() * pose.position);
    size_ = all(float(half.sum() + pose.position.norm()));
}

FourTriangles::FourTriangles(const std::array<std::array<const Vec3*, 3>, width>& corners, const Vec3& origin) : size_{}
{
    for (std::size_t k = 0; k < 3; ++k) {
        Four sum{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto seen = [&](std::size_t triangle) {
                return float((*corners[triangle][k])[int(axis)] - origin[int(axis)]);
            };
            corners_[k][axis] = Four{seen(0), seen(1), seen(2), seen(3)};
            sum += magnitude(corners_[k][axis]);
        }
        size_ = greatest(size_, sum);
    }
}

namespace {

using Three = std::array<Four, 3>;

Three difference(const Three& a, const Three& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Four dot(const Three& a, const Three& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Three smaller(const Three& a, const Three& b) { return {least(a[0], b[0]), least(a[1], b[1]), least(a[2], b[2])}; }
Three larger(const Three& a, const Three& b)
{
    return {greatest(a[0], b[0]), greatest(a[1], b[1]), greatest(a[2], b[2])};
}
Three magnitudes(const Three& a) { return {magnitude(a[0]), magnitude(a[1]), magnitude(a[2])}; }

/// Does the same as Gaps for four triangles.
class FourGaps {
public:
    /// Adds an axis whose length is at most `length`. `noise` is larger than the rounding error of the gap. Where
    /// `is_void` is set, the axis has no direction, and others decide.
    void add(const Four& gap, const Four& length, const Four& noise, const FourMasks& is_void = FourMasks{})
    {
        const Four least = float(least_depth) * length + noise;
        apart |= gap > least;
        overlap &= (gap < -least) | is_void;
    }
    bool are_apart() const { return bits_of(apart, apart) == 255; }

    FourMasks apart{}, overlap = ~FourMasks{};
};

}  // namespace

/// The rounding errors follow from that of one operation, 2^-24 of its result. With all coordinates at most `size`, and
/// those of edges at most `longest`, they are below 6 size 2^-24 for a corner, 14 size 2^-24 for an edge, and below
/// 80 size (size + longest) 2^-24 for a cross product with an edge and its gap; the gap of the triangle's normal, which
/// is one more product, has `longest` times this error.
FourTriangles::Marks FourTriangles::compare(const FourBoxes& box) const
{
    std::array<Three, 3> seen, edges;  // from the middle of the box, along its axes
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            seen[k][axis] = dot(box.axes_[axis], corners_[k]) - box.centre_[axis];
    Four longest{};
    for (std::size_t k = 0; k < 3; ++k) {
        edges[k] = difference(seen[(k + 1) % 3], seen[k]);
        const Three by = magnitudes(edges[k]);
        longest = greatest(greatest(longest, by[0]), greatest(by[1], by[2]));
    }
    constexpr float rounding = 0x1p-24F;
    const Four size = size_ + box.size_, noise = 96 * rounding * size * (size + longest);
    FourGaps gaps;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Four low = least(least(seen[0][axis], seen[1][axis]), seen[2][axis]),
                   high = greatest(greatest(seen[0][axis], seen[1][axis]), seen[2][axis]), half = box.half_[axis];
        gaps.add(greatest(low - half, -half - high), all(1), 16 * rounding * size);
    }
    const Three &p = edges[0], &q = edges[1],
                normal{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]},
                steep = magnitudes(normal);
    gaps.add(magnitude(dot(normal, seen[0])) - dot(steep, box.half_), steep[0] + steep[1] + steep[2], noise * longest);
    if (!gaps.are_apart()) {
        // Both ends of an edge have the same coordinate on its cross product with an edge of the box. The triangle's
        // third corner lies the triangle's normal away from them.
        const Three down = smaller(normal, {}), up = larger(normal, {});
        for (std::size_t k = 0; k < 3; ++k) {
            const Three &from = seen[k], &to = seen[(k + 1) % 3], by = magnitudes(edges[k]);
            for (std::size_t u = 0; u < 3; ++u) {
                const std::size_t v = (u + 1) % 3, w = (u + 2) % 3;
                const Four end = from[u] * to[v] - from[v] * to[u], reach = box.half_[u] * by[v] + box.half_[v] * by[u];
                const Four length = by[u] + by[v];
                gaps.add(greatest(end - up[w] - reach, down[w] - end - reach), length, noise, length == 0);
            }
        }
    }
    const std::uint32_t marks = bits_of(gaps.apart, gaps.overlap & ~gaps.apart);
    return {marks & 15, marks >> 4};
}

}  // namespace spawnfield

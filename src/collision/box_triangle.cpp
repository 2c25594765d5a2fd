#include "collision/box_triangle.h"

#include <spawnfield/free_space.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

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
    is_upright_ = pose.rotation.col(2) == Vec3::UnitZ() && pose.rotation(2, 0) == 0 && pose.rotation(2, 1) == 0;
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
Three magnitudes(const Three& a) { return {magnitude(a[0]), magnitude(a[1]), magnitude(a[2])}; }

// What follows returns the largest gap between a box and four triangles on some axes, as in Gaps: m, multiplied by the
// length of the axis. `seen` has their corners in the frame of the box. A gap that is NaN does not count, because the
// gap of the triangle's normal is NaN, too, or its limit is infinite: then there is no proof of overlap.

Four gap_on_box_axes(const std::array<Three, 3>& seen, const Three& half)
{
    Four out = all(-std::numeric_limits<float>::infinity());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Four &a = seen[0][axis], &b = seen[1][axis], &c = seen[2][axis];
        const Four low = least(least(a, b), c), high = greatest(greatest(a, b), c);
        out = greatest(greatest(low, -high) - half[axis], out);
    }
    return out;
}

/// The axes are the cross products of the triangles' edges, whose magnitudes are `along`, with the edges of the box.
/// Both ends of an edge have the same coordinate on such an axis. The triangle's third corner lies the triangle's
/// normal away from them. An axis without a direction does not count: others decide.
Four gap_on_edge_axes(const std::array<Three, 3>& seen, const std::array<Three, 3>& along, const Three& normal,
                      const Three& half)
{
    Four out = all(-std::numeric_limits<float>::infinity());
    for (std::size_t w = 0; w < 3; ++w) {
        const std::size_t u = (w + 1) % 3, v = (w + 2) % 3;
        const Four middle = 0.5F * normal[w], half_width = magnitude(middle);
        for (std::size_t k = 0; k < 3; ++k) {
            const Three &from = seen[k], &to = seen[(k + 1) % 3];
            const Four reach = half[u] * along[k][v] + half[v] * along[k][u],
                       gap = magnitude(from[u] * to[v] - from[v] * to[u] - middle) - (half_width + reach);
            const FourMasks is_void = reach == 0;
            out = greatest(Four(FourMasks(gap) | is_void), out);  // `out` remains where the mask makes a NaN
        }
    }
    return out;
}

}  // namespace

/// Returns the corners of the triangles from the middle of the box, along its axes.
std::array<Three, 3> FourTriangles::seen_from(const FourBoxes& box) const
{
    std::array<Three, 3> seen;
    const auto& [x, y, z] = box.axes_;
    if (box.is_upright_) {  // saves the products with zero and one
        for (std::size_t k = 0; k < 3; ++k) {
            const Three& corner = corners_[k];
            seen[k] = difference({x[0] * corner[0] + x[1] * corner[1], y[0] * corner[0] + y[1] * corner[1], corner[2]},
                                 box.centre_);
        }
    } else {
        for (std::size_t k = 0; k < 3; ++k)
            seen[k] = difference({dot(x, corners_[k]), dot(y, corners_[k]), dot(z, corners_[k])}, box.centre_);
    }
    return seen;
}

/// The rounding errors follow from that of one operation, 2^-24 of its result. With all coordinates at most `size`, and
/// those of edges at most `longest`, they are below 6 size 2^-24 for a corner, 14 size 2^-24 for an edge, and below
/// 80 size (size + longest) 2^-24 for a cross product with an edge and its gap; the gap of the triangle's normal, which
/// is one more product, has `longest` times this error.
FourTriangles::Marks FourTriangles::compare(const FourBoxes& box) const
{
    const std::array<Three, 3> seen = seen_from(box);
    std::array<Three, 3> edges, along;
    Four longest{};
    for (std::size_t k = 0; k < 3; ++k) {
        edges[k] = difference(seen[(k + 1) % 3], seen[k]);
        along[k] = magnitudes(edges[k]);
        for (const Four& by : along[k]) longest = greatest(longest, by);
    }
    constexpr float rounding = 0x1p-24F, depth = float(least_depth);
    const Four size = size_ + box.size_, noise = 96 * rounding * size * (size + longest);
    const Three &p = edges[0], &q = edges[1],
                normal{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]},
                steep = magnitudes(normal);
    const Four by_normal = magnitude(dot(normal, seen[0])) - dot(steep, box.half_),
               normal_limit = depth * (steep[0] + steep[1] + steep[2]) + noise * longest;
    FourMasks apart = by_normal > normal_limit;
    if (bits_of(apart) == 15) return {15, 0};
    const Four by_box = gap_on_box_axes(seen, box.half_), box_limit = depth + 16 * rounding * size,
               by_edges = gap_on_edge_axes(seen, along, normal, box.half_),
               edge_limit = 1.5F * depth * longest + noise;  // no such axis is longer than 1.5 longest
    apart |= (by_box > box_limit) | (by_edges > edge_limit);
    const FourMasks overlap = (by_normal < -normal_limit) & (by_box < -box_limit) & (by_edges < -edge_limit);
    const std::uint32_t marks = bits_of(apart, overlap & ~apart);
    return {marks & 15, marks >> 4};
}

}  // namespace spawnfield

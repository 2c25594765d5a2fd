#include "column/surface_hit.h"

#include "base/polygon2.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr double squared_tolerance = touch_tolerance * touch_tolerance;

/// Returns whether the edge a-b, seen from above, crosses the ray from (x, y) towards +x. The ends are first put in a
/// fixed order, so that two triangles always get the same answer for their common edge.
bool edge_crosses(const Vec3& a, const Vec3& b, double x, double y)
{
    if ((a.y() > y) == (b.y() > y)) return false;
    const bool ordered = a.y() < b.y();
    const Vec3& low = ordered ? a : b;
    const Vec3& high = ordered ? b : a;
    const double side = (high.x() - low.x()) * (y - low.y()) - (x - low.x()) * (high.y() - low.y());
    return side > 0;
}

/// Extends `joined` by the heights at which the vertical line meets the edge p-q, if it meets it.
void extend(const Vec3& p, const Vec3& q, double x, double y, std::optional<Interval>& joined)
{
    const Vec2 edge = (q - p).head<2>(), to(x - p.x(), y - p.y());
    const double length = edge.norm();
    const double along = length > touch_tolerance ? to.dot(edge) / length : 0;
    if (along < -touch_tolerance || along > length + touch_tolerance) return;
    const Vec2 off = length > touch_tolerance ? Vec2(to - along / length * edge) : to;
    if (off.norm() > touch_tolerance) return;
    Interval here{std::min(p.z(), q.z()), std::max(p.z(), q.z())};
    if (length > touch_tolerance) {
        const double z = p.z() + std::clamp(along / length, 0.0, 1.0) * (q.z() - p.z());
        here = {z, z};
    }
    joined = joined ? Interval{std::min(joined->bottom, here.bottom), std::max(joined->top, here.top)} : here;
}

/// Returns the interval of heights in which the vertical line through (x, y) lies in a vertical triangle, if it does.
std::optional<Interval> segment(const Vec3& a, const Vec3& b, const Vec3& c, double x, double y)
{
    std::optional<Interval> joined;
    extend(a, b, x, y, joined);
    extend(b, c, x, y, joined);
    extend(c, a, x, y, joined);
    return joined;
}

bool is_crossed(const Vec3& a, const Vec3& b, const Vec3& c, double x, double y)
{
    return edge_crosses(a, b, x, y) ^ edge_crosses(b, c, x, y) ^ edge_crosses(c, a, x, y);
}

/// Returns whether the vertical line passes through a triangle, edges included to touch_tolerance. `sign` is the sign
/// of the triangle's area, seen from above.
bool is_touched(const Vec3& a, const Vec3& b, const Vec3& c, double sign, double x, double y)
{
    const auto is_left = [&](const Vec3& p, const Vec3& q) {
        const Vec2 edge = (q - p).head<2>();
        const double cross = edge.x() * (y - p.y()) - edge.y() * (x - p.x());
        return sign * cross >= 0 || cross * cross <= squared_tolerance * edge.squaredNorm();
    };
    return is_left(a, b) && is_left(b, c) && is_left(c, a);
}

}  // namespace

/// At a corner, this is exactly the corner's height, so that all triangles at that corner agree.
double SeenTriangle::height_at_rim(const TrianglePlane& plane, double x, double y) const
{
    for (const Vec3* const corner : {&a_, &b_, &c_})
        if (corner->x() == x && corner->y() == y) return std::max(corner->z(), plane.low);
    return plane.height(x, y);
}

/// Returns whether the line passes through the rectangle around the triangle, seen from above, or nearly.
bool SeenTriangle::is_near(double x, double y) const
{
    constexpr double reach = touch_tolerance;
    return ((low_corner() <= Place(x + reach, y + reach)) && (high_corner() >= Place(x - reach, y - reach))).all();
}

/// Returns whether the triangle, seen from above, is thinner than the tolerance. Then its height at a point is
/// undefined.
bool SeenTriangle::is_vertical(const TrianglePlane& plane) const
{
    const auto squared_length = [](const Vec3& p, const Vec3& q) { return (q - p).head<2>().squaredNorm(); };
    const double longest = std::max({squared_length(a_, b_), squared_length(b_, c_), squared_length(c_, a_)});
    return plane.twice_area * plane.twice_area <= squared_tolerance * longest;
}

bool SeenTriangle::touches(const TrianglePlane& plane, double x, double y) const
{
    return is_touched(a_, b_, c_, plane.twice_area > 0 ? 1 : -1, x, y);
}

std::optional<double> SeenTriangle::sheet_at_rim(const TrianglePlane& plane, double x, double y) const
{
    if (!is_near(x, y) || is_vertical(plane) || !touches(plane, x, y)) return std::nullopt;
    return height_at_rim(plane, x, y);
}

std::optional<SurfaceHit> SeenTriangle::hit_at_rim(const TrianglePlane& plane, double x, double y) const
{
    if (!plane.filled) {
        const auto height = sheet_at_rim(plane, x, y);
        return height ? std::optional(hit_inside(plane, *height)) : std::nullopt;
    }
    if (!is_near(x, y)) return std::nullopt;
    SurfaceHit out = hit_inside(plane, 0);
    out.crosses = is_crossed(a_, b_, c_, x, y);
    if (out.crosses) out.crossing = height_at_rim(plane, x, y);
    if (is_vertical(plane)) {
        // Computed even if `crosses` is true: because of rounding, a line in a vertical triangle may also cross it.
        const auto met = segment(a_, b_, c_, x, y);
        out.touches = met.has_value();
        if (met) out.z = *met;
    } else {
        out.touches = !out.crosses && touches(plane, x, y);
        if (out.touches) out.z.bottom = out.z.top = height_at_rim(plane, x, y);
    }
    if (!out.crosses && !out.touches) return std::nullopt;
    return out;
}

std::optional<SurfaceHit> SeenTriangle::hit(double x, double y) const
{
    const auto [inside, rim] = sides_of(x, y);
    if (!(inside | rim)) return std::nullopt;
    const TrianglePlane plane(*this);
    return inside != 0 ? hit_inside(plane, plane.height(x, y)) : hit_at_rim(plane, x, y);
}

std::optional<SurfaceHit> hit_of(const Tile& tile, std::uint32_t element, double x, double y)
{
    if (tile.is_triangle(element)) return SeenTriangle(tile, element).hit(x, y);
    const TilePrimitive& primitive = tile.primitive(element);
    const auto interval = vertical_interval(primitive.shape(), x, y);
    if (!interval) return std::nullopt;
    return SurfaceHit{.element = tile.ids[element],
                      .piece = 0,
                      .part = primitive.part,
                      .is_primitive = true,
                      .filled = true,
                      .open = false,
                      .terrain = primitive.label == Label::Terrain,
                      .water = primitive.label == Label::Water,
                      .crosses = false,
                      .touches = true,
                      .z = *interval,
                      .crossing = 0,
                      .piece_bottom = 0};
}

}  // namespace spawnfield

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
std::optional<Interval> segment(const std::array<Vec3, 3>& corners, double x, double y)
{
    std::optional<Interval> joined;
    for (std::size_t k = 0; k < 3; ++k) extend(corners[k], corners[(k + 1) % 3], x, y, joined);
    return joined;
}

bool is_crossed(const std::array<Vec3, 3>& corners, double x, double y)
{
    const auto& [a, b, c] = corners;
    return edge_crosses(a, b, x, y) ^ edge_crosses(b, c, x, y) ^ edge_crosses(c, a, x, y);
}

/// Returns whether the vertical line passes through a triangle, edges included to touch_tolerance. `sign` is the sign
/// of the triangle's area, seen from above.
bool is_touched(const std::array<Vec3, 3>& corners, double sign, double x, double y)
{
    const auto is_left = [&](const Vec3& p, const Vec3& q) {
        const Vec2 edge = (q - p).head<2>();
        const double cross = edge.x() * (y - p.y()) - edge.y() * (x - p.x());
        return sign * cross >= 0 || cross * cross <= squared_tolerance * edge.squaredNorm();
    };
    const auto& [a, b, c] = corners;
    return is_left(a, b) && is_left(b, c) && is_left(c, a);
}

}  // namespace

SurfaceHit SeenTriangle::hit_inside(const TrianglePlane& plane, double height) const
{
    return {.element = tile_.ids[triangle_],
            .piece = piece().piece,
            .part = plane.part,
            .is_primitive = false,
            .filled = plane.filled,
            .open = plane.open,
            .terrain = plane.terrain,
            .water = plane.water,
            .crosses = plane.filled,
            .touches = !plane.filled,
            .z = {height, height},
            .crossing = height,
            .piece_bottom = piece().bottom};
}

/// At a corner, this is exactly the corner's height, so that all triangles at that corner agree.
double SeenTriangle::height_at_rim(const TrianglePlane& plane, double x, double y) const
{
    for (const Vec3* const corner : {&a_, &b_, &c_})
        if (corner->x() == x && corner->y() == y) return std::max(corner->z(), plane.low);
    return plane.height(x, y);
}

std::optional<SurfaceHit> SeenTriangle::hit_at_rim(const TrianglePlane& plane, double x, double y) const
{
    constexpr double reach = touch_tolerance;
    if (!((low_corner() <= Place(x + reach, y + reach)) && (high_corner() >= Place(x - reach, y - reach))).all())
        return std::nullopt;
    const std::array<Vec3, 3> corners = this->corners();
    SurfaceHit out = hit_inside(plane, 0);
    out.crosses = out.filled && is_crossed(corners, x, y);
    if (out.crosses) out.crossing = height_at_rim(plane, x, y);
    const auto squared_length = [](const Vec3& p, const Vec3& q) { return (q - p).head<2>().squaredNorm(); };
    const auto& [a, b, c] = corners;
    const double longest = std::max({squared_length(a, b), squared_length(b, c), squared_length(c, a)});
    // If the triangle is thinner than the tolerance, its height at a point is undefined.
    const bool is_vertical = plane.twice_area * plane.twice_area <= squared_tolerance * longest;
    if (is_vertical) {
        // Computed even if `crosses` is true: because of rounding, a line in a vertical triangle may also cross it.
        const auto met = out.filled ? segment(corners, x, y) : std::nullopt;
        out.touches = met.has_value();
        if (met) out.z = *met;
    } else {
        out.touches = !out.crosses && is_touched(corners, plane.twice_area > 0 ? 1 : -1, x, y);
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

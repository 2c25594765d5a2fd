#pragma once

#include <Eigen/Core>

#include <vector>

namespace spawnfield {

using Vec2 = Eigen::Vector2d;

/// Corners of a convex polygon, counterclockwise.
using Polygon2 = std::vector<Vec2>;

/// Returns the z component of the cross product.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the outward normal of the edge from p to q of a counterclockwise polygon. It is as long as the edge.
inline Vec2 edge_normal(const Vec2& p, const Vec2& q) { return {q.y() - p.y(), p.x() - q.x()}; }

/// Returns the signed area: > 0 for counterclockwise corners, < 0 for clockwise ones.
template <class Polygon>
double area_of(const Polygon& polygon)
{
    double twice = 0;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        twice += cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    return twice / 2;
}

/// Computes the part of a convex polygon where signed_distance(point) <= 0. signed_distance must be an affine function
/// of the point; it need not be in metres. Calls keep(corner, is_cut) for each corner of the result, in their order.
/// is_cut is true for new corners, which lie on edges of the polygon; there are at most two. If the line of distance 0
/// only touches the polygon, the result has one or two corners. Source: Sutherland, Hodgman, Reentrant polygon
/// clipping, 1974.
template <class Polygon, class SignedDistance, class Keep>
void clip_polygon(const Polygon& polygon, const SignedDistance& signed_distance, const Keep& keep)
{
    if (polygon.size() == 0) return;
    double dp = signed_distance(polygon[0]);
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const auto &p = polygon[k], &q = polygon[k + 1 < polygon.size() ? k + 1 : 0];
        const double dq = signed_distance(q);
        if (dp <= 0) keep(p, false);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) keep(p + dp / (dp - dq) * (q - p), true);
        dp = dq;
    }
}

/// Returns the part of a convex polygon where normal · point <= offset. It has at most one corner more.
template <class Polygon>
Polygon cut(const Polygon& polygon, const Vec2& normal, double offset)
{
    Polygon out;
    const auto distance = [&](const Vec2& p) { return normal.dot(p) - offset; };
    clip_polygon(polygon, distance, [&](const Vec2& p, bool) { out.push_back(p); });
    return out;
}

/// Returns the convex hull of points (Andrew, Another efficient algorithm for convex hulls in two dimensions, 1979),
/// without corners on straight edges. It has fewer than 3 corners if all points lie on one line.
Polygon2 convex_hull(Polygon2 points);

/// Returns the smallest distance of two parallel lines between which a convex polygon fits (2 or more corners).
double width(const Polygon2& polygon);

/// Returns whether a point lies in a convex polygon or on its edge. Polygons with fewer than 3 corners contain no
/// point.
template <class Polygon>
bool contains(const Polygon& polygon, const Vec2& point)
{
    if (polygon.size() < 3) return false;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[k + 1 < polygon.size() ? k + 1 : 0];
        if (cross(q - p, point - p) < 0) return false;
    }
    return true;
}

}  // namespace spawnfield

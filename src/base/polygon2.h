#pragma once

#include <Eigen/Core>

#include <vector>

namespace spawnfield {

using Vec2 = Eigen::Vector2d;

/// Corners of a convex polygon, counterclockwise.
using Polygon2 = std::vector<Vec2>;

inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns the outward normal of the edge from p to q of a counterclockwise polygon. It is as long as the edge.
inline Vec2 normal_of(const Vec2& p, const Vec2& q) { return {q.y() - p.y(), p.x() - q.x()}; }

/// Returns the area, < 0 if the corners run clockwise.
template <class Polygon>
double area_of(const Polygon& polygon)
{
    double twice = 0;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        twice += cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    return twice / 2;
}

/// Returns the part of a convex polygon where normal · point <= offset. It has at most one corner more.
template <class Polygon>
Polygon cut(const Polygon& polygon, const Vec2& normal, double offset)
{
    Polygon out;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[k + 1 < polygon.size() ? k + 1 : 0];
        const double dp = normal.dot(p) - offset, dq = normal.dot(q) - offset;
        if (dp <= 0) out.push_back(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) out.push_back(p + dp / (dp - dq) * (q - p));
    }
    return out;
}

/// Returns the convex hull of points (Andrew, Another efficient algorithm for convex hulls in two dimensions, 1979).
Polygon2 convex_hull(Polygon2 points);

/// Returns whether a point lies in a convex polygon or on its edge. A polygon without corners contains no point.
inline bool contains(const Polygon2& polygon, const Vec2& point)
{
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[k + 1 < polygon.size() ? k + 1 : 0];
        if (cross(q - p, point - p) < 0) return false;
    }
    return !polygon.empty();
}

}  // namespace spawnfield

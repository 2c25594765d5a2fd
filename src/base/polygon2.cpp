#include "base/polygon2.h"

#include <algorithm>
#include <limits>

namespace spawnfield {

Polygon2 convex_hull(Polygon2 points)
{
    std::sort(points.begin(), points.end(),
              [](const Vec2& l, const Vec2& r) { return l.x() != r.x() ? l.x() < r.x() : l.y() < r.y(); });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    Polygon2 hull;
    hull.reserve(points.size() + 1);
    const auto add = [&](const Vec2& p, std::size_t kept) {
        while (hull.size() >= kept + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const Vec2& p : points) add(p, 0);
    const std::size_t lower = hull.size() - 1;
    for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
    hull.pop_back();
    return hull;
}

double width(const Polygon2& polygon)
{
    double out = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[k + 1 < polygon.size() ? k + 1 : 0];
        const Vec2 inward = -edge_normal(p, q).normalized();
        double across = 0;
        for (const Vec2& corner : polygon) across = std::max(across, inward.dot(corner - p));
        out = std::min(out, across);
    }
    return out;
}

}  // namespace spawnfield

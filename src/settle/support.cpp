#include "settle/support.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {

NearestEdge nearest_edge(const Polygon2& polygon, const Vec2& point)
{
    NearestEdge out;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[k + 1 < polygon.size() ? k + 1 : 0], along = q - p;
        const double t = std::clamp(along.dot(point - p) / along.squaredNorm(), 0.0, 1.0),
                     distance = (point - p - t * along).norm();
        if (distance < out.distance) out = {distance, edge_normal(p, q).normalized(), p, q};
    }
    if (!contains(polygon, point)) out.distance = -out.distance;
    return out;
}

Polygon2 clear_corners(const Polygon2& polygon)
{
    constexpr double shortest_edge = 1e-6, straight = 1e-9;  // m
    Polygon2 apart, out;
    apart.reserve(polygon.size());
    out.reserve(polygon.size());
    for (const Vec2& corner : polygon)
        if (apart.empty() ||
            ((corner - apart.back()).norm() >= shortest_edge && (corner - apart.front()).norm() >= shortest_edge))
            apart.push_back(corner);
    for (std::size_t k = 0; k < apart.size(); ++k) {
        const Vec2 &before = apart[(k + apart.size() - 1) % apart.size()], &after = apart[(k + 1) % apart.size()];
        if (std::abs(cross(after - before, apart[k] - before)) > straight * (after - before).norm())
            out.push_back(apart[k]);
    }
    return out;
}

}  // namespace spawnfield

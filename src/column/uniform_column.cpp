#include "column/uniform_column.h"

#include "base/polygon2.h"
#include "column/column_builder.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Returns whether an edge of the triangle, seen from above, separates it from the rectangle, with a gap between them
/// of more than 4 * touch_tolerance. The third corner decides on which side of the edge the triangle is, because the
/// sign of the area of a vertical triangle is only rounding.
bool misses(const std::array<Vec3, 3>& corners, const Rect& rect)
{
    const std::array<Vec2, 3> p{corners[0].head<2>(), corners[1].head<2>(), corners[2].head<2>()};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 edge = p[(k + 1) % 3] - p[k];
        const auto side_of = [&](double x, double y) { return cross(edge, Vec2(x, y) - p[k]); };
        const double third = cross(edge, p[(k + 2) % 3] - p[k]), gap = 4 * touch_tolerance * edge.norm();
        const auto [low, high] = std::minmax({side_of(rect.low_x, rect.low_y), side_of(rect.low_x, rect.high_y),
                                              side_of(rect.high_x, rect.low_y), side_of(rect.high_x, rect.high_y)});
        if ((high < -gap && third >= 0) || (low > gap && third <= 0)) return true;
    }
    return false;
}

/// Returns the hit of every line in the rectangle with this triangle, if they are certainly all the same.
std::optional<SurfaceHit> uniform_hit(const Tile& tile, std::uint32_t triangle, const Rect& rect)
{
    if (tile.piece(triangle).solid != 0) return std::nullopt;
    const SeenTriangle seen(tile, triangle);
    const TrianglePlane plane(seen);
    if (!plane.is_level()) return std::nullopt;
    for (const double y : {rect.low_y, rect.high_y})
        for (const double x : {rect.low_x, rect.high_x})
            if (seen.sides_of(x, y).inside == 0) return std::nullopt;
    return seen.hit_inside(plane, plane.height(rect.high_x, rect.high_y));
}

}  // namespace

std::optional<Column> uniform_column(const Geometry& geometry, const Rect& rect)
{
    constexpr double reach = 2 * touch_tolerance;
    const Rect wider{rect.low_x - reach, rect.low_y - reach, rect.high_x + reach, rect.high_y + reach};
    std::vector<SurfaceHit> hits;
    bool is_uniform = true;
    geometry.impl().visit_in(wider, [&](const Tile& tile, std::uint32_t element) {
        if (!is_uniform) return;
        is_uniform = tile.is_triangle(element);
        if (!is_uniform || misses(tile.corners(element), wider)) return;
        const auto hit = uniform_hit(tile, element, wider);
        is_uniform = hit.has_value();
        if (hit) hits.push_back(*hit);
    });
    if (!is_uniform) return std::nullopt;
    std::sort(hits.begin(), hits.end(), [](const SurfaceHit& l, const SurfaceHit& r) { return l.element < r.element; });
    Column out;
    ColumnBuilder().build(hits, out);
    return out;
}

}  // namespace spawnfield

#pragma once

#include "base/polygon2.h"

#include <algorithm>
#include <span>

namespace spawnfield {

/// An axis-aligned rectangle, seen from above, m.
struct Rect {
    double low_x, low_y, high_x, high_y;

    double centre_x() const { return (low_x + high_x) / 2; }
    double centre_y() const { return (low_y + high_y) / 2; }
    double longest_side() const { return std::max(high_x - low_x, high_y - low_y); }
    void extend(const Vec2& point)
    {
        low_x = std::min(low_x, point.x());
        low_y = std::min(low_y, point.y());
        high_x = std::max(high_x, point.x());
        high_y = std::max(high_y, point.y());
    }
};

/// Returns the rectangle around the points; there must be one.
inline Rect rect_around(std::span<const Vec2> points)
{
    Rect out{points[0].x(), points[0].y(), points[0].x(), points[0].y()};
    for (const Vec2& point : points.subspan(1)) out.extend(point);
    return out;
}

}  // namespace spawnfield

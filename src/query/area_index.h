#pragma once

#include "base/polygon2.h"
#include "base/rect.h"

#include <spawnfield/region.h>

#include <cstdint>

namespace spawnfield {

/// Some polygons' edges in rows, so that a question meets only those beside it. The union of the polygons, as Region
/// has it.
class PolygonIndex {
public:
    explicit PolygonIndex(const std::vector<Region>& regions);

    bool contains(const Vec2& point) const;
    /// Proofs about closed rectangles; false where edges come near. covers: one polygon holds all of it.
    bool misses(const Rect& rect) const;
    bool covers(const Rect& rect) const;

private:
    struct Edge {
        Vec2 from, to;
    };
    /// Of one polygon in one row.
    struct Group {
        std::uint32_t polygon, first, last;  ///< edges
        double low_x, high_x;                ///< that they reach
    };
    std::size_t row_of(double y) const;
    bool holds(const Group& group, const Vec2& point) const;
    /// Whether an edge of the group comes within the slack of the rectangle.
    bool meets(const Group& group, const Rect& rect) const;

    double y0_ = 0, height_ = 1, end_ = -1;  ///< of the rows; where the last one ends
    std::vector<std::uint32_t> starts_;      ///< groups of each row, then their number
    std::vector<Group> groups_;
    std::vector<Edge> edges_;
};

/// Area, ready to be asked.
class AreaIndex {
public:
    explicit AreaIndex(const Area& area);

    /// Whether the area has the point at some height.
    bool contains(const Vec2& point) const;
    bool contains(const Vec2& point, double z) const;  ///< z to touch_tolerance

    /// True only if no point of the closed rectangle is in the area at these heights. False where an edge of a region
    /// runs through the rectangle, and where only several keep-outs together cover it.
    bool misses(const Rect& rect, const ZRange& z = {}) const;

private:
    /// Regions that share their heights.
    struct Slab {
        ZRange z;
        PolygonIndex polygons;
    };
    static std::vector<Slab> slabs_of(const std::vector<Region>& regions);

    std::vector<Slab> within_;  ///< empty: everywhere
    std::vector<Slab> keep_out_;
};

}  // namespace spawnfield

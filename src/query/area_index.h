#pragma once

#include "base/polygon2.h"
#include "base/rect.h"

#include <spawnfield/region.h>

#include <cstdint>

namespace spawnfield {

/// The union of some polygons, as Region defines it. The edges are sorted into rows, so that a look-up examines only
/// the edges of its row.
class PolygonIndex {
public:
    explicit PolygonIndex(const std::vector<Region>& regions);

    bool contains(const Vec2& point) const;
    /// Return true only if it is certain that no polygon meets the closed rectangle (misses), or that one polygon
    /// contains all of it (covers). Both return false if an edge may be near the rectangle.
    bool misses(const Rect& rect) const;
    bool covers(const Rect& rect) const;

private:
    struct Edge {
        Vec2 from, to;
    };
    /// The edges of one polygon in one row.
    struct Group {
        std::uint32_t polygon, first, last;  ///< indices of the edges: first .. last - 1
        double low_x, high_x;                ///< range of the edges' x
    };
    std::size_t row_of(double y) const;
    bool holds(const Group& group, const Vec2& point) const;
    /// Returns whether an edge of the group may be within near_edge of the rectangle.
    bool meets(const Group& group, const Rect& rect) const;

    double y0_ = 0, height_ = 1, end_ = -1;  ///< start and height of the rows, end of the last one
    std::vector<std::uint32_t> starts_;  ///< index of each row's first group; the last entry is the number of groups
    std::vector<Group> groups_;
    std::vector<Edge> edges_;
};

/// An area, prepared for fast look-ups.
class AreaIndex {
public:
    explicit AreaIndex(const Area& area);

    /// Returns whether the area has no regions and no keep-outs, so that it contains every point.
    bool is_everywhere() const { return within_.empty() && keep_out_.empty(); }
    /// Returns whether the area contains the point at some height.
    bool contains(const Vec2& point) const;
    bool contains(const Vec2& point, double z) const;  ///< z to touch_tolerance

    /// Returns true only if no point of the closed rectangle is in the area at these heights. Returns false if an edge
    /// of a region crosses the rectangle, or if only several keep-outs together cover it.
    bool misses(const Rect& rect, const ZRange& z = {}) const;

private:
    /// Regions with the same heights.
    struct Slab {
        ZRange z;
        PolygonIndex polygons;
    };
    static std::vector<Slab> slabs_of(const std::vector<Region>& regions);

    std::vector<Slab> within_;  ///< empty: everywhere
    std::vector<Slab> keep_out_;
};

}  // namespace spawnfield

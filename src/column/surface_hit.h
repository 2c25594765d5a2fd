#pragma once

#include "geometry/tile.h"

#include <spawnfield/column.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace spawnfield {

/// Describes where a vertical line meets one element of a scene.
struct SurfaceHit {
    std::uint32_t element, piece, part;  ///< indices in the scene; piece is 0 for primitives
    bool is_primitive, filled, open, terrain, water;
    bool crosses;  ///< the line goes through a triangle of a filled piece at `crossing`; an edge counts for one
                   ///< triangle only
    bool touches;  ///< the line meets the element in the interval z, edges included
    Interval z;
    double crossing;      ///< height of the crossing, m
    double piece_bottom;  ///< Piece::bottom, m
};

/// A triangle that is intersected with one vertical line after the other.
class SeenTriangle {
public:
    SeenTriangle(const Tile& tile, std::uint32_t triangle)
        : tile_(tile), triangle_(triangle), corners_(tile.corners(triangle))
    {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &p = corners_[k], &q = corners_[k < 2 ? k + 1 : 0];
            Edge& edge = edges_[k];
            edge.x = q.x() - p.x();
            edge.y = q.y() - p.y();
            edge.squared_length = edge.x * edge.x + edge.y * edge.y;
            edge.rim = edge.squared_length > 0 ? 16 * touch_tolerance * touch_tolerance * edge.squared_length : -1;
        }
    }

    /// Sets y, m, for the following `meet()` calls.
    void set_y(double y)
    {
        y_ = y;
        for (std::size_t k = 0; k < 3; ++k) edges_[k].across = edges_[k].x * (y - corners_[k].y());
    }

    /// Returns whether the vertical line through (x, y) meets the triangle. If it does, the hit is written to the
    /// SurfaceHit& that new_hit() returns. A vertical triangle of a sheet is never met.
    template <class NewHit>
    bool meet(double x, const NewHit& new_hit)
    {
        // Clear lines are far from all edges, so that neither rounding nor a tolerance decides. If a clear line is on
        // the same side of all edges, it goes through the triangle.
        double low = std::numeric_limits<double>::infinity(), high = -low;
        bool is_clear = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const double cross = edges_[k].across - edges_[k].y * (x - corners_[k].x());
            is_clear = is_clear & (cross * cross > edges_[k].rim);
            low = std::min(low, cross);
            high = std::max(high, cross);
        }
        if (is_clear && low < 0 && high > 0) return false;
        if (!is_clear || (low <= 0 && high >= 0)) {
            const auto hit = hit_at_rim(x, y_);
            if (hit) new_hit() = *hit;
            return hit.has_value();
        }
        if (!is_prepared_) prepare();
        SurfaceHit& hit = new_hit();
        hit = within_;
        hit.crossing = hit.z.bottom = hit.z.top = height(x, y_);
        return true;
    }

    /// Returns the hit of the vertical line through (x, y), if it meets the triangle.
    std::optional<SurfaceHit> hit(double x, double y)
    {
        std::optional<SurfaceHit> out;
        set_y(y);
        meet(x, [&]() -> SurfaceHit& { return out.emplace(); });
        return out;
    }

private:
    struct Edge {
        double x, y;            ///< m
        double squared_length;  ///< seen from above, m2
        double
            rim;  ///< a line is well off the edge if the squared cross product exceeds this; -1 if the edge is vertical
        double across;  ///< the part of that cross product which depends on y, m2
    };

    void prepare();
    std::optional<SurfaceHit> hit_at_rim(double x, double y);
    /// Returns the height of the triangle's plane, limited to the triangle's own heights. At a corner it is exactly the
    /// corner's height, so that all triangles at that corner agree.
    double height_at_rim(double x, double y) const
    {
        for (const Vec3& corner : corners_)
            if (corner.x() == x && corner.y() == y) return std::max(corner.z(), low_);
        return height(x, y);
    }
    double height(double x, double y) const
    {
        const Vec3& a = corners_[0];
        return std::min(std::max(a.z() + slope_x_ * (x - a.x()) + slope_y_ * (y - a.y()), low_), high_);
    }

    const Tile& tile_;
    const std::uint32_t triangle_;
    const std::array<Vec3, 3> corners_;
    std::array<Edge, 3> edges_;  ///< from corner k to the next
    double y_ = 0;

    // Set by prepare(), for triangles that are hit:
    bool is_prepared_ = false;
    double twice_area_ = 0;  ///< seen from above, m2; > 0 if the triangle faces upwards
    double slope_x_ = 0, slope_y_ = 0, low_ = 0, high_ = 0;
    SurfaceHit within_;  ///< the hit of a line that is well inside, without the heights
};

/// Returns where the vertical line through (x, y) meets an element of a tile, if it does.
std::optional<SurfaceHit> hit_of(const Tile& tile, std::uint32_t element, double x, double y);

/// A primitive with the same functions as SeenTriangle.
class SeenPrimitive {
public:
    SeenPrimitive(const Tile& tile, std::uint32_t element) : tile_(tile), element_(element) {}

    void set_y(double y) { y_ = y; }
    template <class NewHit>
    bool meet(double x, const NewHit& new_hit) const
    {
        const auto hit = hit_of(tile_, element_, x, y_);
        if (hit) new_hit() = *hit;
        return hit.has_value();
    }

private:
    const Tile& tile_;
    const std::uint32_t element_;
    double y_ = 0;
};

}  // namespace spawnfield

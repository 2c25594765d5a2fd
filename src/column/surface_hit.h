#pragma once

#include "geometry/geometry_impl.h"

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
        : tile_(tile), triangle_(triangle),
          corners_(tile.corners(triangle)), edges_{Edge(corners_[0], corners_[1]), Edge(corners_[1], corners_[2]),
                                                   Edge(corners_[2], corners_[0])}
    {
    }

    /// Sets y, m, for the calls that follow.
    void set_y(double y)
    {
        y_ = y;
        for (Edge& edge : edges_) edge.across = edge.x * (y - edge.from_y);
    }

    /// Where a vertical line passes a triangle. Rim: so near to an edge that only hit_at_rim() can decide.
    enum class Side { Outside, Inside, Rim };
    Side side_of(double x) const
    {
        // Clear lines are far from all edges, so that neither rounding nor a tolerance decides. If a clear line is on
        // the same side of all edges, it goes through the triangle.
        const double a = edges_[0].cross(x), b = edges_[1].cross(x), c = edges_[2].cross(x);
        bool is_clear = a * a > edges_[0].rim;
        is_clear &= b * b > edges_[1].rim;  // not &&: three comparisons cost less than a branch
        is_clear &= c * c > edges_[2].rim;
        if (!is_clear) return Side::Rim;
        const double low = std::min(std::min(a, b), c), high = std::max(std::max(a, b), c);
        if (low < 0 && high > 0) return Side::Outside;
        return low <= 0 && high >= 0 ? Side::Rim : Side::Inside;
    }

    /// Returns the hit of a line inside the triangle, without its heights.
    const SurfaceHit& common()
    {
        if (!is_prepared_) prepare();
        return common_;
    }
    /// Returns the height of the triangle at a line that is inside. common() must have been called.
    double height_at(double x) const { return height(x, y_); }
    /// Returns the hit of a line that is inside.
    SurfaceHit hit_inside(double x)
    {
        SurfaceHit hit = common();
        hit.crossing = hit.z.bottom = hit.z.top = height_at(x);
        return hit;
    }
    /// Returns the hit of a line at the rim, if it meets the triangle. A vertical triangle of a sheet is never met.
    std::optional<SurfaceHit> hit_at_rim(double x);

    /// Returns the hit of the vertical line through (x, y), if it meets the triangle.
    std::optional<SurfaceHit> hit(double x, double y)
    {
        set_y(y);
        switch (side_of(x)) {
        case Side::Outside: return std::nullopt;
        case Side::Inside: return hit_inside(x);
        case Side::Rim: break;
        }
        return hit_at_rim(x);
    }

private:
    /// An edge, seen from above.
    struct Edge {
        double from_x, from_y;
        double x, y;            ///< from its first corner to the next, m
        double squared_length;  ///< m2
        /// A line is clear of the edge if the squared cross product exceeds this; -1: the edge is vertical.
        double rim;
        double across;  ///< the part of that cross product which depends on y, m2

        Edge(const Vec3& from, const Vec3& to)
            : from_x(from.x()), from_y(from.y()), x(to.x() - from.x()), y(to.y() - from.y()),
              squared_length(x * x + y * y),
              rim(squared_length > 0 ? 16 * touch_tolerance * touch_tolerance * squared_length : -1), across(0)
        {
        }
        double cross(double line_x) const { return across - y * (line_x - from_x); }
    };

    void prepare();
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
    std::array<Edge, 3> edges_;
    double y_ = 0;

    // Set by prepare(), for triangles that are hit:
    bool is_prepared_ = false;
    double twice_area_ = 0;  ///< seen from above, m2; > 0 if the triangle faces upwards
    double slope_x_ = 0, slope_y_ = 0, low_ = 0, high_ = 0;
    SurfaceHit common_;
};

/// Returns where the vertical line through (x, y) meets an element of a tile, if it does.
std::optional<SurfaceHit> hit_of(const Tile& tile, std::uint32_t element, double x, double y);

}  // namespace spawnfield

#pragma once

#include "geometry/geometry_impl.h"

#include <spawnfield/column.h>

#include <algorithm>
#include <cmath>
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
    SeenTriangle(const Tile& tile, std::uint32_t triangle) : SeenTriangle(tile, triangle, tile.corners(triangle)) {}
    /// `corners` are those of the triangle.
    SeenTriangle(const Tile& tile, std::uint32_t triangle, const std::array<Vec3, 3>& corners)
        : tile_(tile), triangle_(triangle),
          corners_(corners), edges_{Edge(corners[0], corners[1]), Edge(corners[1], corners[2]),
                                    Edge(corners[2], corners[0])}
    {
    }

    /// Sets y, m, for the calls that follow.
    void set_y(double y)
    {
        y_ = y;
        for (Edge& edge : edges_) edge.across = edge.x * (y - edge.from_y);
    }

    /// Which of some vertical lines pass through a triangle, one bit for each. Rim: so near to an edge that only
    /// hit_at_rim() can decide. All others are outside.
    struct Sides {
        std::uint64_t inside = 0, rim = 0;
    };
    /// Looks at the lines at x[0], …, x[count - 1], m; at most 64. If the count is odd, x[count] must exist, too.
    Sides sides_of(const double* x, int count) const
    {
        Sides out;
        for (int k = 0; k < count; k += 2) {
            // A line on the same side of all edges, and clear of them, goes through the triangle. A line that is
            // clearly left of one edge and clearly right of another one does not. Clear lines are far from an edge, so
            // that neither rounding nor a tolerance decides. There is no branch, because one that is predicted wrongly
            // takes longer than all this.
            const Two lines{x[k], x[k + 1]};
            const auto& [p, q, r] = edges_;
            const Two a = p.cross(lines), b = q.cross(lines), c = r.cross(lines);
            const TwoMasks left_a = a > p.rim, left_b = b > q.rim, left_c = c > r.rim, right_a = a < -p.rim,
                           right_b = b < -q.rim, right_c = c < -r.rim;
            const TwoMasks inside = (left_a & left_b & left_c) | (right_a & right_b & right_c),
                           outside = (left_a | left_b | left_c) & (right_a | right_b | right_c);
            out.inside |= bits_of(inside) << k;
            out.rim |= bits_of(~(inside | outside)) << k;
        }
        const std::uint64_t asked = count < 64 ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
        return {out.inside & asked, out.rim & asked};
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
        const std::array twice{x, x};
        const auto [inside, rim] = sides_of(twice.data(), 1);
        if (inside != 0) return hit_inside(x);
        return rim != 0 ? hit_at_rim(x) : std::nullopt;
    }

private:
    using Two = double __attribute__((vector_size(16)));  ///< two lines in one register; also an extension of clang
    using TwoMasks = decltype(Two{} < Two{});             ///< all bits of a number are equal

    static std::uint64_t bits_of(const TwoMasks& masks) { return std::uint64_t((masks[0] & 1) | (masks[1] & 2)); }

    /// An edge, seen from above.
    struct Edge {
        double from_x, from_y;
        double x, y;    ///< from its first corner to the next, m
        double rim;     ///< a line is clear of the edge if its cross product is above this, or below the negative, m2
        double across;  ///< the part of the cross product that depends on y, m2

        Edge(const Vec3& from, const Vec3& to)
            : from_x(from.x()), from_y(from.y()), x(to.x() - from.x()), y(to.y() - from.y()),
              rim(4 * touch_tolerance * (std::abs(x) + std::abs(y))), across(0)
        {
        }
        double squared_length() const { return x * x + y * y; }  ///< m2
        Two cross(Two lines_x) const { return across - y * (lines_x - from_x); }
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

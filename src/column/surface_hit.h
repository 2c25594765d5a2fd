#pragma once

#include "base/bits.h"
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

class SeenTriangle;

/// What all hits of a triangle have in common.
struct TrianglePlane {
    double twice_area;  ///< seen from above, m2; > 0 if the triangle faces upwards
    double x, y, z;     ///< of the first corner, m
    double slope_x, slope_y;
    double low, high;  ///< limits of the heights, m
    SurfaceHit hit;    ///< of a line inside the triangle, without its heights

    explicit TrianglePlane(const SeenTriangle& triangle);

    /// Returns the height of the triangle at a line that is inside, m.
    double height(double at_x, double at_y) const
    {
        return std::min(std::max(z + slope_x * (at_x - x) + slope_y * (at_y - y), low), high);
    }
    /// Returns the hit of a line that is inside.
    SurfaceHit hit_inside(double at_x, double at_y) const
    {
        SurfaceHit out = hit;
        out.crossing = out.z.bottom = out.z.top = height(at_x, at_y);
        return out;
    }
};

/// A triangle that is intersected with vertical lines.
class SeenTriangle {
public:
    using Place = Eigen::Array2d;  ///< x and y, m

    [[gnu::always_inline]] SeenTriangle(const Tile& tile, std::uint32_t triangle)
        : tile_(tile), triangle_(triangle), corners_(tile.corners(triangle))
    {
        const Place a = corners_[0].head<2>(), b = corners_[1].head<2>(), c = corners_[2].head<2>();
        low_corner_ = a.min(b).min(c);
        high_corner_ = a.max(b).max(c);
        rim_ = 4 * touch_tolerance * (high_corner_ - low_corner_).sum();
    }

    // The rectangle around the triangle, seen from above:
    const Place& low_corner() const { return low_corner_; }
    const Place& high_corner() const { return high_corner_; }

    /// Which of some vertical lines pass through a triangle, one bit for each. Rim: so near to an edge that only
    /// hit_at_rim() can decide. All others are outside.
    struct Sides {
        std::uint64_t inside = 0, rim = 0;
    };
    /// Looks at the lines at (x[0], y), …, (x[count - 1], y), m; at most 64. If the count is odd, x[count] must exist,
    /// too.
    Sides sides_of(const double* x, int count, double y) const
    {
        std::uint64_t all_inside = 0, all_outside = 0;
        const auto& [p, q, r] = corners_;
        const double py = p.y() - y, qy = q.y() - y, ry = r.y() - y;
        for (int k = 0; k < count; k += 2) {
            // The cross product of the vectors to two corners is twice the area of the triangle between the line and an
            // edge. A line on the same side of all edges, and clear of them, goes through the triangle. A line that is
            // clearly left of one edge and clearly right of another one does not. Clear lines are far from an edge, so
            // that neither rounding nor a tolerance decides. There is no branch, because one that is predicted wrongly
            // takes longer than all this.
            const Two lines{x[k], x[k + 1]};
            const Two px = p.x() - lines, qx = q.x() - lines, rx = r.x() - lines;
            const Two pq = px * qy - py * qx, qr = qx * ry - qy * rx, rp = rx * py - ry * px;
            const Two low = least(least(pq, qr), rp), high = most(most(pq, qr), rp);
            const TwoMasks inside = (low > rim_) | (high < -rim_), outside = (high > rim_) & (low < -rim_);
            all_inside |= bits_of(inside) << k;
            all_outside |= bits_of(outside) << k;
        }
        const std::uint64_t asked = bits_between(0, count - 1);
        return {all_inside & asked, ~(all_inside | all_outside) & asked};
    }
    /// The same for one line.
    Sides sides_of(double x, double y) const
    {
        const std::array twice{x, x};
        return sides_of(twice.data(), 1, y);
    }

    /// Returns the hit of a line at the rim, if it meets the triangle, whose plane is given. A vertical triangle of a
    /// sheet is never met.
    std::optional<SurfaceHit> hit_at_rim(const TrianglePlane& plane, double x, double y) const;

    /// Returns the hit of the vertical line through (x, y), if it meets the triangle.
    std::optional<SurfaceHit> hit(double x, double y) const
    {
        const auto [inside, rim] = sides_of(x, y);
        if (inside != 0) return TrianglePlane(*this).hit_inside(x, y);
        return rim != 0 ? hit_at_rim(TrianglePlane(*this), x, y) : std::nullopt;
    }

private:
    friend TrianglePlane;

    using Two = double __attribute__((vector_size(16)));  ///< two lines in one register; also an extension of clang
    using TwoMasks = decltype(Two{} < Two{});             ///< all bits of a number are equal

    static Two least(const Two& a, const Two& b) { return a < b ? a : b; }
    static Two most(const Two& a, const Two& b) { return a > b ? a : b; }
    static std::uint64_t bits_of(const TwoMasks& masks) { return std::uint64_t((masks[0] & 1) | (masks[1] & 2)); }
    double height_at_rim(const TrianglePlane& plane, double x, double y) const;

    const Tile& tile_;
    const std::uint32_t triangle_;
    const std::array<Vec3, 3> corners_;
    Place low_corner_, high_corner_;
    double rim_;  ///< m2; a line is clear of an edge if their cross product is above this, or below the negative
};

/// Returns where the vertical line through (x, y) meets an element of a tile, if it does.
std::optional<SurfaceHit> hit_of(const Tile& tile, std::uint32_t element, double x, double y);

}  // namespace spawnfield

#pragma once

#include "base/bits.h"
#include "base/four.h"
#include "geometry/geometry_impl.h"

#include <spawnfield/column.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>

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
    std::uint32_t part;
    bool filled, open, terrain, water;  ///< as in SurfaceHit

    [[gnu::always_inline]] explicit TrianglePlane(const SeenTriangle& triangle);

    /// Returns the height of the triangle at a line that is inside, m.
    double height(double at_x, double at_y) const
    {
        return std::min(std::max(z + slope_x * (at_x - x) + slope_y * (at_y - y), low), high);
    }
    /// Returns whether the height is certainly the same everywhere. If the first corner is at -0 m, the height may be
    /// 0 or -0.
    bool is_level() const { return low == high && !(z == 0 && std::signbit(z)); }
};

/// A triangle that is intersected with vertical lines.
class SeenTriangle {
public:
    using Place = Eigen::Array2d;  ///< x and y, m

    [[gnu::always_inline]] SeenTriangle(const Tile& tile, std::uint32_t triangle)
        : tile_(tile), triangle_(triangle), a_(corner(0)), b_(corner(1)), c_(corner(2))
    {
    }

    // The rectangle around the triangle, seen from above:
    Place low_corner() const { return a().min(b()).min(c()); }
    Place high_corner() const { return a().max(b()).max(c()); }

    /// Which vertical lines pass through the triangle, one bit for each. Rim: so near to an edge that only hit_at_rim()
    /// can decide. All others are outside.
    struct Sides {
        std::uint32_t inside, rim;
    };
    /// Looks at one line.
    ///
    /// The cross product of the vectors to two corners is twice the area of the triangle between the line and an edge.
    /// If all three clearly have the same sign, the line goes through the triangle. If two clearly have different
    /// signs, it does not. Clear lines are so far from an edge that neither rounding nor a tolerance decides.
    Sides sides_of(double x, double y) const
    {
        const Place line(x, y);
        const double ax = a_.x() - x, ay = a_.y() - y, bx = b_.x() - x, by = b_.y() - y, cx = c_.x() - x,
                     cy = c_.y() - y, ab = ax * by - ay * bx, bc = bx * cy - by * cx, ca = cx * ay - cy * ax,
                     low = std::min(std::min(ab, bc), ca), high = std::max(std::max(ab, bc), ca),
                     size = ((a() - line).abs() + (b() - line).abs() + (c() - line).abs()).sum(),
                     rim = 4 * touch_tolerance * size;
        const bool inside = (low > rim) | (high < -rim), outside = (high > rim) & (low < -rim);
        return {inside, !(inside | outside)};
    }

    /// Returns the hit of a line inside the triangle, which it meets at this height, m.
    SurfaceHit hit_inside(const TrianglePlane& plane, double height) const
    {
        SurfaceHit out;
        set_hit_inside(plane, height, out);
        return out;
    }
    /// Writes that hit part by part. Copying a whole hit that was just made would wait for all of its parts.
    [[gnu::always_inline]] void set_hit_inside(const TrianglePlane& plane, double height, SurfaceHit& out) const
    {
        const TilePiece& from = piece();
        out.element = tile_.ids[triangle_];
        out.piece = from.piece;
        out.part = plane.part;
        out.is_primitive = false;
        out.filled = plane.filled;
        out.open = plane.open;
        out.terrain = plane.terrain;
        out.water = plane.water;
        out.crosses = plane.filled;
        out.touches = !plane.filled;
        out.z = {height, height};
        out.crossing = height;
        out.piece_bottom = from.bottom;
    }
    /// Returns the hit of a line at the rim, if it meets the triangle. A vertical triangle of a sheet is never met.
    std::optional<SurfaceHit> hit_at_rim(const TrianglePlane& plane, double x, double y) const;
    /// The same for a triangle of a sheet: returns only the height of the hit, m.
    std::optional<double> sheet_at_rim(const TrianglePlane& plane, double x, double y) const;

    /// Returns the hit of the vertical line through (x, y), if it meets the triangle.
    std::optional<SurfaceHit> hit(double x, double y) const;

private:
    friend TrianglePlane;
    friend class TriangleSides;

    const TilePiece& piece() const { return tile_.piece(triangle_); }
    const Vec3& corner(std::size_t k) const { return tile_.vertices[tile_.triangles[triangle_].corners[k]]; }
    bool is_near(double x, double y) const;
    bool is_vertical(const TrianglePlane& plane) const;
    bool touches(const TrianglePlane& plane, double x, double y) const;  ///< if it is not vertical
    double height_at_rim(const TrianglePlane& plane, double x, double y) const;

    Place a() const { return a_.head<2>(); }
    Place b() const { return b_.head<2>(); }
    Place c() const { return c_.head<2>(); }

    const Tile& tile_;
    const std::uint32_t triangle_;
    const Vec3 &a_, &b_, &c_;
};

inline TrianglePlane::TrianglePlane(const SeenTriangle& triangle)
{
    const Vec3 &a = triangle.a_, &b = triangle.b_, &c = triangle.c_, ab = b - a, ac = c - a;
    const Interval heights{std::min({a.z(), b.z(), c.z()}), std::max({a.z(), b.z(), c.z()})};
    twice_area = ab.x() * ac.y() - ab.y() * ac.x();
    x = a.x();
    y = a.y();
    z = a.z();
    const bool is_vertical = twice_area == 0;
    slope_x = is_vertical ? 0 : (ab.z() * ac.y() - ac.z() * ab.y()) / twice_area;
    slope_y = is_vertical ? 0 : (ac.z() * ab.x() - ab.z() * ac.x()) / twice_area;
    low = is_vertical ? heights.top : heights.bottom;  // a vertical one has no single height at a point: its top counts
    high = heights.top;
    const Label label = triangle.tile_.triangles[triangle.triangle_].label;
    const TilePiece& piece = triangle.piece();
    part = piece.part;
    filled = piece.solid != 0;
    open = piece.open != 0;
    terrain = label == Label::Terrain && (piece.sides_up == 0 || filled || twice_area > 0);
    water = label == Label::Water;
}

/// Does the same as SeenTriangle::sides_of() for many lines: four at a time, in single floats, for which clear lines
/// are farther from an edge. If the triangle faces downwards, the signs of all cross products are turned round.
class TriangleSides {
public:
    using Place = SeenTriangle::Place;
    static constexpr int width = 4;  ///< lines that are looked at together

    /// The lines that are asked for lie in the rectangle from `first` to `last`, m.
    [[gnu::always_inline]] TriangleSides(const SeenTriangle& seen, const Place& first, const Place& last)
        : corner_(seen.a())
    {
        const double bx = seen.b_.x() - corner_[0], by = seen.b_.y() - corner_[1], cx = seen.c_.x() - corner_[0],
                     cy = seen.c_.y() - corner_[1], area = bx * cy - by * cx, sign = area < 0 ? -1 : 1;
        bx_ = float(sign * bx);
        cx_ = float(sign * cx);
        by_ = all(float(sign * by));
        cy_ = all(float(sign * cy));
        area_ = all(float(sign * area));
        const double size = std::abs(bx) + std::abs(by) + std::abs(cx) + std::abs(cy),
                     reach = (first - corner_).abs().max((last - corner_).abs()).sum();
        constexpr double rounding = 1e-6;  // more than 12 rounding errors of a float
        rim_ = all(float(size * (4 * touch_tolerance + rounding * (size + reach))));
    }

    /// What is known of four lines before their y.
    struct Lines;
    /// Returns the lines at x[0] .. x[3], m.
    Lines at(const double* x) const;

    static constexpr int most_rows = 64 / width;
    /// Four bits for each row of lines; otherwise as in SeenTriangle::Sides.
    struct Sides {
        std::uint64_t inside, rim;
    };
    /// Looks at these lines in 1 .. most_rows rows at y, m. No branch depends on a line.
    Sides of(const Lines& lines, std::span<const double> y) const;

    /// Returns the bits of the first lines of each row, 1 or more of them.
    static std::uint64_t first_lines(int count)
    {
        constexpr std::uint64_t row = (1U << width) - 1, first_of_each_row = ~std::uint64_t{0} / row;
        return first_of_each_row * (row >> std::max(0, width - count));
    }

private:
    const Place corner_;  ///< the first one, m
    float bx_, cx_;       ///< of the other corners, from the first one, m
    Four by_, cy_;        ///< in all four numbers
    Four area_;           ///< twice the area, m2
    Four rim_;            ///< m2; a cross product above it is clearly positive
};

struct TriangleSides::Lines {
    Four ab, ca;  ///< the parts of the cross products with two edges that depend on x, m2
};

inline TriangleSides::Lines TriangleSides::at(const double* x) const
{
    const double from = corner_[0];
    const Four at{float(x[0] - from), float(x[1] - from), float(x[2] - from), float(x[3] - from)};
    return {by_ * at, cy_ * at};
}

inline TriangleSides::Sides TriangleSides::of(const Lines& lines, std::span<const double> y) const
{
    std::uint64_t inside = 0, outside = 0;
    for (std::size_t j = y.size(); j-- > 0;) {
        const float from_corner = float(y[j] - corner_[1]);
        const Four ab = all(bx_ * from_corner) - lines.ab, ca = lines.ca - all(cx_ * from_corner), bc = area_ - ab - ca,
                   low = least(least(ab, ca), bc);
        inside = inside << width | bits_of(low > rim_);
        outside = outside << width | bits_of(low < -rim_);
    }
    return {inside, ~(inside | outside) & bits_between(0, int(y.size()) * width - 1)};
}

/// Four pairs of a vertical line and a triangle.
struct FourPairs {
    static constexpr std::size_t width = 4;
    std::array<const double*, width> lines;  ///< x and y of each line, m
    std::array<std::array<const Vec3*, 3>, width> corners;

    /// Does the same as SeenTriangle::sides_of() for each pair, in single floats. `rim` must be rim_in() for a box
    /// around the lines and the triangles.
    SeenTriangle::Sides sides(float rim) const
    {
        std::array<Four, 3> x, y;  // of the corners, from the lines
        for (std::size_t k = 0; k < 3; ++k) {
            const auto of = [&](std::size_t i, std::size_t j) {
                return differences(corners[i][k]->data(), lines[i], corners[j][k]->data(), lines[j]);
            };
            const Four first = of(0, 1), second = of(2, 3);
            x[k] = __builtin_shufflevector(first, second, 0, 2, 4, 6);
            y[k] = __builtin_shufflevector(first, second, 1, 3, 5, 7);
        }
        const Four ab = x[0] * y[1] - y[0] * x[1], bc = x[1] * y[2] - y[1] * x[2], ca = x[2] * y[0] - y[2] * x[0],
                   low = least(least(ab, bc), ca), high = greatest(greatest(ab, bc), ca), clear = all(rim);
        const std::uint32_t bits = bits_of((low > clear) | (high < -clear), (high > clear) & (low < -clear)),
                            inside = bits & 15;
        return {inside, ~(inside | bits >> 4) & 15};
    }

    /// Returns the area, m2, above which a cross product of vectors between corners and lines in a box of this size, m,
    /// is clearly not zero.
    static float rim_in(double size_x, double size_y)
    {
        constexpr double rounding = 1e-6;  // more than 8 rounding errors of a float
        return float(12 * touch_tolerance * (size_x + size_y) + rounding * size_x * size_y);
    }
};

/// Returns where the vertical line through (x, y) meets an element of a tile, if it does.
std::optional<SurfaceHit> hit_of(const Tile& tile, std::uint32_t element, double x, double y);

}  // namespace spawnfield

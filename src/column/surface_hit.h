#pragma once

#include "geometry/tile.h"

#include <spawnfield/column.h>

#include <optional>

namespace spawnfield {

/// Where a vertical line meets one element of a scene.
struct SurfaceHit {
    std::uint32_t element, piece, part;  ///< of the scene; primitives have no piece
    bool is_primitive, filled, open, terrain, water;
    bool crosses;         ///< goes through a triangle of a filled piece, each edge counted once
    bool touches;         ///< meets it in z, edges included
    Interval z;
    double crossing;      ///< height, m
    double piece_bottom;  ///< as Piece, m
};

/// A triangle as vertical lines see it. What a line needs not is computed once.
class SeenTriangle {
public:
    SeenTriangle(const Tile& tile, std::uint32_t triangle);

    /// Where the vertical line through (x, y) meets it. Sheets seen edge-on give nothing.
    std::optional<SurfaceHit> hit(double x, double y) const;

private:
    bool may_meet(double x, double y) const;
    bool is_crossed(double x, double y) const;
    bool is_touched(double x, double y) const;
    double height(double x, double y) const;
    std::optional<Interval> segment(double x, double y) const;

    std::array<Vec3, 3> corners_;
    std::array<double, 3> squared_lengths_{};  ///< of the edges from corner k to the next, seen from above, m^2
    double area_ = 0;                  ///< twice, seen from above; above 0 where it looks up
    Interval x_{}, y_{}, z_{};         ///< its extent
    bool is_vertical_ = false;         ///< thinner than the tolerance, so that its height over a point means nothing
    SurfaceHit hit_{};                 ///< all but where
};

std::optional<SurfaceHit> hit_of(const Tile& tile, std::uint32_t element, double x, double y);

}  // namespace spawnfield

#pragma once

#include "geometry/tile.h"

#include <spawnfield/column.h>

#include <algorithm>
#include <optional>

namespace spawnfield {

/// Where a vertical line meets one element of a scene.
struct SurfaceHit {
    std::uint32_t element, piece, part;  ///< of the scene; primitives have no piece
    bool is_primitive, filled, open, terrain, water;
    bool crosses;         ///< goes through a triangle of a filled piece at `crossing`, each edge counted once
    bool touches;         ///< meets it in z, edges included
    Interval z;
    double crossing;      ///< height, m
    double piece_bottom;  ///< as Piece, m
};

/// A triangle as vertical lines see it.
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
        }
    }

    /// Where the vertical line through (x, y) meets it: new_hit(), a SurfaceHit&, is written if it does. Sheets seen edge-on
    /// give nothing.
    template <class NewHit>
    void meet(double x, double y, const NewHit& new_hit) const
    {
        int left = 0, right = 0;  // edges that it is well to the left of, far from what rounding or a tolerance decides
        for (std::size_t k = 0; k < 3; ++k) {
            const Edge& edge = edges_[k];
            const double cross = edge.x * (y - corners_[k].y()) - edge.y * (x - corners_[k].x());
            const bool is_clear = cross * cross > squared_rim * edge.squared_length;
            if (!is_clear && edge.squared_length > 0) {
                left = right = 0;
                break;
            }
            left += is_clear && cross > 0;
            right += is_clear && cross < 0;
        }
        if (left > 0 && right > 0) return;
        if (left + right == 3) hit_within(x, y, left == 3, new_hit());
        else if (const auto hit = hit_at_rim(x, y)) new_hit() = *hit;  // also where it has an upright edge
    }

    std::optional<SurfaceHit> hit(double x, double y) const
    {
        std::optional<SurfaceHit> out;
        meet(x, y, [&]() -> SurfaceHit& { return out.emplace(); });
        return out;
    }

private:
    struct Edge {
        double x, y;            ///< m
        double squared_length;  ///< seen from above, m2
    };
    static constexpr double squared_rim = 16 * touch_tolerance * touch_tolerance;

    /// Writes all but where.
    void set_surface(bool looks_up, SurfaceHit& out) const
    {
        const TileTriangle& from = tile_.triangles[triangle_];
        const TilePiece& piece = tile_.pieces[from.piece];
        out.element = tile_.ids[triangle_];
        out.piece = piece.piece;
        out.part = piece.part;
        out.is_primitive = false;
        out.filled = piece.solid != 0;
        out.open = piece.open != 0;
        out.terrain = from.label == Label::Terrain && (piece.sides_up == 0 || piece.solid != 0 || looks_up);
        out.water = from.label == Label::Water;
        out.piece_bottom = piece.bottom;
    }

    void hit_within(double x, double y, bool looks_up, SurfaceHit& out) const
    {
        set_surface(looks_up, out);
        out.crosses = out.filled;
        out.touches = !out.filled;
        out.crossing = out.z.bottom = out.z.top = height(x, y);
    }

    std::optional<SurfaceHit> hit_at_rim(double x, double y) const;
    /// Twice, seen from above; above 0 where it looks up.
    double area() const { return edges_[0].x * (corners_[2].y() - corners_[0].y()) - edges_[0].y * (corners_[2].x() - corners_[0].x()); }

    double height(double x, double y) const
    {
        const auto& [a, b, c] = corners_;
        const double low = std::min(std::min(a.z(), b.z()), c.z()), high = std::max(std::max(a.z(), b.z()), c.z());
        const double twice = area();
        if (twice == 0) return high;
        const double dx = x - a.x(), dy = y - a.y(), acx = c.x() - a.x(), acy = c.y() - a.y();
        const double wb = (dx * acy - dy * acx) / twice, wc = (edges_[0].x * dy - edges_[0].y * dx) / twice;
        return std::clamp(a.z() + wb * (b.z() - a.z()) + wc * (c.z() - a.z()), low, high);
    }

    const Tile& tile_;
    const std::uint32_t triangle_;
    const std::array<Vec3, 3> corners_;
    std::array<Edge, 3> edges_;  ///< from corner k to the next
};

std::optional<SurfaceHit> hit_of(const Tile& tile, std::uint32_t element, double x, double y);

}  // namespace spawnfield

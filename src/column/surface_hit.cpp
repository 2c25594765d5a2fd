#include "column/surface_hit.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double squared_tolerance = touch_tolerance * touch_tolerance;

/// Whether the edge a-b crosses the ray from p towards +x. One answer per edge, whichever triangle asks: the ends are
/// put in a fixed order first, so two triangles never disagree on their common edge.
bool edge_crosses(const Vec3& a, const Vec3& b, double x, double y)
{
    if ((a.y() > y) == (b.y() > y)) return false;
    const bool ordered = a.y() < b.y();
    const Vec3& low = ordered ? a : b;
    const Vec3& high = ordered ? b : a;
    const double side = (high.x() - low.x()) * (y - low.y()) - (x - low.x()) * (high.y() - low.y());
    return side > 0;
}

/// Joins the heights at which the line meets the edge p-q, if it does.
void extend(const Vec3& p, const Vec3& q, double x, double y, std::optional<Interval>& joined)
{
    const Vec2 edge = (q - p).head<2>(), to(x - p.x(), y - p.y());
    const double length = edge.norm();
    const double along = length > touch_tolerance ? to.dot(edge) / length : 0;
    if (along < -touch_tolerance || along > length + touch_tolerance) return;
    const Vec2 off = length > touch_tolerance ? Vec2(to - along / length * edge) : to;
    if (off.norm() > touch_tolerance) return;
    Interval here{std::min(p.z(), q.z()), std::max(p.z(), q.z())};
    if (length > touch_tolerance) {
        const double z = p.z() + std::clamp(along / length, 0.0, 1.0) * (q.z() - p.z());
        here = {z, z};
    }
    joined = joined ? Interval{std::min(joined->bottom, here.bottom), std::max(joined->top, here.top)} : here;
}

}  // namespace

SeenTriangle::SeenTriangle(const Tile& tile, std::uint32_t triangle) : corners_(tile.corners(triangle))
{
    const auto& [a, b, c] = corners_;
    const Vec2 ab = (b - a).head<2>(), ac = (c - a).head<2>(), bc = (c - b).head<2>();
    area_ = ab.x() * ac.y() - ab.y() * ac.x();
    squared_lengths_ = {ab.squaredNorm(), bc.squaredNorm(), ac.squaredNorm()};
    is_vertical_ = area_ * area_ <= squared_tolerance * std::max({squared_lengths_[0], squared_lengths_[1], squared_lengths_[2]});
    x_ = {std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()})};
    y_ = {std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()})};
    z_ = {std::min({a.z(), b.z(), c.z()}), std::max({a.z(), b.z(), c.z()})};
    const TileTriangle& from = tile.triangles[triangle];
    const TilePiece& piece = tile.pieces[from.piece];
    hit_.element = tile.ids[triangle];
    hit_.piece = piece.piece;
    hit_.part = piece.part;
    hit_.filled = piece.solid != 0;
    hit_.open = piece.open != 0;
    hit_.terrain = from.label == Label::Terrain && (piece.sides_up == 0 || hit_.filled || area_ > 0);
    hit_.water = from.label == Label::Water;
    hit_.piece_bottom = piece.bottom;
}

std::optional<SurfaceHit> SeenTriangle::hit(double x, double y) const
{
    if (!may_meet(x, y)) return std::nullopt;
    SurfaceHit out = hit_;
    out.crosses = hit_.filled && is_crossed(x, y);
    if (out.crosses) out.crossing = height(x, y);
    if (is_vertical_) {
        // Also where it is crossed: by rounding, a line along it may cross it as well.
        const auto met = hit_.filled ? segment(x, y) : std::nullopt;
        out.touches = met.has_value();
        if (met) out.z = *met;
    } else {
        out.touches = !out.crosses && is_touched(x, y);
        if (out.touches) out.z.bottom = out.z.top = height(x, y);
    }
    if (!out.crosses && !out.touches) return std::nullopt;
    return out;
}

bool SeenTriangle::may_meet(double x, double y) const
{
    constexpr double reach = touch_tolerance;
    return x_.bottom <= x + reach && x_.top >= x - reach && y_.bottom <= y + reach && y_.top >= y - reach;
}

bool SeenTriangle::is_crossed(double x, double y) const
{
    const auto& [a, b, c] = corners_;
    return edge_crosses(a, b, x, y) ^ edge_crosses(b, c, x, y) ^ edge_crosses(c, a, x, y);
}

/// Whether the line passes through it, edges included to touch_tolerance.
bool SeenTriangle::is_touched(double x, double y) const
{
    const double sign = area_ > 0 ? 1 : -1;
    const auto is_left = [&](const Vec3& p, const Vec3& q, double squared_length) {
        const double cross = (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
        return sign * cross >= 0 || cross * cross <= squared_tolerance * squared_length;
    };
    const auto& [a, b, c] = corners_;
    return is_left(a, b, squared_lengths_[0]) && is_left(b, c, squared_lengths_[1]) && is_left(c, a, squared_lengths_[2]);
}

double SeenTriangle::height(double x, double y) const
{
    const auto& [a, b, c] = corners_;
    if (area_ == 0) return z_.top;
    const double wb = ((x - a.x()) * (c.y() - a.y()) - (y - a.y()) * (c.x() - a.x())) / area_;
    const double wc = ((b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x())) / area_;
    return std::clamp(a.z() + wb * (b.z() - a.z()) + wc * (c.z() - a.z()), z_.bottom, z_.top);
}

/// For a vertical triangle: the segment in which the line runs along it.
std::optional<Interval> SeenTriangle::segment(double x, double y) const
{
    std::optional<Interval> joined;
    for (std::size_t k = 0; k < 3; ++k) extend(corners_[k], corners_[(k + 1) % 3], x, y, joined);
    return joined;
}

std::optional<SurfaceHit> hit_of(const Tile& tile, std::uint32_t element, double x, double y)
{
    if (tile.is_triangle(element)) return SeenTriangle(tile, element).hit(x, y);
    const TilePrimitive& primitive = tile.primitive(element);
    const auto interval = vertical_interval(primitive.shape(), x, y);
    if (!interval) return std::nullopt;
    return SurfaceHit{.element = tile.ids[element], .piece = 0, .part = primitive.part, .is_primitive = true, .filled = true, .open = false,
                      .terrain = primitive.label == Label::Terrain, .water = primitive.label == Label::Water, .crosses = false,
                      .touches = true, .z = *interval, .crossing = 0, .piece_bottom = 0};
}

}  // namespace spawnfield

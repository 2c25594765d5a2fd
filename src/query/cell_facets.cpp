#include "query/cell_facets.h"

#include "column/surface_hit.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr std::size_t most_facets = 64;  // in a cell; if there are more, only the heights of the terrain count

/// Returns whether a polygon is narrower than touch_tolerance (m), the distance at which two lines count as different.
bool is_sliver(const SmallPolygon& polygon)
{
    double longest = 0;
    for (const Vec2& p : polygon) longest = std::max(longest, (p - polygon[0]).norm());
    return polygon.size() < 3 || area_of(polygon) <= touch_tolerance / 4 * longest;
}

}  // namespace

Vec2 unit_edge_normal(const Vec2& p, const Vec2& q) { return edge_normal(p, q).normalized(); }

SmallPolygon corners_of(const Rect& r)
{
    return {{r.low_x, r.low_y}, {r.high_x, r.low_y}, {r.high_x, r.high_y}, {r.low_x, r.high_y}};
}

bool are_parted(const SmallPolygon& a, const SmallPolygon& b, double by)
{
    const auto parts = [&](const SmallPolygon& from, const SmallPolygon& other) {
        for (std::size_t k = 0; k < from.size(); ++k) {
            const Vec2 normal = unit_edge_normal(from[k], from[k + 1 < from.size() ? k + 1 : 0]);
            const double rim = normal.dot(from[k]) - by;
            if (std::all_of(other.begin(), other.end(), [&](const Vec2& p) { return normal.dot(p) >= rim; }))
                return true;
        }
        return false;
    };
    return parts(a, b) || parts(b, a);
}

void Remainder::take(const SmallPolygon& polygon)
{
    out_.clear();
    for (SmallPolygon& piece : left_) {
        if (piece.size() + polygon.size() > SmallPolygon::most) {  // too many corners for a cut: the piece is kept
            out_.push_back(piece);
            continue;
        }
        for (std::size_t k = 0; k < polygon.size() && !piece.empty(); ++k) {
            const Vec2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
            const Vec2 normal = unit_edge_normal(p, q);
            const SmallPolygon beyond = cut(piece, -normal, -normal.dot(p));
            if (!is_sliver(beyond)) out_.push_back(beyond);
            piece = cut(piece, normal, normal.dot(p));
        }
    }
    std::swap(left_, out_);
}

CellFacets::CellFacets(const Geometry& geometry, const Rect& cell) : cell_(cell), corners_(corners_of(cell))
{
    geometry.impl().visit_in(cell, [&](const Tile& tile, std::uint32_t element) {
        const ElementBox box = tile.box(element);
        if (tile.label(element) == Label::Terrain) {
            terrain.bottom = std::min(terrain.bottom, double(box.min[2]));
            terrain.top = std::max(terrain.top, double(box.max[2]));
        }
        has_too_many = has_too_many || all.size() >= most_facets;
        if (has_too_many) return;
        if (tile.is_triangle(element))
            add_triangle(tile, element, false);
        else
            add_primitive(tile, element);
    });
    if (!has_too_many && has_filled_terrain_) {
        // The other faces of filled meshes count too, because they separate the inside from the outside.
        geometry.impl().visit_in(cell, [&](const Tile& tile, std::uint32_t element) {
            has_too_many = has_too_many || all.size() >= most_facets;
            if (tile.is_triangle(element) && !has_too_many) add_triangle(tile, element, true);
        });
    }
    if (has_too_many) return;
    // The rounding of proofs depends on the order, and the order of tiles is another one in a changed scene.
    const auto is_earlier = [](const Facet& l, const Facet& r) { return l.order < r.order; };
    if (!std::is_sorted(all.begin(), all.end(), is_earlier)) std::stable_sort(all.begin(), all.end(), is_earlier);
}

void CellFacets::set_plane(const Vec3& a, const Vec3& normal, const Interval& limits, Facet& out) const
{
    out.has_plane = true;
    out.slope = Vec2(-normal.x() / normal.z(), -normal.y() / normal.z());
    out.height = a.z() - out.slope.dot(a.head<2>());
    Vec2 low(inf, inf), high(-inf, -inf);
    for (const Vec2& p : out.polygon) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    low = low.cwiseMax(Vec2(cell_.low_x, cell_.low_y));
    high = high.cwiseMin(Vec2(cell_.high_x, cell_.high_y));
    const Vec2 middle = (low + high) / 2, half = ((high - low) / 2).cwiseMax(0.0);
    const double z = a.z() + out.slope.dot(middle - a.head<2>()), reach = out.slope.cwiseAbs().dot(half);
    out.z = {std::clamp(z - reach, limits.bottom, limits.top) - proof_slack,
             std::clamp(z + reach, limits.bottom, limits.top) + proof_slack};
}

void CellFacets::add_triangle(const Tile& tile, std::uint32_t element, bool other_filled)
{
    if (other_filled && (tile.label(element) == Label::Terrain || tile.label(element) == Label::Water)) return;
    const auto [a, b, c] = tile.corners(element);
    const TileTriangle& triangle = tile.triangles[element];
    const TilePiece& piece = tile.piece(element);
    Facet out;
    out.order = tile.order(element);
    out.filled = piece.solid != 0;
    out.open = piece.open != 0;
    out.piece = piece.piece;
    const Vec3 normal = (b - a).cross(c - a);
    out.water = triangle.label == Label::Water;
    out.terrain = triangle.label == Label::Terrain && (piece.sides_up == 0 || out.filled || normal.z() > 0);
    if (!out.terrain && !out.water && !(other_filled && out.filled)) return;
    has_filled_terrain_ = has_filled_terrain_ || (out.filled && out.terrain);
    const Interval limits{std::min({a.z(), b.z(), c.z()}), std::max({a.z(), b.z(), c.z()})};
    const double longest = std::max({(b - a).head<2>().norm(), (c - a).head<2>().norm(), (c - b).head<2>().norm()});
    if (std::abs(normal.z()) <= touch_tolerance * longest) {
        if (!out.filled) return;  // a vertical triangle of a sheet gives no interval
        out.z = limits;
        all.push_back(std::move(out));
        return;
    }
    out.polygon = {a.head<2>(), b.head<2>(), c.head<2>()};
    if (normal.z() < 0) out.polygon.turn_round();
    if (are_parted(corners_, out.polygon, -4 * touch_tolerance)) return;
    set_plane(a, normal, limits, out);
    if (out.filled) {
        const auto hit = SeenTriangle(tile, element).hit(cell_.centre_x(), cell_.centre_y());
        out.crossed = hit && hit->crosses;
    }
    all.push_back(std::move(out));
}

void CellFacets::add_primitive(const Tile& tile, std::uint32_t element)
{
    const Label label = tile.label(element);
    if (label != Label::Terrain && label != Label::Water) return;
    const Shape shape = tile.primitive(element).shape();
    if (shape.kind == ShapeKind::Box) {
        add_box(shape, label, tile.order(element));
        return;
    }
    Facet out;
    out.order = tile.order(element);
    out.terrain = label == Label::Terrain;
    out.water = label == Label::Water;
    const ElementBox box = tile.box(element);
    out.z = {double(box.min[2]), double(box.max[2])};
    // The upper surface of a convex body is concave. So over the cell, its lowest point `least` is at a corner, and its
    // highest point is at most as far above `middle` as `least` is below.
    double least = inf;
    const auto middle = vertical_interval(shape, cell_.centre_x(), cell_.centre_y());
    bool is_whole = middle.has_value();
    for (const Vec2& corner : corners_of(cell_)) {
        const auto there = vertical_interval(shape, corner.x(), corner.y());
        is_whole = is_whole && there;
        if (there) least = std::min(least, there->top);
    }
    if (is_whole) {
        out.polygon = corners_of(cell_);
        out.z = {least - proof_slack, std::min(out.z.top, 2 * middle->top - least + proof_slack)};
    }
    all.push_back(std::move(out));
}

/// Adds the sides of a box that are visible from above.
void CellFacets::add_box(const Shape& box, Label label, std::uint64_t order)
{
    for (int axis = 0; axis < 3; ++axis) {
        const int next = (axis + 1) % 3, last = (axis + 2) % 3;
        const Mat3& turn = box.pose.rotation;
        const double sign = turn(2, axis) < 0 ? -1 : 1;
        const Vec3 normal = sign * turn.col(axis);
        if (!(normal.z() > 1e-9)) continue;
        const Vec3 middle = box.pose.position + box.size[axis] / 2 * normal;
        const Vec3 u = box.size[next] / 2 * turn.col(next), v = box.size[last] / 2 * turn.col(last);
        Facet out;
        out.order = order;
        out.terrain = label == Label::Terrain;
        out.water = label == Label::Water;
        Interval limits{inf, -inf};
        for (const auto& [i, j] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            const Vec3 corner = middle + i * u + j * v;
            out.polygon.push_back(corner.head<2>());
            limits = {std::min(limits.bottom, corner.z()), std::max(limits.top, corner.z())};
        }
        if (area_of(out.polygon) < 0) out.polygon.turn_round();
        if (are_parted(corners_, out.polygon, -4 * touch_tolerance)) continue;
        set_plane(middle, normal, limits, out);
        all.push_back(std::move(out));
    }
}

}  // namespace spawnfield

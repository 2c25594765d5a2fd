#include "column/bins.h"
#include "scene/elements.h"

#include <spawnfield/column.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

using Vec2 = Eigen::Vector2d;

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

struct Hit {
    Interval z;
    bool terrain;
};

/// A triangle as the vertical line through (x, y) sees it.
class SeenTriangle {
public:
    SeenTriangle(const std::array<Vec3, 3>& corners, double x, double y)
        : a_(corners[0]), b_(corners[1]), c_(corners[2]), x_(x), y_(y)
    {
        const Vec2 ab = (b_ - a_).head<2>(), ac = (c_ - a_).head<2>();
        area_ = ab.x() * ac.y() - ab.y() * ac.x();
        longest_ = std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (c_ - b_).head<2>().squaredNorm()}));
    }

    /// Seen edge-on: thinner than the tolerance, so that its height over a point means nothing.
    bool is_vertical() const { return std::abs(area_) <= touch_tolerance * longest_; }
    bool looks_up() const { return area_ > 0; }

    bool is_crossed() const
    {
        return edge_crosses(a_, b_, x_, y_) ^ edge_crosses(b_, c_, x_, y_) ^ edge_crosses(c_, a_, x_, y_);
    }

    /// Whether the line passes through it, edges included to touch_tolerance.
    bool is_touched() const
    {
        const double sign = area_ > 0 ? 1 : -1;
        return is_left(a_, b_, sign) && is_left(b_, c_, sign) && is_left(c_, a_, sign);
    }

    double height() const
    {
        if (area_ == 0) return std::max({a_.z(), b_.z(), c_.z()});
        const double wb = ((x_ - a_.x()) * (c_.y() - a_.y()) - (y_ - a_.y()) * (c_.x() - a_.x())) / area_;
        const double wc = ((b_.x() - a_.x()) * (y_ - a_.y()) - (b_.y() - a_.y()) * (x_ - a_.x())) / area_;
        const double z = a_.z() + wb * (b_.z() - a_.z()) + wc * (c_.z() - a_.z());
        return std::clamp(z, std::min({a_.z(), b_.z(), c_.z()}), std::max({a_.z(), b_.z(), c_.z()}));
    }

    /// For a vertical triangle: the segment in which the line runs along it.
    std::optional<Interval> segment() const
    {
        std::optional<Interval> joined;
        for (const auto& [p, q] : {std::pair{&a_, &b_}, std::pair{&b_, &c_}, std::pair{&c_, &a_}}) extend(*p, *q, joined);
        return joined;
    }

private:
    bool is_left(const Vec3& p, const Vec3& q, double sign) const
    {
        const Vec2 edge = (q - p).head<2>();
        const double cross = edge.x() * (y_ - p.y()) - edge.y() * (x_ - p.x());
        return sign * cross >= -touch_tolerance * edge.norm();
    }

    /// Joins the heights at which the line meets the edge p-q, if it does.
    void extend(const Vec3& p, const Vec3& q, std::optional<Interval>& joined) const
    {
        const Vec2 edge = (q - p).head<2>(), to(x_ - p.x(), y_ - p.y());
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

    const Vec3 &a_, &b_, &c_;
    double x_, y_, area_, longest_;
};

/// Inside intervals of a filled piece from its crossings, bottom up. An odd count can only come from a piece that is
/// filled by the user's wish: what lies under its lowest crossing is inside down to the piece's bottom.
void pair_crossings(std::vector<Hit>& crossings, double piece_bottom, std::vector<Hit>& intervals)
{
    std::sort(crossings.begin(), crossings.end(), [](const Hit& l, const Hit& r) { return l.z.top < r.z.top; });
    std::size_t i = 0;
    if (crossings.size() % 2 == 1) {
        const Hit& lowest = crossings[i++];
        intervals.push_back({{std::min(piece_bottom, lowest.z.top), lowest.z.top}, lowest.terrain});
    }
    for (; i < crossings.size(); i += 2)
        intervals.push_back({{crossings[i].z.top, crossings[i + 1].z.top}, crossings[i + 1].terrain});
}

/// Unions intervals that overlap or lie within `tolerance` of each other; the highest top gives label and height.
void join(std::vector<Hit>& intervals, double tolerance)
{
    std::sort(intervals.begin(), intervals.end(), [](const Hit& l, const Hit& r) { return l.z.bottom < r.z.bottom; });
    std::size_t kept = 0;
    for (const Hit& next : intervals) {
        if (kept == 0 || next.z.bottom > intervals[kept - 1].z.top + tolerance) {
            intervals[kept++] = next;
            continue;
        }
        Hit& current = intervals[kept - 1];
        const bool same_top = std::abs(next.z.top - current.z.top) <= touch_tolerance;
        if (same_top) current.terrain = current.terrain || next.terrain;
        else if (next.z.top > current.z.top) current.terrain = next.terrain;
        current.z.top = std::max(current.z.top, next.z.top);
    }
    intervals.resize(kept);
}

/// Whether the line may meet the element at all: cheap, and most elements of a bin are out.
bool may_meet(const Scene& scene, std::uint32_t element, double x, double y)
{
    if (!is_triangle(scene, element)) return true;
    const Triangle& t = scene.triangles[element];
    const Vec3 &a = scene.vertices[t[0]], &b = scene.vertices[t[1]], &c = scene.vertices[t[2]];
    const double reach = touch_tolerance;
    return !((a.x() > x + reach && b.x() > x + reach && c.x() > x + reach) ||
             (a.x() < x - reach && b.x() < x - reach && c.x() < x - reach) ||
             (a.y() > y + reach && b.y() > y + reach && c.y() > y + reach) ||
             (a.y() < y - reach && b.y() < y - reach && c.y() < y - reach));
}

class ColumnBuilder {
public:
    ColumnBuilder(const Scene& scene, double x, double y) : scene_(scene), x_(x), y_(y) {}

    void add_piece(const Piece& piece, const std::uint32_t* first, const std::uint32_t* last)
    {
        hits_.clear();
        crossings_.clear();
        const bool water = scene_.triangle_labels[*first] == Label::Water;  // a solid piece is water throughout
        for (const std::uint32_t* t = first; t != last; ++t) add_triangle(piece, *t);
        if (piece.solid) {
            pair_crossings(crossings_, piece.bottom, hits_);
            join(hits_, touch_tolerance);
        }
        for (const Hit& hit : hits_) {
            if (piece.solid && water) column_.water.push_back(hit.z.top);
            else column_.spans.push_back({hit.z.bottom, hit.z.top, piece.part, hit.terrain});
        }
    }

    void add_primitive(const Primitive& primitive)
    {
        const auto interval = vertical_interval(primitive.shape, x_, y_);
        if (!interval) return;
        if (primitive.label == Label::Water) column_.water.push_back(interval->top);
        else column_.spans.push_back({interval->bottom, interval->top, primitive.part, primitive.label == Label::Terrain});
    }

    Column finish()
    {
        std::sort(column_.spans.begin(), column_.spans.end(), [](const Span& l, const Span& r) {
            if (l.top != r.top) return l.top > r.top;
            return l.terrain != r.terrain ? l.terrain : l.part < r.part;
        });
        std::sort(column_.water.begin(), column_.water.end(), std::greater<>());
        hits_.clear();
        for (const Span& span : column_.spans)
            if (span.terrain) hits_.push_back({{span.bottom, span.top}, true});
        join(hits_, layer_tolerance);
        for (auto hit = hits_.rbegin(); hit != hits_.rend(); ++hit) column_.layers.push_back(hit->z.top);
        return std::move(column_);
    }

private:
    void add_triangle(const Piece& piece, std::uint32_t triangle)
    {
        const std::array<Vec3, 3> corners = corners_of(scene_, triangle);
        const SeenTriangle seen(corners, x_, y_);
        const Label label = scene_.triangle_labels[triangle];
        const bool terrain = label == Label::Terrain && (!piece.sides_up || piece.solid || seen.looks_up());
        if (piece.solid && seen.is_crossed()) {
            const double z = seen.height();
            crossings_.push_back({{z, z}, terrain});
        } else if (seen.is_vertical()) {
            if (!piece.solid) return;
            if (const auto segment = seen.segment()) hits_.push_back({*segment, terrain});
        } else if (seen.is_touched()) {
            const double z = seen.height();
            if (!piece.solid && label == Label::Water) column_.water.push_back(z);
            else hits_.push_back({{z, z}, terrain});
        }
    }

    const Scene& scene_;
    double x_, y_;
    Column column_;
    std::vector<Hit> hits_, crossings_;
};

}  // namespace

Column column_at(const Scene& scene, const ColumnIndex& index, double x, double y)
{
    thread_local std::vector<std::uint32_t> elements;
    elements.clear();
    visit_bins_at(index, x, y, [&](const std::uint32_t* first, const std::uint32_t* last) {
        for (; first != last; ++first)
            if (may_meet(scene, *first, x, y)) elements.push_back(*first);
    });
    std::sort(elements.begin(), elements.end());
    ColumnBuilder builder(scene, x, y);
    const std::uint32_t* const end = elements.data() + elements.size();
    for (const std::uint32_t* e = elements.data(); e != end;) {
        if (!is_triangle(scene, *e)) {
            builder.add_primitive(primitive_of(scene, *e++));
            continue;
        }
        const std::uint32_t piece = scene.triangle_pieces[*e];
        const std::uint32_t* const first = e;
        while (e != end && is_triangle(scene, *e) && scene.triangle_pieces[*e] == piece) ++e;
        builder.add_piece(scene.pieces[piece], first, e);
    }
    return builder.finish();
}

std::optional<Ground> ground_below(const Column& column, double z)
{
    std::optional<Ground> best;
    for (const Span& span : column.spans) {  // highest top first
        if (span.top > z + touch_tolerance) continue;
        if (best && best->height - span.top > touch_tolerance) break;
        if (!best || (span.terrain && !best->terrain)) best = Ground{span.top, span.terrain, span.part};
    }
    return best;
}

}  // namespace spawnfield

#include "map/cell_clip.h"

#include "geometry/tile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

constexpr int cylinder_sides = 256;  // circumscribed: 0.0075 % of the radius too wide

using Polygon = std::vector<Vec3>;

/// The part of a convex polygon where sign * (p[axis] - limit) <= 0 (Sutherland, Hodgman 1974).
void clip(const Polygon& in, int axis, double limit, double sign, Polygon& out)
{
    out.clear();
    for (std::size_t i = 0; i < in.size(); ++i) {
        const Vec3 &p = in[i], &q = in[(i + 1) % in.size()];
        const double dp = sign * (p[axis] - limit), dq = sign * (q[axis] - limit);
        if (dp <= 0) out.push_back(p);
        if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
            Vec3 cut = p + dp / (dp - dq) * (q - p);
            cut[axis] = limit;
            out.push_back(cut);
        }
    }
}

/// Height range of a convex polygon in each cell of a block that it meets.
class PolygonClipper {
public:
    explicit PolygonClipper(const CellBlock& block) : block_(block) {}

    template <class Visit>
    void visit_cells(const Polygon& polygon, Visit visit)
    {
        const auto [y_low, y_high] = range(polygon, 1);
        const int j0 = first_cell(y_low - block_.y0), j1 = last_cell(y_high - block_.y0, block_.rows);
        for (int j = std::max(0, j0); j <= j1; ++j) {
            band(polygon, 1, block_.y0 + j * block_.cell, strip_);
            if (strip_.empty()) continue;
            const auto [x_low, x_high] = range(strip_, 0);
            const int i0 = first_cell(x_low - block_.x0), i1 = last_cell(x_high - block_.x0, block_.cols);
            for (int i = std::max(0, i0); i <= i1; ++i) {
                band(strip_, 0, block_.x0 + i * block_.cell, piece_);
                if (piece_.empty()) continue;
                const auto [bottom, top] = range(piece_, 2);
                visit(i, j, bottom, top);
            }
        }
    }

private:
    /// The part within one row or column of cells, widened by touch_tolerance.
    void band(const Polygon& in, int axis, double low, Polygon& out)
    {
        clip(in, axis, low + block_.cell + touch_tolerance, 1, scratch_);
        clip(scratch_, axis, low - touch_tolerance, -1, out);
    }

    static std::pair<double, double> range(const Polygon& polygon, int axis)
    {
        double low = polygon[0][axis], high = low;
        for (const Vec3& p : polygon) {
            low = std::min(low, p[axis]);
            high = std::max(high, p[axis]);
        }
        return {low, high};
    }

    int first_cell(double offset) const
    {
        return int(std::clamp(std::floor((offset - touch_tolerance) / block_.cell - 1e-9), -1.0, 1e9));
    }
    int last_cell(double offset, int count) const
    {
        return int(std::clamp(std::floor((offset + touch_tolerance) / block_.cell + 1e-9), -1.0, double(count - 1)));
    }

    const CellBlock& block_;
    Polygon scratch_, strip_, piece_;
};

std::vector<Polygon> box_faces(const Shape& shape)
{
    std::vector<Polygon> faces;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-0.5, 0.5}) {
            Polygon face;
            for (const auto& [u, v] : {std::pair{-0.5, -0.5}, std::pair{0.5, -0.5}, std::pair{0.5, 0.5}, std::pair{-0.5, 0.5}}) {
                Vec3 corner;
                corner[axis] = side * shape.size[axis];
                corner[(axis + 1) % 3] = u * shape.size[(axis + 1) % 3];
                corner[(axis + 2) % 3] = v * shape.size[(axis + 2) % 3];
                face.push_back(shape.pose.rotation * corner + shape.pose.position);
            }
            faces.push_back(std::move(face));
        }
    return faces;
}

/// The prism around a cylinder (or the straight part of a capsule).
std::vector<Polygon> prism_faces(const Shape& shape)
{
    const double radius = shape.size[0] / std::cos(std::numbers::pi / cylinder_sides), half = shape.size[1] / 2;
    Polygon low, high;
    for (int side = 0; side < cylinder_sides; ++side) {
        const double angle = 2 * std::numbers::pi * side / cylinder_sides;
        const double x = radius * std::cos(angle), y = radius * std::sin(angle);
        low.push_back(shape.pose.rotation * Vec3(x, y, -half) + shape.pose.position);
        high.push_back(shape.pose.rotation * Vec3(x, y, half) + shape.pose.position);
    }
    std::vector<Polygon> faces;
    for (int side = 0; side < cylinder_sides; ++side) {
        const int next = (side + 1) % cylinder_sides;
        faces.push_back({low[side], low[next], high[next], high[side]});
    }
    faces.push_back(low);
    faces.push_back(high);
    return faces;
}

/// Collects spans; a primitive's faces are joined to one span per cell first, as it is convex.
class SpanCollector {
public:
    explicit SpanCollector(const CellBlock& block) : block_(block), clipper_(block) {}

    void add_triangle(const std::array<Vec3, 3>& corners)
    {
        polygon_.assign(corners.begin(), corners.end());
        clipper_.visit_cells(polygon_, [&](int i, int j, double bottom, double top) {
            spans_.push_back({block_.id(i, j), bottom, top});
        });
    }

    void add_primitive(const Shape& shape)
    {
        const std::size_t first = spans_.size();
        if (shape.kind == ShapeKind::Box) add_faces(box_faces(shape));
        if (shape.kind == ShapeKind::Cylinder || shape.kind == ShapeKind::Capsule) add_faces(prism_faces(shape));
        if (shape.kind == ShapeKind::Sphere) add_ball(shape.pose.position, shape.size[0]);
        if (shape.kind == ShapeKind::Capsule)
            for (const double end : {-0.5, 0.5})
                add_ball(shape.pose.position + shape.pose.rotation.col(2) * end * shape.size[1], shape.size[0]);
        join_from(first);
    }

    std::vector<CellSpan> finish()
    {
        std::sort(spans_.begin(), spans_.end(), [](const CellSpan& l, const CellSpan& r) {
            return l.cell != r.cell ? l.cell < r.cell : l.bottom < r.bottom;
        });
        return std::move(spans_);
    }

private:
    void add_faces(const std::vector<Polygon>& faces)
    {
        for (const Polygon& face : faces)
            clipper_.visit_cells(face, [&](int i, int j, double bottom, double top) {
                spans_.push_back({block_.id(i, j), bottom, top});
            });
    }

    /// A ball over a cell reaches as high as over the cell's point nearest to its centre.
    void add_ball(const Vec3& centre, double radius)
    {
        const auto cells = [&](double c, double origin, int count) {
            const double low = std::floor((c - radius - touch_tolerance - origin) / block_.cell - 1e-9);
            const double high = std::floor((c + radius + touch_tolerance - origin) / block_.cell + 1e-9);
            return std::pair{int(std::clamp(low, 0.0, double(count))), int(std::clamp(high, -1.0, double(count - 1)))};
        };
        const auto [i0, i1] = cells(centre.x(), block_.x0, block_.cols);
        const auto [j0, j1] = cells(centre.y(), block_.y0, block_.rows);
        const double reach = radius + touch_tolerance;
        for (int j = j0; j <= j1; ++j)
            for (int i = i0; i <= i1; ++i) {
                const double x = block_.x0 + i * block_.cell, y = block_.y0 + j * block_.cell;
                const double dx = std::max({x - centre.x(), 0.0, centre.x() - x - block_.cell});
                const double dy = std::max({y - centre.y(), 0.0, centre.y() - y - block_.cell});
                const double rest = reach * reach - dx * dx - dy * dy;
                if (rest < 0) continue;
                spans_.push_back({block_.id(i, j), centre.z() - std::sqrt(rest), centre.z() + std::sqrt(rest)});
            }
    }

    void join_from(std::size_t first)
    {
        const auto begin = spans_.begin() + std::ptrdiff_t(first);
        std::sort(begin, spans_.end(), [](const CellSpan& l, const CellSpan& r) { return l.cell < r.cell; });
        auto kept = begin;
        for (auto span = begin; span != spans_.end(); ++span) {
            if (kept != begin && (kept - 1)->cell == span->cell) {
                (kept - 1)->bottom = std::min((kept - 1)->bottom, span->bottom);
                (kept - 1)->top = std::max((kept - 1)->top, span->top);
            } else {
                *kept++ = *span;
            }
        }
        spans_.erase(kept, spans_.end());
    }

    const CellBlock& block_;
    PolygonClipper clipper_;
    Polygon polygon_;
    std::vector<CellSpan> spans_;
};

}  // namespace

std::vector<CellSpan> clip_to_cells(const Geometry& geometry, const CellBlock& block)
{
    SpanCollector collector(block);
    geometry.impl().visit_in(block.x0 - touch_tolerance, block.y0 - touch_tolerance, block.x0 + block.cols * block.cell + touch_tolerance,
                             block.y0 + block.rows * block.cell + touch_tolerance, [&](const Tile& tile, std::uint32_t element) {
                                 if (tile.label(element) == Label::Water) return;
                                 if (tile.is_triangle(element)) collector.add_triangle(tile.corners(element));
                                 else collector.add_primitive(tile.primitive(element).shape());
                             });
    return collector.finish();
}

void join_spans(std::vector<Interval>& spans)
{
    std::sort(spans.begin(), spans.end(), [](const Interval& l, const Interval& r) { return l.bottom < r.bottom; });
    std::size_t kept = 0;
    for (const Interval& next : spans) {
        if (kept > 0 && next.bottom <= spans[kept - 1].top + touch_tolerance)
            spans[kept - 1].top = std::max(spans[kept - 1].top, next.top);
        else spans[kept++] = next;
    }
    spans.resize(kept);
}

std::vector<Interval> solid_intervals(const Column& column)
{
    std::vector<Interval> out;
    for (const Span& span : column.spans) out.push_back({span.bottom, span.top});
    join_spans(out);
    return out;
}

}  // namespace spawnfield

#include "column/cell_clip.h"

#include "base/intervals.h"
#include "base/polygon2.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

constexpr Interval none{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

void extend(Interval& range, double value)
{
    range.bottom = std::min(range.bottom, value);
    range.top = std::max(range.top, value);
}

using Polygon = std::vector<Vec3>;

/// Writes to `out` the part of a convex polygon where sign * (p.y - limit) <= 0.
void clip_y(const Polygon& in, double limit, double sign, Polygon& out)
{
    out.resize(2 * in.size());  // each corner gives at most itself and a cut
    std::size_t count = 0;
    const auto distance = [&](const Vec3& p) { return sign * (p.y() - limit); };
    clip_polygon(in, distance, [&](const auto& p, bool is_cut) {
        Vec3& corner = out[count++];
        corner = p;
        if (is_cut) corner.y() = limit;  // exactly
    });
    out.resize(count);
}

Interval range_of(const Polygon& polygon, int axis)
{
    Interval range = none;
    for (const Vec3& p : polygon) extend(range, p[axis]);
    return range;
}

/// Finds the height range of a convex planar polygon in each cell of a block that it meets.
class PolygonScanner {
public:
    explicit PolygonScanner(const CellBlock& block)
        : block_(block), cells_(std::size_t(block.cols)), borders_(std::size_t(block.cols) + 1)
    {
    }

    /// Calls visit(i, j, range) for each cell that the polygon meets, to touch_tolerance.
    template <class Visit>
    void scan(const Vec3* corners, std::size_t count, const Visit& visit)
    {
        remaining_.assign(corners, corners + count);
        const Interval y = range_of(remaining_, 1);
        const int j0 = first_cell(y.bottom - block_.y0), j1 = last_cell(y.top - block_.y0, block_.rows);
        if (j0 > j1) return;
        if (j0 == 0 && y.bottom < block_.y0 - touch_tolerance) cut_below(block_.y0);
        for (int j = j0; j <= j1 && !remaining_.empty(); ++j) {
            const double upper = block_.y0 + (j + 1) * block_.cell;
            if (y.top > upper + touch_tolerance) {
                clip_y(remaining_, upper + touch_tolerance, 1, strip_);
                if (!strip_.empty()) scan_row(strip_, j, visit);
            } else {
                scan_row(remaining_, j, visit);
            }
            if (j < j1) cut_below(upper);
        }
    }

private:
    void cut_below(double y)
    {
        clip_y(remaining_, y - touch_tolerance, -1, next_);
        remaining_.swap(next_);
    }

    template <class Visit>
    void scan_row(const Polygon& strip, int j, const Visit& visit)
    {
        const Interval x = range_of(strip, 0);
        const int i0 = first_cell(x.bottom - block_.x0), i1 = last_cell(x.top - block_.x0, block_.cols);
        if (i0 > i1) return;
        if (i0 == i1 && x.bottom >= block_.x0 + i0 * block_.cell && x.top <= block_.x0 + (i0 + 1) * block_.cell) {
            visit(i0, j, range_of(strip, 2));
            return;
        }
        // In a cell the polygon is highest and lowest at its corners and where its edges cross the cell's borders.
        std::fill(cells_.begin() + i0, cells_.begin() + i1 + 1, none);
        std::fill(borders_.begin() + i0, borders_.begin() + i1 + 2, none);
        for (std::size_t k = 0; k < strip.size(); ++k) {
            const Vec3 &p = strip[k], &q = strip[k + 1 < strip.size() ? k + 1 : 0];
            add_corner(p, i0, i1);
            add_crossings(p.x() < q.x() ? p : q, p.x() < q.x() ? q : p, i0, i1);
        }
        for (int i = i0; i <= i1; ++i) {
            const Interval &cell = cells_[std::size_t(i)], &left = borders_[std::size_t(i)],
                           &right = borders_[std::size_t(i) + 1];
            const Interval range{std::min({cell.bottom, left.bottom, right.bottom}),
                                 std::max({cell.top, left.top, right.top})};
            if (range.bottom <= range.top) visit(i, j, range);
        }
    }

    void add_corner(const Vec3& p, int i0, int i1)
    {
        const int from = std::max(i0, first_cell(p.x() - block_.x0)),
                  to = std::min(i1, last_cell(p.x() - block_.x0, block_.cols));
        for (int i = from; i <= to; ++i) extend(cells_[std::size_t(i)], p.z());
    }

    void add_crossings(const Vec3& left, const Vec3& right, int i0, int i1)
    {
        const double width = right.x() - left.x();
        if (!(width > 0)) return;
        const auto border = [&](double x) {
            return std::clamp((x - block_.x0) / block_.cell, double(i0) - 1, double(i1) + 2);
        };
        const int from = std::max(i0, int(std::ceil(border(left.x())))),
                  to = std::min(i1 + 1, int(std::floor(border(right.x()))));
        const double slope = (right.z() - left.z()) / width, low = std::min(left.z(), right.z()),
                     high = std::max(left.z(), right.z());
        for (int i = from; i <= to; ++i) {
            const double z = left.z() + (block_.x0 + i * block_.cell - left.x()) * slope;
            extend(borders_[std::size_t(i)], std::clamp(z, low, high));
        }
    }

    int first_cell(double offset) const
    {
        return int(std::clamp(std::floor((offset - touch_tolerance) / block_.cell), 0.0, 1e9));
    }
    int last_cell(double offset, int count) const
    {
        return int(std::clamp(std::floor((offset + touch_tolerance) / block_.cell), -1.0, double(count - 1)));
    }

    const CellBlock& block_;
    Polygon remaining_, next_, strip_;
    std::vector<Interval> cells_, borders_;
};

constexpr double prism_excess = 4e-6;  // m by which a prism may be wider than its cylinder
constexpr int most_sides = 4096;

/// Returns the number of sides for which radius * (1 / cos(pi / sides) - 1) <= prism_excess, but at most most_sides.
int prism_sides(double radius)
{
    const double sides = std::ceil(std::numbers::pi * std::sqrt(radius / (2 * prism_excess)) * 1.01);
    return int(std::clamp(sides, 16.0, double(most_sides)));
}

}  // namespace

class CellSpans::Collector {
public:
    Collector(CellSpans& out, const CellBlock& block) : out_(out), block_(block), scanner_(block) {}

    void add_triangle(const std::array<Vec3, 3>& corners, const double* down_to)
    {
        scanner_.scan(corners.data(), 3, [&](int i, int j, Interval z) {
            if (down_to != nullptr) z.bottom = std::min(z.bottom, *down_to);
            add(block_.id(i, j), z);
        });
    }

    /// Adds a primitive: one interval for each cell, which joins those of its faces, because it is convex.
    void add_primitive(const Shape& shape)
    {
        own_.clear();
        if (shape.kind == ShapeKind::Box) add_box(shape);
        if (shape.kind == ShapeKind::Cylinder || shape.kind == ShapeKind::Capsule) add_prism(shape);
        if (shape.kind == ShapeKind::Sphere) add_ball(shape.pose.position, shape.size[0]);
        if (shape.kind == ShapeKind::Capsule)
            for (const double end : {-0.5, 0.5})
                add_ball(shape.pose.position + shape.pose.rotation.col(2) * end * shape.size[1], shape.size[0]);
        std::sort(own_.begin(), own_.end(), [](const OfCell& l, const OfCell& r) { return l.cell < r.cell; });
        for (std::size_t k = 0; k < own_.size();) {
            const std::uint32_t cell = own_[k].cell;
            Interval z = own_[k].z;
            for (++k; k < own_.size() && own_[k].cell == cell; ++k)
                z = {std::min(z.bottom, own_[k].z.bottom), std::max(z.top, own_[k].z.top)};
            add(cell, z);
        }
    }

private:
    struct OfCell {
        std::uint32_t cell;
        Interval z;
    };

    void add(std::uint32_t cell, const Interval& z)
    {
        Interval& first = out_.first_[cell];
        if (first.bottom > first.top) {
            first = z;
        } else if (z.bottom <= first.top + touch_tolerance && first.bottom <= z.top + touch_tolerance) {
            first = {std::min(first.bottom, z.bottom), std::max(first.top, z.top)};
        } else {
            std::uint32_t& last = out_.last_[cell];
            out_.further_.push_back({z, last});
            last = std::uint32_t(out_.further_.size() - 1);
        }
    }

    void add_face(const Polygon& face)
    {
        scanner_.scan(face.data(), face.size(), [&](int i, int j, const Interval& z) {
            own_.push_back({block_.id(i, j), z});
        });
    }

    void add_box(const Shape& shape)
    {
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-0.5, 0.5}) {
                face_.clear();
                for (const auto& [u, v] :
                     {std::pair{-0.5, -0.5}, std::pair{0.5, -0.5}, std::pair{0.5, 0.5}, std::pair{-0.5, 0.5}}) {
                    Vec3 corner;
                    corner[axis] = side * shape.size[axis];
                    corner[(axis + 1) % 3] = u * shape.size[(axis + 1) % 3];
                    corner[(axis + 2) % 3] = v * shape.size[(axis + 2) % 3];
                    face_.push_back(shape.pose.rotation * corner + shape.pose.position);
                }
                add_face(face_);
            }
    }

    /// Adds the prism around a cylinder, or around the straight part of a capsule.
    void add_prism(const Shape& shape)
    {
        const int sides = prism_sides(shape.size[0]);
        if (sides == most_sides) out_.tight_ = false;
        const double radius = shape.size[0] / std::cos(std::numbers::pi / sides), half = shape.size[1] / 2;
        Polygon low, high;
        for (int side = 0; side < sides; ++side) {
            const double angle = 2 * std::numbers::pi * side / sides;
            const double x = radius * std::cos(angle), y = radius * std::sin(angle);
            low.push_back(shape.pose.rotation * Vec3(x, y, -half) + shape.pose.position);
            high.push_back(shape.pose.rotation * Vec3(x, y, half) + shape.pose.position);
        }
        for (std::size_t side = 0; side < low.size(); ++side) {
            const std::size_t next = side + 1 < low.size() ? side + 1 : 0;
            face_ = {low[side], low[next], high[next], high[side]};
            add_face(face_);
        }
        add_face(low);
        add_face(high);
    }

    /// Adds a ball. In each cell it is as high as at the cell's point that is nearest to the ball's centre.
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
                const double half_squared = reach * reach - dx * dx - dy * dy;
                if (half_squared < 0) continue;
                own_.push_back(
                    {block_.id(i, j), {centre.z() - std::sqrt(half_squared), centre.z() + std::sqrt(half_squared)}});
            }
    }

    CellSpans& out_;
    const CellBlock& block_;
    PolygonScanner scanner_;
    std::vector<OfCell> own_;  ///< of one primitive
    Polygon face_;
};

CellSpans::CellSpans(const Geometry& geometry, const CellBlock& block)
    : first_(std::size_t(block.cols) * std::size_t(block.rows), none), last_(first_.size(), nothing)
{
    Collector collector(*this, block);
    geometry.impl().visit_in(
        {block.x0 - touch_tolerance, block.y0 - touch_tolerance, block.x0 + block.cols * block.cell + touch_tolerance,
         block.y0 + block.rows * block.cell + touch_tolerance},
        [&](const Tile& tile, std::uint32_t element) {
            if (tile.label(element) == Label::Water) return;
            if (!tile.is_triangle(element)) {
                collector.add_primitive(tile.primitive(element).shape());
                return;
            }
            const TilePiece& piece = tile.piece(element);
            collector.add_triangle(tile.corners(element), piece.open != 0 ? &piece.bottom : nullptr);
        });
}

void CellSpans::get(std::uint32_t cell, std::vector<Interval>& out) const
{
    out.clear();
    if (first_[cell].bottom > first_[cell].top) return;
    out.push_back(first_[cell]);
    if (!has_more(cell)) return;
    for (std::uint32_t k = last_[cell]; k != nothing; k = further_[k].previous) out.push_back(further_[k].z);
    join_intervals(out, touch_tolerance);
}

std::vector<Interval> solid_intervals(const ColumnView& column)
{
    std::vector<Interval> out;
    for (const Span& span : column.spans) out.push_back({span.bottom, span.top});
    join_intervals(out, touch_tolerance);
    return out;
}

}  // namespace spawnfield

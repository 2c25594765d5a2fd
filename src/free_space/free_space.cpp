#include "base/bits.h"
#include "base/rotation.h"
#include "free_space/mask.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace spawnfield {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Return the same as std::floor and std::ceil, but faster. The value must fit an int.
int floor_of(double value)
{
    const int whole = int(value);
    return whole - (double(whole) > value);
}
int ceil_of(double value) { return -floor_of(-value); }

/// Returns the cells that meet a range, which counts in cells.
CellRange cells_around(double low, double high) { return {floor_of(low), floor_of(high)}; }
/// Returns the cells that are completely inside it.
CellRange cells_inside(double low, double high) { return {ceil_of(low), floor_of(high) - 1}; }

/// Returns the largest quantized height of a tile that is below z; 0 if there is none.
std::uint32_t values_below(const BoundsTile& tile, double inverse_quantum, double z)
{
    return std::uint32_t(std::max(0, ceil_of(std::clamp((z - tile.base) * inverse_quantum, 0.0, 65536.0)) - 1));
}

/// Returns the lowest interval of a cell for which the test is true; nullptr if there is none. If the test is true for
/// an interval, it must be true for all intervals above it.
template <class Test>
const QuantizedSpan* lowest_where(std::span<const QuantizedSpan> spans, const Test& test)
{
    constexpr std::size_t few = 8;
    const auto lowest = spans.size() <= few
                            ? std::find_if(spans.begin(), spans.end(), test)
                            : std::partition_point(spans.begin(), spans.end(),
                                                   [&](const QuantizedSpan& span) { return !test(span); });
    return lowest == spans.end() ? nullptr : &*lowest;
}

/// Values of 16 neighbouring cells of a row of a tile, in two registers. The type is an extension of GCC and clang.
class Sixteen {
public:
    static constexpr int width = 16;

    /// Raises each value to that of a cell; `cells` has 16.
    void raise(const std::uint16_t* cells)
    {
        std::array<Eight, 2> by;
        std::memcpy(&by, cells, sizeof by);
        for (std::size_t half = 0; half < 2; ++half)
            values_[half] = values_[half] > by[half] ? values_[half] : by[half];
    }

    /// Returns a bit for each value in the range low .. high.
    std::uint64_t bits_within(std::uint32_t low, std::uint32_t high) const
    {
        constexpr Eight bits_of_first{1, 2, 4, 8, 16, 32, 64, 128}, bits_of_second = bits_of_first << 8;
        high = std::min<std::uint32_t>(high, 65535);
        if (low > high) return 0;
        const auto from = std::uint16_t(low), range = std::uint16_t(high - low);
        const Eight marks = ((values_[0] - from <= range) & bits_of_first) |  // differences are modulo 65536
                            ((values_[1] - from <= range) & bits_of_second);
        std::array<std::uint64_t, 2> fours;
        std::memcpy(&fours, &marks, sizeof fours);
        std::uint64_t bits = fours[0] | fours[1];
        bits |= bits >> 32;
        bits |= bits >> 16;
        return bits & 0xffff;
    }

private:
    using Eight = std::uint16_t __attribute__((vector_size(16)));
    std::array<Eight, 2> values_{};
};

/// Returns the rectangle around a polygon, along the axes.
Rect rectangle_around(const Polygon2& polygon)
{
    Rect out{inf, inf, -inf, -inf};
    for (const Vec2& corner : polygon)
        out = {std::min(out.low_x, corner.x()), std::min(out.low_y, corner.y()), std::max(out.high_x, corner.x()),
               std::max(out.high_y, corner.y())};
    return out;
}

/// Returns whether a polygon is a rectangle whose sides are parallel to the axes.
bool is_rectangle(const Polygon2& polygon)
{
    if (polygon.size() != 4) return false;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec2 &p = polygon[k], &q = polygon[(k + 1) % 4];
        if ((p.x() == q.x()) == (p.y() == q.y())) return false;
    }
    return true;
}

/// The number of cells along a part's width in each pass. The first pass is a quick look at the surroundings. The
/// second one follows the part's shape. The third one is the finest that is still cheaper than an exact check.
constexpr std::array cells_along{1.4, 6.0, 24.0};

}  // namespace

void Mask::set_footprints(const std::vector<Footprint>& footprints, double cosine, double sine)
{
    const auto turn = [&](const Polygon2& from, Polygon2& to) {
        to.resize(from.size());
        for (std::size_t k = 0; k < from.size(); ++k)
            to[k] = {cosine * from[k].x() - sine * from[k].y(), sine * from[k].x() + cosine * from[k].y()};
    };
    parts_.resize(footprints.size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        Footprint& to = parts_[p].footprint;
        turn(footprints[p].outer.polygon, to.outer.polygon);
        turn(footprints[p].inner.polygon, to.inner.polygon);
        to.outer.bottom = footprints[p].outer.bottom;
        to.outer.top = footprints[p].outer.top;
        to.inner.bottom = footprints[p].inner.bottom;
        to.inner.top = footprints[p].inner.top;
        parts_[p].is_around_origin = contains(to.inner.polygon, Vec2::Zero());
        parts_[p].reach = rectangle_around(to.outer.polygon);
        parts_[p].core.reset();
        if (is_rectangle(to.outer.polygon) && is_rectangle(to.inner.polygon))
            parts_[p].core = rectangle_around(to.inner.polygon);
        choose_passes(parts_[p]);
    }
}

void Mask::set_rotation(double yaw) { set_footprints(space_.ahead, std::cos(yaw), std::sin(yaw)); }
void Mask::set_every_yaw() { set_footprints(space_.every_yaw, 1, 0); }
void Mask::set_rotation(const Mat3& rotation)
{
    if (rotation(2, 2) == 1)
        set_rotation(yaw_of(rotation));
    else
        set_footprints(footprints(space_.robot, rotation, false), 1, 0);
}

/// Chooses a raster level for each pass: the one with the largest cells of which at least cells_along lie along the
/// part's width, or else the finest level. A pass with the same level as the one before is left out.
void Mask::choose_passes(Part& part) const
{
    const Rect& reach = part.reach;
    const double width = std::min(reach.high_x - reach.low_x, reach.high_y - reach.low_y);
    std::size_t count = 0;
    for (const double cells : cells_along) {
        std::size_t level = 0;
        while (level + 1 < raster_.levels().size() && raster_.levels()[level + 1].cell * cells <= width) ++level;
        if (raster_.levels().empty() || (count > 0 && part.passes[count - 1].level == level)) continue;
        if (part.passes.size() <= count) part.passes.emplace_back();
        if (part.passes[count].level != level) part.passes[count].tiles = {};
        part.passes[count].level = level;
        if (!raster_.levels().empty())
            part.passes[count].window = int(std::floor((reach.high_x - reach.low_x) / raster_.levels()[level].cell)) +
                                        1;
        part.passes[count].is_ready = false;
        ++count;
    }
    part.passes.resize(count);
}

void Mask::set_y(double y)
{
    y_ = y;
    for (Part& part : parts_)
        for (Pass& pass : part.passes) pass.is_ready = false;
}

/// Computes the rows of cells that the part covers at the current y: for each row, the range in x that the outer
/// polygon overlaps, and the range in which cells lie completely inside the inner polygon. Both follow from the corners
/// of the polygons and from the points at which their edges cross the lines between rows.
void Mask::cover(const Part& part, Pass& pass) const
{
    const double cell = raster_.levels()[pass.level].cell, v = (y_ - raster_.y0) / cell;
    const auto visit_rim = [&](const Polygon2& polygon, const auto& on_corner, const auto& on_line) {
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const Vec2 p = polygon[k] / cell, q = polygon[k + 1 < polygon.size() ? k + 1 : 0] / cell;
            on_corner(p.x(), int(std::floor(v + p.y())));
            const Vec2 &low = p.y() < q.y() ? p : q, &high = p.y() < q.y() ? q : p;
            const double rise = high.y() - low.y();
            if (!(rise > 0)) continue;
            const int from = int(std::ceil(v + low.y())), to = int(std::floor(v + high.y()));
            for (int line = from; line <= to; ++line)
                on_line(low.x() + std::clamp((line - v - low.y()) / rise, 0.0, 1.0) * (high.x() - low.x()), line);
        }
    };
    if (part.core) return cover_rectangle(part, pass);
    const Polygon2& outer = part.footprint.outer.polygon;
    const int first = int(std::floor(v + part.reach.low_y / cell)),
              last = int(std::floor(v + part.reach.high_y / cell));
    pass.rows.assign(std::size_t(last - first + 1), {0, inf, -inf, inf, -inf});
    pass.undecided.resize(pass.rows.size());
    for (int row = first; row <= last; ++row) pass.rows[std::size_t(row - first)].row = row;
    const auto extend = [&](double x, int row) {
        if (row < first || row > last) return;
        CoverRow& cells = pass.rows[std::size_t(row - first)];
        cells.low = std::min(cells.low, x);
        cells.high = std::max(cells.high, x);
    };
    visit_rim(outer, extend, [&](double x, int line) {
        extend(x, line - 1);
        extend(x, line);
    });
    if (!part.footprint.inner.polygon.empty()) {
        // For each line between rows, first .. last + 1: where it enters and leaves the inner polygon.
        thread_local std::vector<std::array<double, 2>> lines;
        lines.assign(pass.rows.size() + 1, {inf, -inf});
        visit_rim(
            part.footprint.inner.polygon, [](double, int) {},
            [&](double x, int line) {
                if (line < first || line > last + 1) return;
                auto& [from, to] = lines[std::size_t(line - first)];
                from = std::min(from, x);
                to = std::max(to, x);
            });
        for (std::size_t k = 0; k < pass.rows.size(); ++k) {
            pass.rows[k].inner_low = std::max(lines[k][0], lines[k + 1][0]);
            pass.rows[k].inner_high = std::min(lines[k][1], lines[k + 1][1]);
        }
    }
    pass.is_ready = true;
}

/// Does the same for a part whose polygons are rectangles along the axes. All of its rows have the same range.
void Mask::cover_rectangle(const Part& part, Pass& pass) const
{
    const double cell = raster_.levels()[pass.level].cell, v = (y_ - raster_.y0) / cell;
    const Rect &reach = part.reach, &core = *part.core;
    const int first = floor_of(v + reach.low_y / cell), last = floor_of(v + reach.high_y / cell),
              first_line = ceil_of(v + core.low_y / cell), last_line = floor_of(v + core.high_y / cell);
    const CoverRow rim{0, reach.low_x / cell, reach.high_x / cell, inf, -inf},
        whole{0, rim.low, rim.high, core.low_x / cell, core.high_x / cell};
    pass.rows.resize(std::size_t(last - first + 1));
    pass.undecided.resize(pass.rows.size());
    for (int row = first; row <= last; ++row) {
        CoverRow& cells = pass.rows[std::size_t(row - first)];
        cells = row >= first_line && row < last_line ? whole : rim;
        cells.row = row;
    }
    pass.is_ready = true;
}

/// Returns tile (col, row) of the pass's level. Up to four adjacent tiles stay open, because a part may lie on the
/// corner of four tiles.
Mask::OpenTile& Mask::tile_of(Pass& pass, std::uint32_t col, std::uint32_t row) const
{
    OpenTile& open = pass.tiles[row % 2 * 2 + col % 2];
    if (col != open.col || row != open.row) open_tile(pass.level, col, row, open);
    return open;
}

void Mask::open_tile(std::size_t level, std::uint32_t col, std::uint32_t row, OpenTile& out) const
{
    out.col = out.row = OpenTile::none;  // remains so if open() throws because the tile is damaged
    out.tile = raster_.open(level, col, row);
    out.inverse_quantum = out.tile.is_empty() ? 0 : 1 / out.tile.quantum;
    out.col = col;
    out.row = row;
    out.rows = no_cells;
    if (out.tile.is_empty()) out.whole = {};
}

/// Sets all that follows for these rows of the tile, and for windows of so many columns. Does nothing if it has been
/// set for them already: poses of one row of a raster share it.
void Mask::OpenTile::set_rows(const CellRange& all, int wide, const CellRange& inner, int inner_wide)
{
    if (tile.is_empty() || (all == rows && inner == core_rows && wide == whole.wide() && inner_wide == core.wide()))
        return;
    rows = all;
    core_rows = inner;
    RowMaxima::Values maxima{};
    const auto raise = [&](int from, int to) {
        for (int r = from; r <= to; ++r) {
            const std::uint16_t* const tops = tile.tops + r * int(BoundsTile::side);
            for (std::size_t c = 0; c < BoundsTile::side; ++c) maxima[c] = maxima[c] < tops[c] ? tops[c] : maxima[c];
        }
    };
    if (inner.first <= inner.last) {
        raise(inner.first, inner.last);
        core.set(maxima, inner_wide);
        raise(all.first, inner.first - 1);
        raise(inner.last + 1, all.last);
    } else {
        if (inner != no_cells) core.set({}, inner_wide);
        raise(all.first, all.last);
    }
    whole.set(maxima, wide);
    listed = filled = 0;
    for (auto r = std::uint32_t(all.first); r <= std::uint32_t(all.last); ++r) {
        listed |= tile.bounds.marks_of(r);
        filled |= tile.solids.marks_of(r);
    }
    has_gaps = false;
}

/// Sets `floors` and `ceilings` for `rows`.
void Mask::OpenTile::set_gaps()
{
    RowMaxima::Values high_floors{}, low_ceilings;
    low_ceilings.fill(std::numeric_limits<std::uint16_t>::max());
    for (auto r = std::uint32_t(rows.first); r <= std::uint32_t(rows.last); ++r) {
        RowMaxima::Values lowest;
        std::copy_n(tile.tops + r * BoundsTile::side, BoundsTile::side, lowest.begin());
        tile.bounds.visit_row(r, [&](std::uint32_t c, std::span<const QuantizedSpan> spans) {
            lowest[c] = spans[0].top;
            if (spans.size() > 1) low_ceilings[c] = std::min(low_ceilings[c], spans[1].bottom);
        });
        for (std::size_t c = 0; c < BoundsTile::side; ++c)
            high_floors[c] = high_floors[c] < lowest[c] ? lowest[c] : high_floors[c];
    }
    has_gaps = true;
    floors = high_floors;
    ceilings = low_ceilings;
}

/// Looks at these columns, which count from the tile's first one, in `rows`, for what lies between two heights, m.
/// Columns beyond the tile do not count.
Mask::Surroundings Mask::OpenTile::around(const CellRange& cols, double bottom, double top)
{
    if (are_below(whole.highest(cols.first, cols.last), bottom)) return Surroundings::Clear;
    const CellRange here = cols.in_tile(0);
    if ((listed & bits_between(here.first, here.last)) == 0) return Surroundings::Plain;
    if (!has_gaps) set_gaps();
    const auto end = here.last + 1;
    const std::uint16_t ceiling = *std::min_element(ceilings.begin() + here.first, ceilings.begin() + end),
                        floor = *std::max_element(floors.begin() + here.first, floors.begin() + end);
    return tile.height(ceiling) > top && are_below(floor, bottom) ? Surroundings::Clear : Surroundings::Layered;
}

/// Looks at the rectangle of coarse cells around the part at each pose (x[i], y, z[i]) whose z[i] is not NaN. A pose
/// whose cells are not known, or lie in too many columns, is Plain.
void Mask::look_around(const Part& part, Pass& pass, std::span<const double> x, double y, std::span<const double> z,
                       std::span<Surroundings> out) const
{
    constexpr int side = BoundsTile::side;
    const double per_cell = 1 / raster_.levels()[pass.level].cell;
    // Copies, because the compiler cannot know that writing to `out` does not change them.
    const Rect reach = part.reach;
    const double x0 = raster_.x0, lowest = part.footprint.outer.bottom;
    const CellRange rows = cells_around((y - raster_.y0 + reach.low_y) * per_cell,
                                        (y - raster_.y0 + reach.high_y) * per_cell);
    const int known_cols = int(raster_.whole_cols(pass.level)), window = pass.window;
    const bool is_known = rows.first >= 0 && rows.last < int(raster_.whole_rows(pass.level)) &&
                          window <= RowMaxima::widest;
    std::fill(out.begin(), out.end(), is_known ? Surroundings::Clear : Surroundings::Plain);
    if (!is_known) return;
    for (int tile_row = rows.first / side; tile_row <= rows.last / side; ++tile_row) {
        OpenTile* open = nullptr;
        int tile_col = -1;  // of `open`
        const auto set_tile = [&](int col) {
            if (col == tile_col) return;
            open = &tile_of(pass, std::uint32_t(col), std::uint32_t(tile_row));
            open->set_rows(rows.in_tile(tile_row * side), window);
            tile_col = col;
        };
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double from_left = x[i] - x0, bottom = z[i] + lowest;
            const CellRange cols = cells_around((from_left + reach.low_x) * per_cell,
                                                (from_left + reach.high_x) * per_cell);
            if (cols.first < 0 || cols.last >= known_cols) {
                out[i] = Surroundings::Plain;
                continue;
            }
            set_tile(cols.first / side);
            const CellRange here = cols.from(tile_col * side);
            if (here.last < side && open->are_below(open->whole.highest(here.first, here.last), bottom))
                continue;  // most poses
            if (out[i] != Surroundings::Clear || std::isnan(z[i])) continue;
            const double top = z[i] + part.footprint.outer.top;
            for (int col = tile_col; out[i] == Surroundings::Clear && col <= cols.last / side; ++col) {
                set_tile(col);
                out[i] = open->around(cols.from(col * side), bottom, top);
            }
        }
    }
}

/// Returns what look_around() finds for one pose. It looks at the cells of this pose only.
Mask::Surroundings Mask::surroundings_of(const Part& part, Pass& pass, const Vec3& position) const
{
    constexpr int side = BoundsTile::side;
    const double per_cell = 1 / raster_.levels()[pass.level].cell, x = position.x() - raster_.x0,
                 y = position.y() - raster_.y0, bottom = position.z() + part.footprint.outer.bottom,
                 top = position.z() + part.footprint.outer.top;
    const Rect& reach = part.reach;
    const CellRange cols = cells_around((x + reach.low_x) * per_cell, (x + reach.high_x) * per_cell),
                    rows = cells_around((y + reach.low_y) * per_cell, (y + reach.high_y) * per_cell);
    if (rows.first < 0 || rows.last >= int(raster_.whole_rows(pass.level)) || cols.first < 0 ||
        cols.last >= int(raster_.whole_cols(pass.level)))
        return Surroundings::Plain;
    for (int row = rows.first / side * side; row <= rows.last; row += side)
        for (int col = cols.first / side * side; col <= cols.last; col += side) {
            const OpenTile& open = tile_of(pass, std::uint32_t(col / side), std::uint32_t(row / side));
            if (open.tile.is_empty()) continue;
            const Surroundings found = surroundings_in(open, cols.in_tile(col), rows.in_tile(row), bottom, top);
            if (found != Surroundings::Clear) return found;
        }
    return Surroundings::Clear;
}

/// The same for these cells of one tile.
Mask::Surroundings Mask::surroundings_in(const OpenTile& open, const CellRange& cols, const CellRange& rows,
                                         double bottom, double top)
{
    const BoundsTile& tile = open.tile;
    const auto visit_cells = [&](const auto& visit) {
        for (int row = rows.first; row <= rows.last; ++row)
            for (int col = cols.first; col <= cols.last; ++col)
                visit(std::uint32_t(row) * BoundsTile::side + std::uint32_t(col));
    };
    std::uint16_t highest = 0;
    visit_cells([&](std::uint32_t cell) { highest = std::max(highest, tile.tops[cell]); });
    if (open.are_below(highest, bottom)) return Surroundings::Clear;
    std::uint64_t listed = 0;
    for (int row = rows.first; row <= rows.last; ++row) listed |= tile.bounds.marks_of(std::uint32_t(row));
    if ((listed & bits_between(cols.first, cols.last)) == 0) return Surroundings::Plain;
    std::uint16_t floor = 0, ceiling = std::numeric_limits<std::uint16_t>::max();
    visit_cells([&](std::uint32_t cell) {
        if (!tile.bounds.has(cell)) {
            floor = std::max(floor, tile.tops[cell]);
            return;
        }
        const std::span<const QuantizedSpan> spans = tile.bounds.of(cell);
        floor = std::max(floor, spans[0].top);
        if (spans.size() > 1) ceiling = std::min(ceiling, spans[1].bottom);
    });
    return tile.height(ceiling) > top && open.are_below(floor, bottom) ? Surroundings::Clear : Surroundings::Layered;
}

/// The heights of a part at a pose, in m and as quantized heights of the current tile.
struct Mask::Heights {
    double bottom, top, inner_bottom, inner_top;  ///< of the outer and the inner prism, m
    std::uint32_t below = 0;                      ///< cells whose top is at most this value are below the part
    std::uint32_t hit_low = 1, hit_high = 0;      ///< an upper end in this range means a hit inside the part

    void set_tile(const BoundsTile& tile, double inverse_quantum)
    {
        const auto value = [&](double z) { return std::clamp((z - tile.base) * inverse_quantum, 0.0, 65536.0); };
        below = values_below(tile, inverse_quantum, bottom);
        hit_low = std::uint32_t(std::max(1, ceil_of(value(inner_bottom + tile.slack))));
        hit_high = std::uint32_t(floor_of(value(inner_top)));
    }
    bool is_hit(std::uint32_t value) const { return value >= hit_low && value <= hit_high; }
};

/// Returns whether something in the cell is certainly inside the part. The cell must lie completely inside the inner
/// polygon.
bool Mask::is_hit(const BoundsTile& tile, std::uint32_t cell, const Heights& heights)
{
    if (heights.is_hit(tile.tops[cell])) return true;
    if (tile.bounds.has(cell)) {
        const QuantizedSpan* top = lowest_where(tile.bounds.of(cell),
                                                [&](const QuantizedSpan& span) { return span.top >= heights.hit_low; });
        if (top != nullptr && heights.is_hit(top->top)) return true;
    }
    if (!tile.solids.has(cell)) return false;
    const QuantizedSpan* solid = lowest_where(
        tile.solids.of(cell), [&](const QuantizedSpan& span) { return tile.height(span.top) >= heights.inner_bottom; });
    return solid != nullptr && tile.height(solid->bottom) <= heights.inner_top;
}

/// Returns whether nothing in the cell lies between the part's lowest and highest point. The top of the cell must be
/// above the part's lowest point.
bool Mask::is_free(const BoundsTile& tile, std::uint32_t cell, const Heights& heights)
{
    if (!tile.bounds.has(cell)) return false;
    const QuantizedSpan* span = lowest_where(
        tile.bounds.of(cell), [&](const QuantizedSpan& s) { return tile.height(s.top) >= heights.bottom; });
    return span == nullptr || tile.height(span->bottom) > heights.top;
}

/// Returns the cells of a row that a part covers and that the coarser pass (if there is one) did not prove free. `u` is
/// the x of the pose, in cells from the raster's left edge.
CellRange Mask::open_cells(const Pass& pass, const CoverRow& cover, const Pass* coarser, double u)
{
    if (!(cover.low <= cover.high)) return no_cells;
    CellRange out{floor_of(u + cover.low), floor_of(u + cover.high)};
    if (coarser == nullptr) return out;
    const std::size_t finer = coarser->level - pass.level;
    const int row = (cover.row >> finer) - coarser->rows.front().row;
    if (row < 0 || row >= int(coarser->rows.size()))
        return no_cells;  // rounding: only the margin around the part touches this row
    const CellRange& range = coarser->undecided[std::size_t(row)];
    if (range.first > range.last) return no_cells;
    return {std::max(out.first, range.first << finer), std::min(out.last, (range.last << finer) + (1 << finer) - 1)};
}

/// Returns the pass that follows the part's shape.
Mask::Pass& Mask::second_pass(Part& part) { return part.passes[part.passes.size() > 1 ? 1 : 0]; }

/// Looks at the cells around a part and at those inside it, in the rows that set_rows() got. The columns count from the
/// tile's first one. Returns Found bits.
std::uint8_t Mask::OpenTile::look_closer(const CellRange& cols, const CellRange& core_cols, const Footprint& part,
                                         double z) const
{
    if (are_below(whole.highest(cols.first, cols.last), z + part.outer.bottom)) return 0;
    const CellRange here = cols.in_tile(0), core_here = core_cols.in_tile(0);
    std::uint8_t out = Above;
    if (((listed | filled) & bits_between(here.first, here.last)) != 0) out |= Undecided;
    if (core_here.count() <= 0) return out;
    const std::uint16_t top = core.highest(core_cols.first, core_cols.last);
    const auto value = [&](double height) { return (height - tile.base) * inverse_quantum; };
    if (top > value(z + part.inner.top)) return out | Undecided;
    return top > 0 && top >= value(z + part.inner.bottom + tile.slack) ? out | Inside : out;
}

/// Does for a whole row of poses what proof_of_rectangle() does for one of them: changes Plain to Clear, Hit or Unclear
/// where the cells of this pass decide. Poses that lie near each other share the maxima of the cells. Does nothing if
/// they are so far apart that it would take longer.
void Mask::look_closer(const Part& part, Pass& pass, std::span<const double> x, double y, std::span<const double> z,
                       std::span<Surroundings> out)
{
    constexpr int side = BoundsTile::side;
    constexpr double fewest = 2;  // poses for each tile
    const double per_cell = 1 / raster_.levels()[pass.level].cell, up = y - raster_.y0,
                 tiles = (x.back() - x.front()) * per_cell / side + 1;
    if (double(std::count(out.begin(), out.end(), Surroundings::Plain)) < fewest * tiles) return;
    const Rect reach = part.reach, core = *part.core;
    const CellRange rows = cells_around((up + reach.low_y) * per_cell, (up + reach.high_y) * per_cell),
                    core_rows = cells_inside((up + core.low_y) * per_cell, (up + core.high_y) * per_cell);
    if (pass.window > RowMaxima::widest || rows.first < 0 || rows.last >= int(raster_.whole_rows(pass.level))) return;
    const int wide = pass.window, core_wide = std::max(1, int((core.high_x - core.low_x) * per_cell) - 1),
              known_cols = int(raster_.whole_cols(pass.level));
    const auto fits = [](const CellRange& range, int window) {  // does not only if the last bit of a number decides
        return range.count() == window || range.count() == window + 1;
    };
    found_.assign(x.size(), &pass == &part.passes.back() ? 0 : Undecided);
    for (int tile_row = rows.first / side; tile_row <= rows.last / side; ++tile_row) {
        OpenTile* open = nullptr;
        int tile_col = -1;  // of `open`
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (out[i] != Surroundings::Plain) continue;
            const double right = x[i] - raster_.x0;
            const CellRange cols = cells_around((right + reach.low_x) * per_cell, (right + reach.high_x) * per_cell),
                            core_cols = cells_inside((right + core.low_x) * per_cell, (right + core.high_x) * per_cell);
            if (cols.first < 0 || cols.last >= known_cols || !fits(cols, wide) ||
                (core_cols.count() > 0 && !fits(core_cols, core_wide))) {
                found_[i] = Above | Undecided;
                continue;
            }
            for (int col = cols.first / side; col <= cols.last / side; ++col) {
                if (col != tile_col) {
                    open = &tile_of(pass, std::uint32_t(col), std::uint32_t(tile_row));
                    tile_col = col;
                    open->set_rows(rows.in_tile(tile_row * side), wide, core_rows.in_tile(tile_row * side), core_wide);
                }
                found_[i] |= open->look_closer(cols.from(col * side), core_cols.from(col * side), part.footprint, z[i]);
            }
        }
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (out[i] != Surroundings::Plain || std::isnan(z[i])) continue;
        if ((found_[i] & Above) == 0)
            out[i] = Surroundings::Clear;
        else if ((found_[i] & Inside) != 0)
            out[i] = Surroundings::Hit;
        else if ((found_[i] & Undecided) == 0)
            out[i] = Surroundings::Unclear;
    }
}

/// Looks at all cells under a rectangular part at once: the highest cell of each column decides. Returns nothing if the
/// cells must be examined one by one, because some have several intervals, or are above the part, or are not known.
std::optional<Proof> Mask::proof_of_rectangle(const Part& part, Pass& pass, const Vec3& position) const
{
    constexpr int side = BoundsTile::side;
    const double per_cell = 1 / raster_.levels()[pass.level].cell, x = position.x() - raster_.x0,
                 y = position.y() - raster_.y0, z = position.z();
    const Rect &reach = part.reach, &core = *part.core;
    const CellRange cols = cells_around((x + reach.low_x) * per_cell, (x + reach.high_x) * per_cell),
                    rows = cells_around((y + reach.low_y) * per_cell, (y + reach.high_y) * per_cell),
                    core_cols = cells_inside((x + core.low_x) * per_cell, (x + core.high_x) * per_cell),
                    core_rows = cells_inside((y + core.low_y) * per_cell, (y + core.high_y) * per_cell);
    if (cols.first < 0 || cols.last >= int(raster_.whole_cols(pass.level)) || rows.first < 0 ||
        rows.last >= int(raster_.whole_rows(pass.level)))
        return std::nullopt;
    Heights heights{.bottom = z + part.footprint.outer.bottom,
                    .top = z + part.footprint.outer.top,
                    .inner_bottom = z + part.footprint.inner.bottom,
                    .inner_top = z + part.footprint.inner.top};
    bool is_free = true, is_decided = true;
    for (int bottom = rows.first / side * side; bottom <= rows.last; bottom += side)
        for (int left = cols.first / side * side; left <= cols.last; left += side) {
            const OpenTile& open = tile_of(pass, std::uint32_t(left / side), std::uint32_t(bottom / side));
            const BoundsTile& tile = open.tile;
            if (tile.is_empty()) continue;
            heights.set_tile(tile, open.inverse_quantum);
            // All that follows counts from the tile's first column and row.
            const CellRange c = cols.in_tile(left), r = rows.in_tile(bottom), inner_c = core_cols.in_tile(left),
                            inner_r = core_rows.in_tile(bottom);
            std::uint64_t above = 0, hit = 0, beyond = 0;
            for (int next = c.first; next <= c.last; next += Sixteen::width) {
                const int first = std::min(next, side - Sixteen::width);
                const auto highest = [&](Sixteen of, int from, int to) {
                    for (int row = from; row <= to; ++row) of.raise(tile.tops + row * side + first);
                    return of;
                };
                const Sixteen inner = highest({}, inner_r.first, inner_r.last);
                const Sixteen all = inner_r.first <= inner_r.last
                                        ? highest(highest(inner, r.first, inner_r.first - 1), inner_r.last + 1, r.last)
                                        : highest({}, r.first, r.last);
                above |= all.bits_within(heights.below + 1, 65535) << first;
                hit |= inner.bits_within(heights.hit_low, heights.hit_high) << first;
                beyond |= inner.bits_within(heights.hit_high + 1, 65535) << first;
            }
            above &= bits_between(c.first, c.last);
            const std::uint64_t inside = bits_between(inner_c.first, inner_c.last);
            if ((hit & inside) != 0) return Proof::Blocked;
            if (above == 0) continue;
            is_free = false;
            std::uint64_t listed = beyond & inside;
            if (tile.bounds.marks == nullptr && tile.solids.marks == nullptr) {
                is_decided = is_decided && (listed & above) == 0;
                continue;
            }
            for (int row = r.first; row <= r.last; ++row)
                listed |= tile.bounds.marks_of(std::uint32_t(row)) | tile.solids.marks_of(std::uint32_t(row));
            is_decided = is_decided && (listed & above) == 0;
        }
    if (is_free) return Proof::Free;
    return is_decided && &pass == &part.passes.back() ? std::optional(Proof::Candidate) : std::nullopt;
}

/// Looks at each cell that open_cells() returns. The proof is Blocked if something in a cell is certainly inside the
/// part, Free if every cell is free, and otherwise Candidate. Then pass.undecided has the cells for the next, finer
/// pass.
Proof Mask::proof_of(const Part& part, Pass& pass, const Pass* coarser, double x, double z) const
{
    const TileLevel& level = raster_.levels()[pass.level];
    const Footprint& footprint = part.footprint;
    const bool has_inner = !footprint.inner.polygon.empty();
    Heights heights{.bottom = z + footprint.outer.bottom,
                    .top = z + footprint.outer.top,
                    .inner_bottom = z + footprint.inner.bottom,
                    .inner_top = z + footprint.inner.top};
    const double u = (x - raster_.x0) / level.cell;
    const int known_cols = int(raster_.whole_cols(pass.level)), known_rows = int(raster_.whole_rows(pass.level));
    bool nothing_near = true;
    constexpr int side = BoundsTile::side;
    const OpenTile* open = nullptr;
    for (std::size_t n = 0; n < pass.rows.size(); ++n) {
        const std::size_t middle = pass.rows.size() / 2,
                          k = n % 2 == 0
                                  ? middle + n / 2
                                  : middle - (n + 1) / 2;  // from the middle row outwards, which finds hits sooner
        const CoverRow& cover = pass.rows[k];
        CellRange& undecided = pass.undecided[k];
        undecided = no_cells;
        const auto [low, high] = open_cells(pass, cover, coarser, u);
        if (low > high) continue;
        const auto leave = [&](int from, int to) {
            nothing_near = false;
            undecided = {std::min(undecided.first, from), std::max(undecided.last, to)};
        };
        if (low < 0 || high >= known_cols || cover.row < 0 || cover.row >= known_rows) {
            if (!raster_.is_whole) leave(low, high);
            if (high < 0 || low >= int(level.cols) || cover.row < 0 || cover.row >= int(level.rows)) continue;
        }
        const int first = std::max(0, low), last = std::min(int(level.cols) - 1, high);
        CellRange inner = no_cells;
        if (has_inner && cover.inner_low < cover.inner_high)
            inner = {ceil_of(u + cover.inner_low), floor_of(u + cover.inner_high) - 1};
        for (int col = first; col <= last;) {
            const int end = std::min(last, col / side * side + side - 1);
            const auto tile_col = std::uint32_t(col / side), tile_row = std::uint32_t(cover.row / side);
            if (open == nullptr || tile_col != open->col || tile_row != open->row) {
                open = &tile_of(pass, tile_col, tile_row);
                if (!open->tile.is_empty()) heights.set_tile(open->tile, open->inverse_quantum);
            }
            const BoundsTile& tile = open->tile;
            for (; col <= end && !tile.is_empty(); ++col) {
                const auto cell = std::uint32_t(cover.row % side * side + col % side);
                if (tile.tops[cell] <= heights.below) continue;
                if (is_free(tile, cell, heights)) continue;
                if (col >= inner.first && col <= inner.last && is_hit(tile, cell, heights)) return Proof::Blocked;
                leave(col, col);
            }
            col = end + 1;
        }
    }
    return nothing_near ? Proof::Free : Proof::Candidate;
}

/// Returns whether the numbers of the cells around a pose fit an int.
bool Mask::is_in_reach(double x, double y) const
{
    constexpr double farthest = 1e8;  // cells
    return !raster_.levels().empty() && std::abs(x - raster_.x0) < farthest * raster_.levels()[0].cell &&
           std::abs(y - raster_.y0) < farthest * raster_.levels()[0].cell;
}

/// Returns the proof for a part whose surroundings are not clear.
Proof Mask::proof_near(Part& part, const Vec3& position, Surroundings surroundings)
{
    if (surroundings == Surroundings::Hit) return Proof::Blocked;
    if (surroundings == Surroundings::Unclear) return Proof::Candidate;
    if (part.core && surroundings == Surroundings::Plain && !coarse_only_)
        if (const auto proof = proof_of_rectangle(part, second_pass(part), position)) return *proof;
    if (leaves_layered_ && surroundings == Surroundings::Layered) return Proof::Candidate;
    if (position.y() != y_) set_y(position.y());
    Proof proof = Proof::Candidate;
    const Pass* coarser = nullptr;
    for (Pass& pass : part.passes) {
        if (!pass.is_ready) cover(part, pass);
        proof = proof_of(part, pass, coarser, position.x(), position.z());
        coarser = &pass;
        if (proof != Proof::Candidate || coarse_only_) break;
    }
    return proof;
}

void Mask::prove(std::span<const double> x, double y, std::span<const double> z, std::span<Proof> out)
{
    std::fill(out.begin(), out.end(), Proof::Candidate);
    if (!is_in_reach(x.front(), y) || !is_in_reach(x.back(), y)) return;
    std::fill(out.begin(), out.end(), Proof::Free);
    surroundings_.resize(x.size());
    for (Part& part : parts_) {
        look_around(part, part.passes.front(), x, y, z, surroundings_);
        if (part.core && !coarse_only_) look_closer(part, second_pass(part), x, y, z, surroundings_);
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (surroundings_[i] == Surroundings::Clear || out[i] == Proof::Blocked || std::isnan(z[i])) continue;
            const Proof proof = proof_near(part, {x[i], y, z[i]}, surroundings_[i]);
            if (proof != Proof::Free) out[i] = proof;
        }
    }
}

Proof Mask::proof_of(const Vec3& position)
{
    if (!is_in_reach(position.x(), position.y())) return Proof::Candidate;
    Proof out = Proof::Free;
    if (std::isnan(position.z())) return out;
    for (Part& part : parts_) {
        const Surroundings surroundings = surroundings_of(part, part.passes.front(), position);
        if (surroundings == Surroundings::Clear) continue;
        const Proof proof = proof_near(part, position, surroundings);
        if (proof == Proof::Blocked) return proof;
        if (proof != Proof::Free) out = proof;
    }
    return out;
}

bool Mask::is_pierced(std::span<const Span> spans, double z) const
{
    for (const Part& part : parts_) {
        if (!part.is_around_origin) continue;
        const double bottom = z + part.footprint.inner.bottom, top = z + part.footprint.inner.top;
        for (const Span& span : spans)
            if (span.top >= bottom && (span.sealed ? span.bottom : span.top) <= top) return true;
    }
    return false;
}

FreeSpace::FreeSpace(const SolidBounds& bounds, const Robot& robot)
    : impl_(std::make_unique<const Impl>(
          Impl{bounds, robot, footprints(robot, Mat3::Identity(), true), yaw_free_footprints(robot)}))
{
}
FreeSpace::FreeSpace(FreeSpace&&) noexcept = default;
FreeSpace::~FreeSpace() = default;

Proof FreeSpace::proof_of(const Pose& scene_from_robot) const
{
    Mask mask(*impl_);
    mask.set_rotation(scene_from_robot.rotation);
    return mask.proof_of(scene_from_robot.position);
}

Proof FreeSpace::proof_of(const Vec3& position, double yaw) const { return Mask(*impl_, yaw).proof_of(position); }

Proof FreeSpace::proof_at_every_yaw(const Vec3& position) const
{
    Mask mask(*impl_);
    mask.set_every_yaw();
    return mask.proof_of(position);
}

}  // namespace spawnfield

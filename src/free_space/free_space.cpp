#include "base/bits.h"
#include "base/rotation.h"
#include "free_space/mask.h"
#include "free_space/sixteen.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Returns a height as a quantized one of a tile, not rounded. Heights beyond those of a tile become 0 or 65536.
double value_of(const BoundsTile& tile, double inverse_quantum, double z)
{
    return std::max(0.0, std::min(65536.0, (z - tile.base) * inverse_quantum));  // faster than std::clamp
}

/// Returns the largest quantized height of a tile that is below z; 0 if there is none.
std::uint32_t values_below(const BoundsTile& tile, double inverse_quantum, double z)
{
    return std::uint32_t(std::max(0, ceil_of(value_of(tile, inverse_quantum, z)) - 1));
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

/// Calls look(first, highest) until all of these columns were looked at: `highest` has the highest tops of the columns
/// first .. first + 15 in these rows. All count from the tile's first column and row.
template <class Look>
void visit_maxima(const BoundsTile& tile, const CellRange& cols, const CellRange& rows, const Look& look)
{
    constexpr int side = BoundsTile::side;
    for (int next = cols.first; next <= cols.last; next += Sixteen::width) {
        const int first = std::min(next, side - Sixteen::width);
        Sixteen highest;
        for (int row = rows.first; row <= rows.last; ++row)
            highest.raise(Sixteen::read(tile.tops + row * side + first));
        look(first, highest);
    }
}

/// Returns a bit for each of these columns in which a top is above a quantized height, in these rows.
std::uint64_t columns_above(const BoundsTile& tile, const CellRange& cols, const CellRange& rows, std::uint32_t height)
{
    std::uint64_t out = 0;
    visit_maxima(tile, cols, rows,
                 [&](int first, const Sixteen& highest) { out |= highest.bits_within(height + 1, 65535) << first; });
    return out & bits_between(cols.first, cols.last);
}

/// Returns whether one of these cells of a tile has a list.
bool has_lists(const CellIntervals& lists, const CellRange& cols, const CellRange& rows)
{
    if (lists.marks == nullptr) return false;
    std::uint64_t marks = 0;
    for (int row = rows.first; row <= rows.last; ++row) marks |= lists.marks[row];
    return (marks & bits_between(cols.first, cols.last)) != 0;
}

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
        set_level(level, part.passes[count]);
        ++count;
    }
    part.passes.resize(count);
}

void Mask::set_level(std::size_t level, Pass& pass) const
{
    pass.is_ready = pass.has_columns = false;
    if (pass.per_cell != 0 && pass.level == level) return;
    pass.level = level;
    pass.per_cell = 1 / raster_.levels()[level].cell;
    pass.known_cols = int(raster_.whole_cols(level));
    pass.known_rows = int(raster_.whole_rows(level));
    pass.tiles = {};
    pass.last_rows = {};
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

/// Returns tile (col, row) of the pass's level.
const Mask::OpenTile& Mask::tile_of(Pass& pass, std::uint32_t col, std::uint32_t row) const
{
    OpenTile& open = pass.tiles[row % Pass::tile_rows * Pass::tile_cols + col % Pass::tile_cols];
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
}

/// The heights of a part at a pose, in m and as quantized heights of the current tile.
struct Mask::Heights {
    double bottom, top, inner_bottom, inner_top;  ///< of the outer and the inner prism, m
    std::uint32_t below = 0;                      ///< cells whose top is at most this value are below the part
    std::uint32_t hit_low = 1, hit_high = 0;      ///< an upper end in this range means a hit inside the part

    Heights(const Footprint& part, double z)
        : bottom(z + part.outer.bottom), top(z + part.outer.top), inner_bottom(z + part.inner.bottom),
          inner_top(z + part.inner.top)
    {
    }
    void set_below(const OpenTile& open) { below = values_below(open.tile, open.inverse_quantum, bottom); }
    void set_hits(const OpenTile& open)
    {
        const auto value = [&](double z) { return value_of(open.tile, open.inverse_quantum, z); };
        hit_low = std::uint32_t(std::max(1, ceil_of(value(inner_bottom + open.tile.slack))));
        hit_high = std::uint32_t(floor_of(value(inner_top)));
    }
    bool is_hit(std::uint32_t value) const { return value >= hit_low && value <= hit_high; }
};

/// Returns what look_around() finds for one pose. It looks at the cells of this pose only.
Mask::Surroundings Mask::surroundings_of(const Part& part, Pass& pass, const Vec3& position) const
{
    constexpr int side = BoundsTile::side;
    const double per_cell = pass.per_cell, x = position.x() - raster_.x0, y = position.y() - raster_.y0,
                 bottom_z = position.z() + part.footprint.outer.bottom;
    const Rect& reach = part.reach;
    const CellRange cols = cells_around((x + reach.low_x) * per_cell, (x + reach.high_x) * per_cell),
                    rows = cells_around((y + reach.low_y) * per_cell, (y + reach.high_y) * per_cell);
    if (rows.first < 0 || rows.last >= pass.known_rows || cols.first < 0 || cols.last >= pass.known_cols)
        return Surroundings::Plain;
    for (int bottom = rows.first / side * side; bottom <= rows.last; bottom += side)
        for (int left = cols.first / side * side; left <= cols.last; left += side) {
            const OpenTile& open = tile_of(pass, std::uint32_t(left / side), std::uint32_t(bottom / side));
            if (open.tile.is_empty()) continue;
            const CellRange c = cols.in_tile(left), r = rows.in_tile(bottom);
            if (columns_above(open.tile, c, r, values_below(open.tile, open.inverse_quantum, bottom_z)) == 0) continue;
            if (!has_lists(open.tile.bounds, c, r)) return Surroundings::Plain;
            const double top_z = position.z() + part.footprint.outer.top;
            if (const Surroundings found = between_layers(open, c, r, bottom_z, top_z); found != Surroundings::Clear)
                return found;
        }
    return Surroundings::Clear;
}

/// Looks at these cells of a tile, some of which have several intervals, for what lies between two heights, m. Returns
/// Clear or Layered.
Mask::Surroundings Mask::between_layers(const OpenTile& open, const CellRange& cols, const CellRange& rows,
                                        double bottom, double top)
{
    const BoundsTile& tile = open.tile;
    const std::uint64_t here = bits_between(cols.first, cols.last);
    std::uint16_t floor = 0, ceiling = std::numeric_limits<std::uint16_t>::max();
    for (int row = rows.first; row <= rows.last; ++row) {
        const auto first = std::uint32_t(row) * BoundsTile::side;
        const std::uint64_t marks = tile.bounds.marks_of(std::uint32_t(row));
        for_each_bit(here & ~marks, [&](std::uint32_t col) { floor = std::max(floor, tile.tops[first + col]); });
        for_each_bit(here & marks, [&](std::uint32_t col) {
            const std::span<const QuantizedSpan> spans = tile.bounds.of(first + col);
            floor = std::max(floor, spans[0].top);
            if (spans.size() > 1) ceiling = std::min(ceiling, spans[1].bottom);
        });
    }
    return tile.height(ceiling) > top && open.are_below(floor, bottom) ? Surroundings::Clear : Surroundings::Layered;
}

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

/// Looks at all cells under a rectangular part at once: the highest cell of each column decides. Returns nothing if the
/// cells must be examined one by one, because some have several intervals, or are above the part, or are not known.
std::optional<Proof> Mask::proof_of_rectangle(const Part& part, Pass& pass, const Vec3& position) const
{
    constexpr int side = BoundsTile::side;
    const double per_cell = pass.per_cell, x = position.x() - raster_.x0, y = position.y() - raster_.y0;
    const Rect &reach = part.reach, &core = *part.core;
    const CellRange cols = cells_around((x + reach.low_x) * per_cell, (x + reach.high_x) * per_cell),
                    rows = cells_around((y + reach.low_y) * per_cell, (y + reach.high_y) * per_cell),
                    core_cols = cells_inside((x + core.low_x) * per_cell, (x + core.high_x) * per_cell),
                    core_rows = cells_inside((y + core.low_y) * per_cell, (y + core.high_y) * per_cell);
    if (cols.first < 0 || cols.last >= pass.known_cols || rows.first < 0 || rows.last >= pass.known_rows)
        return std::nullopt;
    Heights heights(part.footprint, position.z());
    bool is_free = true, is_decided = true;
    for (int bottom = rows.first / side * side; bottom <= rows.last; bottom += side)
        for (int left = cols.first / side * side; left <= cols.last; left += side) {
            const OpenTile& open = tile_of(pass, std::uint32_t(left / side), std::uint32_t(bottom / side));
            const BoundsTile& tile = open.tile;
            if (tile.is_empty()) continue;
            // All that follows counts from the tile's first column and row.
            const CellRange c = cols.in_tile(left), r = rows.in_tile(bottom);
            heights.set_below(open);
            const std::uint64_t above = columns_above(tile, c, r, heights.below);
            if (above == 0) continue;
            is_free = false;
            heights.set_hits(open);
            const CellRange inner_c = core_cols.in_tile(left);
            std::uint64_t hit = 0, beyond = 0;
            visit_maxima(tile, inner_c, core_rows.in_tile(bottom), [&](int first, const Sixteen& highest) {
                hit |= highest.bits_within(heights.hit_low, heights.hit_high) << first;
                beyond |= highest.bits_within(heights.hit_high + 1, 65535) << first;
            });
            const std::uint64_t inside = bits_between(inner_c.first, inner_c.last);
            if ((hit & inside) != 0) return Proof::Blocked;
            std::uint64_t listed = beyond & inside;
            if (tile.bounds.marks != nullptr || tile.solids.marks != nullptr)
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
    Heights heights(footprint, z);
    const double u = (x - raster_.x0) / level.cell;
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
        if (low < 0 || high >= pass.known_cols || cover.row < 0 || cover.row >= pass.known_rows) {
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
                if (!open->tile.is_empty()) {
                    heights.set_below(*open);
                    heights.set_hits(*open);
                }
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
    return std::abs(x - raster_.x0) < farthest_ && std::abs(y - raster_.y0) < farthest_;
}

/// Returns the proof for a part whose surroundings are Plain or Layered.
Proof Mask::proof_near(Part& part, const Vec3& position, Surroundings surroundings)
{
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

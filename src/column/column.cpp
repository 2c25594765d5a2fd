#include "base/intervals.h"
#include "column/columns.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace spawnfield {
namespace {

struct Hit {
    Interval z;
    bool terrain;
};

/// Adds the intervals inside a filled piece, from the bottom up: its crossings in pairs. The number of crossings is odd
/// only in a piece with holes that the user asked to fill; there the column is inside from the lowest crossing down to
/// the piece's bottom.
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

/// Joins intervals that overlap or lie within `tolerance` of each other. The highest top gives the height and the label
/// of the joined interval.
void join(std::vector<Hit>& intervals, double tolerance)
{
    const auto z_of = [](auto& hit) -> auto& { return hit.z; };
    join_intervals(intervals, tolerance, z_of, [](Hit& hit, const Hit& next) {
        const bool same_top = std::abs(next.z.top - hit.z.top) <= touch_tolerance;
        if (same_top)
            hit.terrain = hit.terrain || next.terrain;
        else if (next.z.top > hit.z.top)
            hit.terrain = next.terrain;
    });
}

/// Builds columns from the hits of their vertical lines. Reuses its temporary memory for the next column.
class ColumnBuilder {
public:
    /// Appends one column to `out`. The hits must be in the order of their elements.
    void build(std::span<const SurfaceHit> hits, Column& out)
    {
        if (hits.empty()) return;
        if (hits.size() == 1 && !hits[0].filled) {  // the most frequent case: open ground
            add(hits[0].z, hits[0], hits[0].terrain, out);
            if (hits[0].terrain) out.layers.push_back(hits[0].z.top);
            return;
        }
        const std::size_t first_span = out.spans.size(), first_water = out.water.size();
        for (std::size_t i = 0; i < hits.size();) {
            const SurfaceHit& hit = hits[i];
            if (hit.is_primitive || !hit.filled) {
                add(hit.z, hit, hit.terrain, out);
                ++i;
                continue;
            }
            std::size_t end = i;
            while (end < hits.size() && !hits[end].is_primitive && hits[end].piece == hit.piece) ++end;
            add_piece(hits.subspan(i, end - i), out);
            i = end;
        }
        finish(first_span, first_water, out);
    }

private:
    static void add(const Interval& z, const SurfaceHit& hit, bool terrain, Column& out)
    {
        if (hit.water)
            out.water.push_back(z.top);
        else
            out.spans.push_back({z.bottom, z.top, hit.part, terrain, !hit.open});
    }

    /// Adds a filled piece. It consists entirely of water or has no water.
    void add_piece(std::span<const SurfaceHit> hits, Column& out)
    {
        intervals_.clear();
        crossings_.clear();
        for (const SurfaceHit& hit : hits) {
            if (hit.crosses) crossings_.push_back({{hit.crossing, hit.crossing}, hit.terrain});
            if (hit.touches) intervals_.push_back({hit.z, hit.terrain});
        }
        pair_crossings(crossings_, hits.front().piece_bottom, intervals_);
        join(intervals_, touch_tolerance);
        for (const Hit& hit : intervals_) add(hit.z, hits.front(), hit.terrain, out);
    }

    static bool is_same(const Span& l, const Span& r)
    {
        return l.bottom == r.bottom && l.top == r.top && l.part == r.part && l.terrain == r.terrain &&
               l.sealed == r.sealed;
    }

    void finish(std::size_t first_span, std::size_t first_water, Column& out)
    {
        const auto first = out.spans.begin() + std::ptrdiff_t(first_span);
        if (out.spans.end() - first > 1) {
            std::sort(first, out.spans.end(), [](const Span& l, const Span& r) {
                if (l.top != r.top) return l.top > r.top;
                if (l.terrain != r.terrain) return l.terrain;
                return std::tie(l.part, l.bottom, l.sealed) < std::tie(r.part, r.bottom, r.sealed);
            });
            // A line through a corner or an edge of a sheet hits several of its triangles.
            out.spans.erase(std::unique(first, out.spans.end(), is_same), out.spans.end());
        }
        std::sort(out.water.begin() + std::ptrdiff_t(first_water), out.water.end(), std::greater<>());
        out.water.erase(std::unique(out.water.begin() + std::ptrdiff_t(first_water), out.water.end()), out.water.end());
        const std::span<const Span> spans = std::span(out.spans).subspan(first_span);
        if (spans.size() == 1) {
            if (spans[0].terrain) out.layers.push_back(spans[0].top);
            return;
        }
        intervals_.clear();
        for (const Span& span : spans)
            if (span.terrain) intervals_.push_back({{span.bottom, span.top}, true});
        join(intervals_, layer_tolerance);
        for (auto hit = intervals_.rbegin(); hit != intervals_.rend(); ++hit) out.layers.push_back(hit->z.top);
    }

    std::vector<Hit> intervals_, crossings_;
};

ColumnBuilder& builder()
{
    thread_local ColumnBuilder one;
    return one;
}

bool counts(const Tile& tile, std::uint32_t element, Surfaces surfaces)
{
    return surfaces == Surfaces::All || !tile.is_triangle(element) ||
           tile.pieces[tile.triangles[element].piece].solid != 0;
}

/// Finds the hits of the vertical line through (x, y), in the order of their elements.
void find_hits(const Geometry& geometry, double x, double y, Surfaces surfaces, std::vector<SurfaceHit>& hits)
{
    hits.clear();
    geometry.impl().visit_at(x, y, [&](const Tile& tile, std::span<const std::uint32_t> elements) {
        for (const std::uint32_t element : elements) {
            const ElementBox& box = tile.boxes[element];
            if (box.min[0] > x || box.max[0] < x || box.min[1] > y || box.max[1] < y ||
                !counts(tile, element, surfaces))
                continue;
            if (const auto hit = hit_of(tile, element, x, y)) hits.push_back(*hit);
        }
    });
    std::sort(hits.begin(), hits.end(), [](const SurfaceHit& l, const SurfaceHit& r) { return l.element < r.element; });
}

}  // namespace

void read_column(const Geometry& geometry, double x, double y, Column& out)
{
    thread_local std::vector<SurfaceHit> hits;
    find_hits(geometry, x, y, Surfaces::All, hits);
    out.spans.clear();
    out.layers.clear();
    out.water.clear();
    builder().build(hits, out);
}

Column column_at(const Geometry& geometry, double x, double y)
{
    Column out;
    read_column(geometry, x, y, out);
    return out;
}

std::optional<Ground> ground_below(const ColumnView& column, double z)
{
    std::optional<Ground> best;
    for (const Span& span : column.spans) {  // highest top first
        if (span.top > z + touch_tolerance) continue;
        if (best && best->height - span.top > touch_tolerance) break;
        if (!best || (span.terrain && !best->terrain)) best = Ground{span.top, span.terrain, span.part};
    }
    return best;
}

std::optional<Ground> ground_below(const Column& column, double z) { return ground_below(ColumnView(column), z); }

Columns::Columns(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces) : cols_(grid.cols)
{
    const std::size_t count = std::size_t(grid.cols) * std::size_t(grid.rows);
    starts_.reserve(count + 1);
    starts_.push_back({});
    if (count == 0) return;
    // Scanning one element costs about a tenth of looking up one column.
    const double elements = geometry.impl().elements_near(grid.x_of(grid.first_col), grid.y_of(grid.first_row),
                                                          grid.x_of(grid.first_col + grid.cols),
                                                          grid.y_of(grid.first_row + grid.rows));
    if (elements > 10.0 * double(count))
        look_up(geometry, grid, surfaces);
    else
        scan(geometry, grid, surfaces);
}

void Columns::look_up(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    thread_local std::vector<SurfaceHit> hits;
    for (int j = grid.first_row; j < grid.first_row + grid.rows; ++j)
        for (int i = grid.first_col; i < grid.first_col + grid.cols; ++i) {
            find_hits(geometry, grid.x_of(i), grid.y_of(j), surfaces, hits);
            builder().build(hits, column_);
            end_column();
        }
}

namespace {

/// A range of indices of columns or rows.
struct IndexRange {
    int first, last;  ///< inclusive
    bool is_empty() const { return first > last; }
};

/// Returns the indices, counted from the block's first one, whose coordinates may lie in [low, high]. inverse_step is 1
/// / step.
inline IndexRange indices_in(double low, double high, double origin, double inverse_step, double shift, int first,
                             int count)
{
    constexpr double rounding = 1e-6;  // of a step; more than the rounding error of indices up to 2^31
    const double from = std::max(std::ceil((low - origin) * inverse_step - shift - rounding) - first, 0.0);
    const double to = std::min(std::floor((high - origin) * inverse_step - shift + rounding) - first, count - 1.0);
    if (!(from <= to)) return {0, -1};
    return {int(from), int(to)};
}

/// The hits of a block of columns, in one list for each column.
class HitLists {
public:
    void start(std::size_t columns)
    {
        heads_.assign(columns, none);
        hits_.clear();
        next_.clear();
    }
    bool is_empty() const { return hits_.empty(); }
    /// Adds a hit to a column and returns it, for the caller to write. The reference is valid until the next call.
    SurfaceHit& add(std::size_t column)
    {
        next_.push_back(heads_[column]);
        heads_[column] = std::uint32_t(next_.size() - 1);
        return hits_.emplace_back();
    }
    /// Removes the column's last hit if the one before it is the same: triangles of a sheet share corners and edges.
    void drop_repeated(std::size_t column)
    {
        const std::uint32_t last = heads_[column], before = next_[last];
        if (before == none || !is_same_sheet(hits_[last], hits_[before])) return;
        heads_[column] = before;
        next_.pop_back();
        hits_.pop_back();
    }
    /// Returns the hits of a column in the order of their elements. The span is valid until the next call.
    std::span<const SurfaceHit> of(std::size_t column)
    {
        const std::uint32_t head = heads_[column];
        if (head == none) return {};
        if (next_[head] == none) return {&hits_[head], 1};
        sorted_.clear();
        for (std::uint32_t h = head; h != none; h = next_[h]) sorted_.push_back(hits_[h]);
        std::sort(sorted_.begin(), sorted_.end(),
                  [](const SurfaceHit& l, const SurfaceHit& r) { return l.element < r.element; });
        return sorted_;
    }

private:
    static bool is_same_sheet(const SurfaceHit& l, const SurfaceHit& r)
    {
        return !l.filled && !r.filled && l.piece == r.piece && l.z.top == r.z.top && l.terrain == r.terrain &&
               l.water == r.water && l.part == r.part;
    }

    static constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint32_t> heads_, next_;
    std::vector<SurfaceHit> hits_, sorted_;
};

}  // namespace

void Columns::scan(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    thread_local HitLists hits;
    const std::size_t count = std::size_t(grid.cols) * std::size_t(grid.rows);
    hits.start(count);
    const double inverse_step = 1 / grid.step;
    const auto visit = [&](const Tile& tile, std::uint32_t element) {
        if (!counts(tile, element, surfaces)) return;
        const ElementBox& box = tile.boxes[element];
        const IndexRange cols = indices_in(box.min[0], box.max[0], grid.x0, inverse_step, grid.shift, grid.first_col,
                                           grid.cols);
        if (cols.is_empty()) return;
        const IndexRange rows = indices_in(box.min[1], box.max[1], grid.y0, inverse_step, grid.shift, grid.first_row,
                                           grid.rows);
        if (rows.is_empty()) return;
        const auto visit_columns = [&](auto seen) {
            for (int j = rows.first; j <= rows.last; ++j) {
                seen.set_y(grid.y_of(grid.first_row + j));
                for (int i = cols.first; i <= cols.last; ++i) {
                    const std::size_t column = std::size_t(j) * std::size_t(grid.cols) + std::size_t(i);
                    if (seen.meet(grid.x_of(grid.first_col + i), [&]() -> SurfaceHit& { return hits.add(column); }))
                        hits.drop_repeated(column);
                }
            }
        };
        if (tile.is_triangle(element))
            visit_columns(SeenTriangle(tile, element));
        else
            visit_columns(SeenPrimitive(tile, element));
    };
    geometry.impl().visit_in(grid.x_of(grid.first_col), grid.y_of(grid.first_row),
                             grid.x_of(grid.first_col + grid.cols - 1), grid.y_of(grid.first_row + grid.rows - 1),
                             visit);
    if (hits.is_empty()) {
        starts_.resize(count + 1);
        return;
    }
    ColumnBuilder& columns = builder();
    for (std::size_t column = 0; column < count; ++column) {
        columns.build(hits.of(column), column_);
        end_column();
    }
}

}  // namespace spawnfield

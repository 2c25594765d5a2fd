#include "column/columns.h"

#include "column/column_builder.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// A range of indices of columns or rows.
struct IndexRange {
    int first, last;  ///< inclusive
};

/// Finds which columns of a block may lie in a box.
class BlockIndex {
public:
    explicit BlockIndex(const ColumnGrid& grid)
        : origin_(grid.x0, grid.y0), inverse_step_(1 / grid.step), first_(grid.first_col, grid.first_row),
          last_(grid.cols - 1, grid.rows - 1), shift_(grid.shift)
    {
    }

    /// Returns whether any column may lie in the box, seen from above. If so, sets their indices, counted from the
    /// block's first column and row.
    bool find(const ElementBox& box, IndexRange& cols, IndexRange& rows) const
    {
        constexpr double rounding = 1e-6;  // of a step; more than the rounding error of indices up to 2^31
        const Pair low = steps_to({box.min[0], box.min[1]}) - rounding,
                   high = steps_to({box.max[0], box.max[1]}) + rounding;
        const Pair from = (low.ceil() - first_).max(0), to = (high.floor() - first_).min(last_);
        if (!(from <= to).all()) return false;
        cols = {int(from[0]), int(to[0])};
        rows = {int(from[1]), int(to[1])};
        return true;
    }

private:
    using Pair = Eigen::Array2d;  // x and y
    Pair steps_to(const Pair& place) const { return (place - origin_) * inverse_step_ - shift_; }

    const Pair origin_;
    const double inverse_step_;
    const Pair first_, last_;
    const double shift_;
};

}  // namespace

/// Adds the elements to a block of columns, one after the other.
class Columns::Scan {
public:
    Scan(Columns& out, const ColumnGrid& grid) : out_(out), grid_(grid) {}

    void add_triangle(const Tile& tile, std::uint32_t triangle, const IndexRange& cols, const IndexRange& rows)
    {
        SeenTriangle seen(tile, triangle);
        for (int j = rows.first; j <= rows.last; ++j) {
            seen.set_y(grid_.y_of(grid_.first_row + j));
            for (int i = cols.first; i <= cols.last; ++i) {
                const double x = grid_.x_of(grid_.first_col + i);
                const SeenTriangle::Side side = seen.side_of(x);
                if (side == SeenTriangle::Side::Outside) continue;
                Slot& slot = slot_at(i, j);
                const SurfaceHit& common = seen.common();
                if (side == SeenTriangle::Side::Inside && !common.filled)
                    add_sheet(slot, common, seen.height_at(x));
                else if (side == SeenTriangle::Side::Inside)
                    add_solid(slot, seen.hit_inside(x));
                else if (const auto hit = seen.hit_at_rim(x))
                    hit->filled ? add_solid(slot, *hit) : add_sheet(slot, *hit, hit->z.top);
            }
        }
    }

    void add_primitive(const Tile& tile, std::uint32_t element, const IndexRange& cols, const IndexRange& rows)
    {
        for (int j = rows.first; j <= rows.last; ++j)
            for (int i = cols.first; i <= cols.last; ++i)
                if (const auto hit = hit_of(tile, element, grid_.x_of(grid_.first_col + i),
                                            grid_.y_of(grid_.first_row + j)))
                    add_solid(slot_at(i, j), *hit);
    }

    /// Completes the columns with more than one hit.
    void finish()
    {
        if (further_.empty() && solids_.empty()) return;
        for (Slot& slot : out_.slots_)
            if (slot.content == Content::Several) complete(slot);
    }

private:
    static constexpr std::uint32_t none = 0xffffffff;
    /// A hit of a column with several hits.
    struct Hit {
        Span span;  ///< unless it is in solids_
        std::uint32_t element;
        std::uint32_t solid = none;  ///< index in solids_
        std::uint32_t next = none;   ///< index in further_ of the next hit of the column
        bool water = false;
    };

    Slot& slot_at(int i, int j) { return out_.slots_[std::size_t(j) * std::size_t(grid_.cols) + std::size_t(i)]; }

    /// Adds the hit of a sheet at height z, unless the column has no other hit than the same: triangles share corners
    /// and edges.
    void add_sheet(Slot& slot, const SurfaceHit& hit, double z)
    {
        const Span span{z, z, hit.part, hit.terrain, !hit.open};
        if (slot.content == Content::Nothing) {
            slot.span = span;
            slot.index = hit.element;
            slot.content = hit.water ? Content::Water : hit.terrain ? Content::Terrain : Content::Obstacle;
            return;
        }
        if (slot.content != Content::Several && slot.span.top == z && slot.span.part == hit.part &&
            slot.span.terrain == hit.terrain && slot.span.sealed == span.sealed &&
            (slot.content == Content::Water) == hit.water)
            return;
        add(slot, {.span = span, .element = hit.element, .water = hit.water});
    }

    /// Adds the hit of a primitive or of a filled piece.
    void add_solid(Slot& slot, const SurfaceHit& hit)
    {
        solids_.push_back(hit);
        add(slot, {.span = {}, .element = hit.element, .solid = std::uint32_t(solids_.size() - 1)});
    }

    void add(Slot& slot, Hit hit)
    {
        if (slot.content == Content::Several) {
            hit.next = slot.index;
        } else if (slot.content != Content::Nothing) {
            hit.next = std::uint32_t(further_.size());
            further_.push_back({.span = slot.span, .element = slot.index, .water = slot.content == Content::Water});
        }
        slot.content = Content::Several;
        slot.index = std::uint32_t(further_.size());
        further_.push_back(hit);
    }

    void complete(Slot& slot)
    {
        const std::size_t first_span = out_.column_.spans.size(), first_water = out_.column_.water.size();
        bool has_solid = false;
        for (std::uint32_t h = slot.index; h != none; h = further_[h].next)
            has_solid = has_solid || further_[h].solid != none;
        if (has_solid) {
            sorted_.clear();
            for (std::uint32_t h = slot.index; h != none; h = further_[h].next)
                sorted_.push_back(surface_hit(further_[h]));
            std::sort(sorted_.begin(), sorted_.end(),
                      [](const SurfaceHit& l, const SurfaceHit& r) { return l.element < r.element; });
            builder_.build(sorted_, out_.column_);
        } else {
            for (std::uint32_t h = slot.index; h != none; h = further_[h].next)
                if (further_[h].water)
                    out_.column_.water.push_back(further_[h].span.top);
                else
                    out_.column_.spans.push_back(further_[h].span);
            builder_.finish(first_span, first_water, out_.column_);
        }
        out_.end_column(slot);
    }

    SurfaceHit surface_hit(const Hit& hit) const
    {
        if (hit.solid != none) return solids_[hit.solid];
        SurfaceHit out{};
        out.element = hit.element;
        out.piece = none;  // so that it is no part of the filled piece whose hit is before it
        out.part = hit.span.part;
        out.open = !hit.span.sealed;
        out.terrain = hit.span.terrain;
        out.water = hit.water;
        out.touches = true;
        out.z = {hit.span.bottom, hit.span.top};
        return out;
    }

    Columns& out_;
    const ColumnGrid& grid_;
    std::vector<Hit> further_;
    std::vector<SurfaceHit> solids_, sorted_;
    ColumnBuilder builder_;
};

Columns::Columns(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
    : cols_(grid.cols), slots_(std::size_t(grid.cols) * std::size_t(grid.rows)), starts_(1)
{
    if (slots_.empty()) return;
    const double elements = geometry.impl().elements_near(grid.x_of(grid.first_col), grid.y_of(grid.first_row),
                                                          grid.x_of(grid.first_col + grid.cols),
                                                          grid.y_of(grid.first_row + grid.rows));
    constexpr double elements_per_look_up = 30;  // so many elements are scanned in the time of one look-up
    if (elements > elements_per_look_up * double(slots_.size()))
        look_up(geometry, grid, surfaces);
    else
        scan(geometry, grid, surfaces);
}

void Columns::scan(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    const BlockIndex index(grid);
    Scan scan(*this, grid);
    IndexRange cols, rows;  // of the element that was found last
    const auto is_met = [&](const ElementBox& box) { return index.find(box, cols, rows); };
    geometry.impl().visit_in(grid.x_of(grid.first_col), grid.y_of(grid.first_row),
                             grid.x_of(grid.first_col + grid.cols - 1), grid.y_of(grid.first_row + grid.rows - 1),
                             is_met, [&](const Tile& tile, std::uint32_t element) {
                                 if (!counts(tile, element, surfaces)) return;
                                 if (tile.is_triangle(element))
                                     scan.add_triangle(tile, element, cols, rows);
                                 else
                                     scan.add_primitive(tile, element, cols, rows);
                             });
    scan.finish();
}

void Columns::look_up(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    ColumnBuilder builder;
    std::vector<SurfaceHit> hits;
    auto slot = slots_.begin();
    for (int j = grid.first_row; j < grid.first_row + grid.rows; ++j)
        for (int i = grid.first_col; i < grid.first_col + grid.cols; ++i, ++slot) {
            find_hits(geometry, grid.x_of(i), grid.y_of(j), surfaces, hits);
            if (hits.empty()) continue;
            builder.build(hits, column_);
            end_column(*slot);
        }
}

/// Ends the column that was added to column_ last.
void Columns::end_column(Slot& slot)
{
    slot.content = Content::Several;
    slot.index = std::uint32_t(starts_.size() - 1);
    starts_.push_back({std::uint32_t(column_.spans.size()), std::uint32_t(column_.layers.size()),
                       std::uint32_t(column_.water.size())});
}

}  // namespace spawnfield

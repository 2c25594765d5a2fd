#include "column/columns.h"

#include "column/column_builder.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

/// Finds which columns of a block may lie in a box.
class BlockIndex {
public:
    explicit BlockIndex(const ColumnGrid& grid)
        : origin_(grid.x0, grid.y0), inverse_step_(1 / grid.step), first_(grid.first_col, grid.first_row),
          last_(grid.cols - 1, grid.rows - 1), shift_(grid.shift)
    {
    }

    /// Returns whether any column may lie in the box, seen from above. If so, sets their range.
    bool find(const Bounds& box, ColumnRange& out) const
    {
        constexpr double rounding = 1e-6;  // of a step; more than the rounding error of indices up to 2^31
        const Pair low = steps_to(box.min.head<2>().array() - pad) - rounding,
                   high = steps_to(box.max.head<2>().array() + pad) + rounding;
        const Pair from = (low.ceil() - first_).max(0), to = (high.floor() - first_).min(last_);
        if (!(from <= to).all()) return false;
        out = {int(from[0]), int(to[0]), int(from[1]), int(to[1])};
        return true;
    }

private:
    static constexpr double pad = 2 * touch_tolerance;  // m: a line so near to an element may touch it
    using Pair = Eigen::Array2d;                        // x and y
    Pair steps_to(const Pair& place) const { return (place - origin_) * inverse_step_ - shift_; }

    const Pair origin_;
    const double inverse_step_;
    const Pair first_, last_;
    const double shift_;
};

}  // namespace

Columns::Columns(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces) { set(geometry, grid, surfaces); }

void Columns::set(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    cols_ = grid.cols;
    slots_.assign(std::size_t(grid.cols) * std::size_t(grid.rows), {});
    starts_.assign(1, {});
    column_.spans.clear();
    column_.layers.clear();
    column_.water.clear();
    listed_.clear();
    if (slots_.empty()) return;
    const double elements = geometry.impl().elements_near(grid.x_of(grid.first_col), grid.y_of(grid.first_row),
                                                          grid.x_of(grid.first_col + grid.cols),
                                                          grid.y_of(grid.first_row + grid.rows));
    constexpr double elements_per_look_up = 50;  // so many elements are scanned in the time of one look-up
    if (elements > elements_per_look_up * double(slots_.size()))
        look_up(geometry, grid, surfaces);
    else
        scan(geometry, grid, surfaces);
}

void Columns::look_up(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    auto slot = slots_.begin();
    for (int j = grid.first_row; j < grid.first_row + grid.rows; ++j)
        for (int i = grid.first_col; i < grid.first_col + grid.cols; ++i, ++slot) {
            find_hits(geometry, grid.x_of(i), grid.y_of(j), surfaces, hits_);
            if (hits_.empty()) continue;
            builder_.build(hits_, column_);
            end_column(*slot);
        }
}

void Columns::scan(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    const BlockIndex index(grid);
    ColumnRange range;  // of the element that was found last
    geometry.impl().visit_near(grid.x_of(grid.first_col), grid.y_of(grid.first_row),
                               grid.x_of(grid.first_col + grid.cols - 1), grid.y_of(grid.first_row + grid.rows - 1),
                               [&](const Tile& tile, std::uint32_t element) {
                                   if (!index.find(tile.bounds(element), range) || !counts(tile, element, surfaces))
                                       return;
                                   if (tile.is_triangle(element))
                                       add_triangle(tile, element, grid, range);
                                   else
                                       add_primitive(tile, element, grid, range);
                               });
    if (listed_.empty()) return;
    for (Slot& slot : slots_)
        if (slot.content == Content::Several) complete(slot);
}

void Columns::add_triangle(const Tile& tile, std::uint32_t triangle, const ColumnGrid& grid, const ColumnRange& range)
{
    SeenTriangle seen(tile, triangle);
    for (int j = range.first_row; j <= range.last_row; ++j) {
        seen.set_y(grid.y_of(grid.first_row + j));
        for (int i = range.first_col; i <= range.last_col; ++i) {
            const double x = grid.x_of(grid.first_col + i);
            const SeenTriangle::Side side = seen.side_of(x);
            if (side == SeenTriangle::Side::Outside) continue;
            Slot& slot = slots_[number(i, j)];
            const SurfaceHit& common = seen.common();
            if (side == SeenTriangle::Side::Inside && !common.filled)
                add_sheet(slot, common, seen.height_at(x));
            else if (side == SeenTriangle::Side::Inside)
                add(slot, seen.hit_inside(x));
            else if (const auto hit = seen.hit_at_rim(x))
                hit->filled ? add(slot, *hit) : add_sheet(slot, *hit, hit->z.top);
        }
    }
}

void Columns::add_primitive(const Tile& tile, std::uint32_t element, const ColumnGrid& grid, const ColumnRange& range)
{
    for (int j = range.first_row; j <= range.last_row; ++j)
        for (int i = range.first_col; i <= range.last_col; ++i)
            if (const auto hit = hit_of(tile, element, grid.x_of(grid.first_col + i), grid.y_of(grid.first_row + j)))
                add(slots_[number(i, j)], *hit);
}

/// Adds the hit of a sheet at height z, unless the column has no other hit than the same: triangles share corners and
/// edges.
void Columns::add_sheet(Slot& slot, const SurfaceHit& hit, double z)
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
    SurfaceHit listed = hit;
    listed.z = {z, z};
    add(slot, listed);
}

/// Adds a hit to the list of a column. If the column has a hit that is not in a list yet, its list begins with it.
void Columns::add(Slot& slot, const SurfaceHit& hit)
{
    std::uint32_t next = none;
    if (slot.content == Content::Several) {
        next = slot.index;
    } else if (slot.content != Content::Nothing) {
        SurfaceHit first{};
        first.element = slot.index;
        first.piece = none;  // its piece is not known, and not needed because it is not filled
        first.part = slot.span.part;
        first.open = !slot.span.sealed;
        first.terrain = slot.span.terrain;
        first.water = slot.content == Content::Water;
        first.touches = true;
        first.z = {slot.span.bottom, slot.span.top};
        next = std::uint32_t(listed_.size());
        listed_.push_back({first, none});
    }
    slot.content = Content::Several;
    slot.index = std::uint32_t(listed_.size());
    listed_.push_back({hit, next});
}

/// Appends the column of a list of hits to column_.
void Columns::complete(Slot& slot)
{
    hits_.clear();
    for (std::uint32_t h = slot.index; h != none; h = listed_[h].next) hits_.push_back(listed_[h].hit);
    if (hits_.size() > 1)
        std::sort(hits_.begin(), hits_.end(),
                  [](const SurfaceHit& l, const SurfaceHit& r) { return l.element < r.element; });
    builder_.build(hits_, column_);
    end_column(slot);
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

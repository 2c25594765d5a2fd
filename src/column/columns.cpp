#include "column/columns.h"

#include "base/rect.h"
#include "column/column_builder.h"

#include <algorithm>

namespace spawnfield {
namespace {

/// Finds which columns of a block may lie in a box.
class BlockIndex {
public:
    using Pair = SeenTriangle::Place;

    explicit BlockIndex(const ColumnGrid& grid)
        : low_(grid.x_of(grid.first_col), grid.y_of(grid.first_row)), high_(low_), inverse_step_(1 / grid.step),
          last_(grid.cols - 1, grid.rows - 1)
    {
        constexpr double pad = 2 * touch_tolerance;  // m: a line so near to an element may touch it
        constexpr double rounding = 1e-6;            // of a step; more than the rounding error of indices up to 2^31
        low_ += pad + rounding * grid.step;
        high_ -= pad + rounding * grid.step;
    }

    /// Returns whether any column may lie in the rectangle from `min` to `max`. If so, sets their range.
    bool find(const Pair& min, const Pair& max, ColumnRange& out) const
    {
        const Pair from = ((min - low_) * inverse_step_).ceil().max(0),
                   to = ((max - high_) * inverse_step_).floor().min(last_);
        if (!(from <= to).all()) return false;
        out = {int(from[0]), int(to[0]), int(from[1]), int(to[1])};
        return true;
    }

private:
    Pair low_, high_;  ///< of the first column, moved by what may be lost to tolerance and rounding, m
    const double inverse_step_;
    const Pair last_;
};

/// A few places that are near each other, compared with boxes all at once, four at a time.
class PlaceGroup {
public:
    static constexpr std::size_t most = 64;
    static constexpr double widest = 500;  ///< m, along x and y; so floats are exact to less than 0.1 mm

    explicit PlaceGroup(std::span<const Vec2> places)
        : blocks_((places.size() + width - 1) / width), all_(bits_between(0, int(places.size()) - 1)),
          origin_(places.front())
    {
        for (std::size_t i = 0; i < blocks_ * width; ++i) {
            const Vec2 from_origin = places[std::min(i, places.size() - 1)] - origin_;
            x_[i / 4][i % 4] = float(from_origin.x());
            y_[i / 4][i % 4] = float(from_origin.y());
        }
    }

    /// Returns a bit for each place in a closed box, seen from above. Rounding keeps the order of coordinates, so no
    /// place in the box is missed; but one that is up to 0.1 mm outside may get a bit, too.
    std::uint64_t in(const ElementBox& box) const
    {
        const auto from_origin = [&](double at, int axis) { return all(float(at - origin_[axis])); };
        const Four low_x = from_origin(box.min[0], 0), high_x = from_origin(box.max[0], 0),
                   low_y = from_origin(box.min[1], 1), high_y = from_origin(box.max[1], 1);
        const auto four_in = [&](std::size_t k) {
            return (x_[k] >= low_x) & (x_[k] <= high_x) & (y_[k] >= low_y) & (y_[k] <= high_y);
        };
        std::uint64_t out = 0;
        for (std::size_t block = 0; block < blocks_; ++block)
            out |= std::uint64_t{bits_of(four_in(2 * block), four_in(2 * block + 1))} << block * width;
        return out & all_;
    }

private:
    static constexpr std::size_t width = 8;

    std::size_t blocks_;
    std::uint64_t all_;                 ///< a bit for each place
    Vec2 origin_;                       ///< the first place, m
    std::array<Four, most / 4> x_, y_;  ///< from the first place, m
};

/// Returns the end of the places from `begin` on that are in a rectangle with sides of at most `widest`, m. They are
/// not many, because each of them is compared with each tile that meets the rectangle.
std::size_t end_of_group(std::span<const Vec2> places, std::size_t begin, double widest)
{
    Rect around = rect_around(places.subspan(begin, 1));
    std::size_t end = begin + 1;
    for (; end < std::min(places.size(), begin + PlaceGroup::most); ++end) {
        around.extend(places[end]);
        if (!(around.longest_side() <= widest)) break;
    }
    return end;
}

}  // namespace

Columns::Columns(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces) { set(geometry, grid, surfaces); }

/// Makes empty columns.
void Columns::start(int cols, int rows)
{
    cols_ = cols;
    count_ = std::size_t(cols) * std::size_t(rows);
    if (slots_.size() < count_ || ++round_ == 0) {
        slots_.assign(std::max(slots_.size(), count_), {});
        round_ = 1;
    }
    starts_.assign(1, {});
    column_.spans.clear();
    column_.layers.clear();
    column_.water.clear();
    hits_.clear();
    listed_.clear();
    full_.clear();
    last_ = nullptr;
}

void Columns::set(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    start(grid.cols, grid.rows);
    if (count_ == 0) return;
    const double elements = geometry.impl().elements_near({grid.x_of(grid.first_col), grid.y_of(grid.first_row),
                                                           grid.x_of(grid.first_col + grid.cols),
                                                           grid.y_of(grid.first_row + grid.rows)});
    constexpr double elements_per_look_up = 50;  // so many elements are scanned in the time of one look-up
    are_dense_ = elements <= elements_per_look_up * double(count_);
    are_dense_ ? scan(geometry, grid, surfaces) : look_up(geometry, grid, surfaces);
}

/// Finds the tiles of several places at once.
void Columns::set(const Geometry& geometry, std::span<const Vec2> places)
{
    static_assert(PlaceGroup::most == Lines::most);
    start(int(places.size()), 1);
    const Geometry::Impl& impl = geometry.impl();
    const double widest = std::min(4 * impl.tile_side(), PlaceGroup::widest);
    for (std::size_t begin = 0; begin < places.size();) {
        const std::size_t end = end_of_group(places, begin, widest);
        const PlaceGroup group(places.subspan(begin, end - begin));
        for (std::size_t i = begin; i < end; ++i) {
            lines_.at[i - begin] = places[i];
            lines_.slot[i - begin] = std::uint32_t(i);
        }
        const Rect around = rect_around(places.subspan(begin, end - begin));
        impl.find_tiles(around, [&](const Forest& forest, std::size_t tree, std::size_t number, const ElementBox& box) {
            const std::uint64_t lines = group.in(box);
            if (lines == 0) return;
            const Tile tile = impl.open(forest, tree, number);
            if (tile.has_grid()) {
                add_from_grid(tile, box, lines);
                return;
            }
            for_each_bit(lines, [&](std::uint32_t line) {
                pair(tile, line, tile.near(lines_.at[line].x(), lines_.at[line].y()));
            });
            add_pairs(tile, box);
        });
        begin = end;
    }
    complete_all();
}

void Columns::look_up(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    auto slot = slots_.begin();
    for (int j = grid.first_row; j < grid.first_row + grid.rows; ++j)
        for (int i = grid.first_col; i < grid.first_col + grid.cols; ++i, ++slot) {
            find_hits(geometry, grid.x_of(i), grid.y_of(j), surfaces, ordered_);
            if (ordered_.empty()) continue;
            builder_.build(ordered_, column_);
            end_column(*slot);
        }
}

void Columns::scan(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces)
{
    x_.resize(std::size_t(grid.cols) + TriangleSides::width - 1);
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = grid.x_of(grid.first_col + int(i));
    y_.resize(std::size_t(grid.rows));
    for (std::size_t j = 0; j < y_.size(); ++j) y_[j] = grid.y_of(grid.first_row + int(j));
    const BlockIndex index(grid);
    const Rect area{x_[0], y_.front(), x_[std::size_t(grid.cols) - 1], y_.back()};
    constexpr std::uint32_t columns_per_triangle = 2;  // with more of them, a look at each triangle takes less time
    geometry.impl().visit_whole_tiles(area, [&](const Tile& tile, const ElementBox& box) {
        ColumnRange range;
        if (!index.find({box.min[0], box.min[1]}, {box.max[0], box.max[1]}, range)) return;
        const auto columns = std::uint32_t(range.last_col + 1 - range.first_col) *
                             std::uint32_t(range.last_row + 1 - range.first_row);
        if (tile.has_grid() && range.last_col - range.first_col < int(Lines::most) &&
            columns <= columns_per_triangle * tile.elements()) {
            add_grid(tile, box, surfaces, range);
            return;
        }
        if (columns <= tile.elements()) {  // most elements meet no column
            add_columns(tile, box, surfaces, range);
            return;
        }
        const std::uint64_t elements = counted(tile, tile.near(area), surfaces);
        for_each_bit(elements, [&](std::uint32_t element) {
            if (!tile.is_triangle(element)) {
                const Bounds bounds = tile.bounds(element);
                if (index.find(bounds.min.head<2>(), bounds.max.head<2>(), range)) add_primitive(tile, element, range);
                return;
            }
            const SeenTriangle seen(tile, element);
            if (index.find(seen.low_corner(), seen.high_corner(), range)) add_triangle(seen, range);
        });
    });
    complete_all();
}

/// Completes the columns that have more than a slot can hold.
void Columns::complete_all()
{
    for (const std::uint32_t number : full_) complete(slots_[number]);
}

void Columns::add_triangle(const SeenTriangle& seen, const ColumnRange& range)
{
    const auto place_of = [&](int col, int row) {
        return SeenTriangle::Place(x_[std::size_t(col)], y_[std::size_t(row)]);
    };
    const TriangleSides sides(seen, place_of(range.first_col, range.first_row),
                              place_of(range.last_col, range.last_row));
    const TrianglePlane plane(seen);  // nearly all triangles with a range of columns are met by one
    const bool is_shared = plane.filled && plane.is_level();  // all lines inside have the same hit
    std::uint32_t shared = none;
    const auto add = [&](Slot& slot, double x, double y) {
        if (shared != none) {
            list(slot, shared);
            return;
        }
        add_inside(slot, seen, plane, x, y);
        if (is_shared) shared = std::uint32_t(hits_.size() - 1);
    };
    const auto add_at_rim = [&](Slot& slot, double x, double y) { add_rim(slot, seen, plane, x, y); };
    constexpr int width = TriangleSides::width, height = TriangleSides::most_rows;
    for (int col = range.first_col; col <= range.last_col; col += width) {
        const double* const x = x_.data() + col;
        const TriangleSides::Lines lines = sides.at(x);
        const std::uint64_t asked = TriangleSides::first_lines(range.last_col + 1 - col);
        for (int row = range.first_row; row <= range.last_row; row += height) {
            const double* const y = y_.data() + row;
            Slot* const slots = slots_.data() + number(col, row);
            const TriangleSides::Sides here = sides.of(lines,
                                                       {y, std::size_t(std::min(height, range.last_row + 1 - row))});
            const auto add_each = [&](std::uint64_t bits, const auto& add_one) {
                for_each_bit(bits & asked, [&](std::uint32_t bit) {
                    const std::uint32_t i = bit % width, j = bit / width;
                    add_one(slots[j * std::uint32_t(cols_) + i], x[i], y[j]);
                });
            };
            add_each(here.inside, add);
            add_each(here.rim, add_at_rim);
        }
    }
}

/// Adds the hits of these columns with the elements of a tile. There are at most Lines::most of them.
void Columns::add_columns(const Tile& tile, const ElementBox& box, Surfaces surfaces, const ColumnRange& range)
{
    static_assert(TileBoxes::most == Lines::most);
    const std::uint64_t elements = counted(tile, tile.alive, surfaces);
    const int cols = range.last_col + 1 - range.first_col, rows = range.last_row + 1 - range.first_row;
    std::array<std::uint64_t, Lines::most> near_x, near_y;
    for (int i = 0; i < cols; ++i)
        near_x[std::size_t(i)] = tile.near_x(x_[std::size_t(range.first_col + i)]) & elements;
    for (int j = 0; j < rows; ++j) near_y[std::size_t(j)] = tile.near_y(y_[std::size_t(range.first_row + j)]);
    // One loop in place of two, without a branch: the ends of many short rows cannot be foretold.
    int i = 0, j = 0;
    for (std::uint32_t line = 0; line < std::uint32_t(cols * rows); ++line) {
        const int col = range.first_col + i, row = range.first_row + j;
        lines_.at[line] = {x_[std::size_t(col)], y_[std::size_t(row)]};
        lines_.slot[line] = std::uint32_t(number(col, row));
        pair(tile, line, near_x[std::size_t(i)] & near_y[std::size_t(j)]);
        const int goes_on = i + 1 < cols;
        i = (i + 1) & -goes_on;
        j += 1 - goes_on;
    }
    add_pairs(tile, box);
}

/// Does the same for a tile with a grid. There may be any number of columns, but at most Lines::most in a row.
void Columns::add_grid(const Tile& tile, const ElementBox& box, Surfaces surfaces, const ColumnRange& range)
{
    const TriangleGrid grid = tile.grid();
    const std::uint64_t elements = counted(tile, tile.alive, surfaces);
    const auto cols = std::uint32_t(range.last_col + 1 - range.first_col);
    std::array<TriangleGrid::Along, Lines::most> along_x;
    std::array<std::uint64_t, Lines::most> near_x;
    std::uint64_t known_x = 0;  // a bit for each number in near_x; few of them are needed
    for (std::uint32_t i = 0; i < cols; ++i) along_x[i] = grid.along_x(x_[std::uint32_t(range.first_col) + i]);
    std::uint32_t line = 0;
    for (int row = range.first_row; row <= range.last_row; ++row) {
        if (line + cols > Lines::most) {
            add_pairs(tile, box);
            line = 0;
        }
        const double y = y_[std::size_t(row)];
        const TriangleGrid::Along along_y = grid.along_y(y);
        const std::size_t first_slot = number(range.first_col, row);
        for (std::uint32_t i = 0; i < cols; ++i, ++line) {
            const double x = x_[std::uint32_t(range.first_col) + i];
            lines_.at[line] = {x, y};
            lines_.slot[line] = std::uint32_t(first_slot + i);
            look_in_grid(tile, grid.find(along_x[i], along_y), elements, line, [&] {
                if ((known_x >> i & 1) == 0) near_x[i] = tile.near_x(x);
                known_x |= std::uint64_t{1} << i;
                return near_x[i] & tile.near_y(y);
            });
        }
    }
    add_pairs(tile, box);
}

/// Adds the hits of some of the lines with the elements of a tile that has a grid.
void Columns::add_from_grid(const Tile& tile, const ElementBox& box, std::uint64_t lines)
{
    const TriangleGrid grid = tile.grid();
    for_each_bit(lines, [&](std::uint32_t line) {
        const double x = lines_.at[line].x(), y = lines_.at[line].y();
        look_in_grid(tile, grid.find(grid.along_x(x), grid.along_y(y)), tile.alive, line,
                     [&] { return tile.near(x, y); });
    });
    add_pairs(tile, box);
}

/// Adds the hit of a line with the triangle that was found in the grid, and remembers others that it may meet. near()
/// returns a bit for each element that is near the line.
template <class Near>
[[gnu::always_inline]] inline void Columns::look_in_grid(const Tile& tile, std::uint32_t found, std::uint64_t elements,
                                                         std::uint32_t line, const Near& near)
{
    if (found < TriangleGrid::none && (elements >> found & 1) != 0) {
        const SeenTriangle seen(tile, found);
        add_inside(slots_[lines_.slot[line]], seen, TrianglePlane(seen), lines_.at[line].x(), lines_.at[line].y());
    }
    const std::uint64_t others = found == TriangleGrid::rim ? elements : elements & ~tile.grid().members();
    if (others != 0) pair(tile, line, near() & others);
}

/// Remembers the triangles of a tile that may meet a line, and adds the hits of the line with primitives.
inline void Columns::pair(const Tile& tile, std::uint32_t line, std::uint64_t elements)
{
    constexpr int usual = 4;  // most lines have at most so many pairs, so the loop below ends where it is expected
    const std::uint64_t are_triangles = tile.are_triangles();
    std::uint64_t triangles = elements & are_triangles;
    const auto add_next = [&] {
        pairs_.add({std::uint8_t(line), std::uint8_t(first_bit(triangles))}, triangles != 0);
        triangles &= triangles - 1;
    };
    for (int k = 0; k < usual; ++k) add_next();
    while (triangles != 0) add_next();
    for_each_bit(elements & ~are_triangles, [&](std::uint32_t element) {
        if (const auto hit = hit_of(tile, element, lines_.at[line].x(), lines_.at[line].y()))
            list_new(slots_[lines_.slot[line]]) = *hit;
    });
}

/// Adds the hits of the pairs. All lines are in the tile's box, or within 1 mm.
void Columns::add_pairs(const Tile& tile, const ElementBox& box)
{
    constexpr std::size_t width = FourPairs::width;
    if (pairs_.count == 0) return;
    constexpr double more = 0.01;  // m
    const auto side = [&](std::size_t axis) { return double(box.max[axis]) - double(box.min[axis]) + more; };
    const float rim = FourPairs::rim_in(side(0), side(1));
    // The last four is filled up with its last pair.
    for (std::size_t k = 0; k < width; ++k) pairs_.at[pairs_.count + k] = pairs_.at[pairs_.count - 1];
    for (std::size_t first = 0; first < pairs_.count; first += width) {
        FourPairs four;
        for (std::size_t k = 0; k < width; ++k) {
            const Pair& pair = pairs_.at[first + k];
            four.lines[k] = lines_.at[pair.line].data();
            four.corners[k] = tile.corner_pointers(pair.triangle);
        }
        const std::uint32_t asked = (1U << std::min(pairs_.count - first, width)) - 1;
        const SeenTriangle::Sides sides = four.sides(rim);
        const std::uint32_t inside = sides.inside & asked, at_rim = sides.rim & asked;
        const auto keep = [&](PairList& list, std::uint32_t bits) {
            for (std::size_t k = 0; k < width; ++k) list.add(pairs_.at[first + k], (bits >> k & 1) != 0);
        };
        keep(inside_, inside);
        if (at_rim != 0) keep(rim_, at_rim);
    }
    const auto take = [&](PairList& list, const auto& add) {
        for (std::size_t i = 0; i < list.count; ++i) {
            const Pair& pair = list.at[i];
            const Vec2& line = lines_.at[pair.line];
            const SeenTriangle seen(tile, pair.triangle);
            add(slots_[lines_.slot[pair.line]], seen, TrianglePlane(seen), line.x(), line.y());
        }
        list.count = 0;
    };
    take(inside_, [&](auto&&... hit) { add_inside(hit...); });
    take(rim_, [&](auto&&... hit) { add_rim(hit...); });
    pairs_.count = 0;
}

// Without the attribute, GCC does not inline the four functions that have it, which takes more instructions.

[[gnu::always_inline]] inline void Columns::add_inside(Slot& slot, const SeenTriangle& seen, const TrianglePlane& plane,
                                                       double x, double y)
{
    const double height = plane.height(x, y);
    if (plane.filled)
        seen.set_hit_inside(plane, height, list_new(slot));
    else
        add_sheet(slot, seen, plane, height);
}

[[gnu::always_inline]] inline void Columns::add_rim(Slot& slot, const SeenTriangle& seen, const TrianglePlane& plane,
                                                    double x, double y)
{
    if (plane.filled) {
        if (const auto hit = seen.hit_at_rim(plane, x, y)) list_new(slot) = *hit;
    } else if (const auto height = seen.sheet_at_rim(plane, x, y)) {
        add_sheet(slot, seen, plane, *height);
    }
}

void Columns::add_primitive(const Tile& tile, std::uint32_t element, const ColumnRange& range)
{
    for (int j = range.first_row; j <= range.last_row; ++j)
        for (int i = range.first_col; i <= range.last_col; ++i)
            if (const auto hit = hit_of(tile, element, x_[std::size_t(i)], y_[std::size_t(j)]))
                list_new(slots_[number(i, j)]) = *hit;
}

/// Empties a slot that was last used for another block.
inline void Columns::refresh(Slot& slot)
{
    if (slot.round == round_) return;
    slot.round = round_;
    slot.has_span = slot.has_water = slot.has_more = false;
}

/// Adds the hit of a sheet at height z, unless the slot has the same hit already: triangles share corners and edges.
[[gnu::always_inline]] inline void Columns::add_sheet(Slot& slot, const SeenTriangle& seen, const TrianglePlane& plane,
                                                      double z)
{
    refresh(slot);
    if (plane.water) {
        if (slot.has_water && slot.water == z) return;
        if (!slot.has_water) {
            slot.has_water = true;
            slot.water = z;
            return;
        }
    } else {
        if (!slot.has_span) {
            slot.has_span = true;
            Span& span = slot.span;  // set in place: copying it would wait for all of its parts
            span.bottom = span.top = z;
            span.terrain = plane.terrain;
            span.sealed = !plane.open;
            span.part = plane.part;
            return;
        }
        if (slot.span == Span{z, z, plane.terrain, !plane.open, plane.part}) return;
    }
    seen.set_hit_inside(plane, z, list_new(slot));
}

/// Adds a hit to the list of a column, and returns it, to be set. So it need not be copied, which would wait for all of
/// its parts.
SurfaceHit& Columns::list_new(Slot& slot)
{
    list(slot, std::uint32_t(hits_.size()));
    return hits_.emplace_back();
}

/// Adds hits_[hit] to the list of a column.
[[gnu::always_inline]] inline void Columns::list(Slot& slot, std::uint32_t hit)
{
    refresh(slot);
    if (!slot.has_more) full_.push_back(std::uint32_t(&slot - slots_.data()));
    listed_.push_back({hit, slot.has_more ? slot.index : none});
    slot.has_more = true;
    slot.index = std::uint32_t(listed_.size() - 1);
}

/// Returns whether a slot has the same hits as the last one that was completed: neighbouring columns of level surfaces.
bool Columns::is_like_last(const Slot& slot) const
{
    const auto differ = [](double a, double b) {  // also 0 and -0
        return std::bit_cast<std::uint64_t>(a) != std::bit_cast<std::uint64_t>(b);
    };
    if (last_ == nullptr || slot.has_span != last_->has_span || slot.has_water != last_->has_water) return false;
    if (slot.has_span && (slot.span != last_->span || differ(slot.span.top, last_->span.top))) return false;
    if (slot.has_water && differ(slot.water, last_->water)) return false;
    std::uint32_t a = slot.index, b = last_hit_;
    for (; a != none && b != none; a = listed_[a].next, b = listed_[b].next)
        if (listed_[a].hit != listed_[b].hit) return false;
    return a == b;
}

/// Appends the column of a slot and its list of hits to column_, unless the last column is the same.
void Columns::complete(Slot& slot)
{
    if (is_like_last(slot)) {
        slot.index = last_->index;
        return;
    }
    last_ = &slot;
    last_hit_ = slot.index;
    order_.clear();
    for (std::uint32_t h = slot.index; h != none; h = listed_[h].next)
        order_.push_back(std::uint64_t{hits_[listed_[h].hit].element} << 32 | listed_[h].hit);
    std::reverse(order_.begin(), order_.end());  // nearly in order: the last hit came first
    std::sort(order_.begin(), order_.end());
    ordered_.clear();
    for (const std::uint64_t both : order_) ordered_.push_back(hits_[std::uint32_t(both)]);
    builder_.build(ordered_, column_, {&slot.span, slot.has_span}, {&slot.water, slot.has_water});
    end_column(slot);
}

/// Ends the column that was added to column_ last.
void Columns::end_column(Slot& slot)
{
    refresh(slot);
    slot.has_more = true;
    slot.index = std::uint32_t(starts_.size() - 1);
    starts_.push_back({std::uint32_t(column_.spans.size()), std::uint32_t(column_.layers.size()),
                       std::uint32_t(column_.water.size())});
}

}  // namespace spawnfield

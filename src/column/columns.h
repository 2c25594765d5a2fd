#pragma once

#include "base/polygon2.h"
#include "column/column_builder.h"
#include "column/surface_hit.h"

#include <bit>
#include <optional>
#include <span>

namespace spawnfield {

/// A view of a Column. Another object owns the arrays.
struct ColumnView {
    std::span<const Span> spans;
    std::span<const double> layers, water;

    ColumnView() = default;
    ColumnView(std::span<const Span> s, std::span<const double> l, std::span<const double> w)
        : spans(s), layers(l), water(w)
    {
    }
    ColumnView(const Column& column) : spans(column.spans), layers(column.layers), water(column.water) {}
};

/// Does the same as ground_below for a Column.
inline std::optional<Ground> ground_below(const ColumnView& column, double z)
{
    const Span* best = nullptr;
    for (const Span& span : column.spans) {  // highest top first
        if (span.top > z + touch_tolerance) continue;
        if (best != nullptr && best->top - span.top > touch_tolerance) break;
        if (best == nullptr || (span.terrain && !best->terrain)) best = &span;
    }
    if (best == nullptr) return std::nullopt;
    return Ground{best->top, best->terrain, best->part};
}

/// Writes column_at(geometry, x, y) to `out`, and uses the memory of `out` again.
void read_column(const Geometry& geometry, double x, double y, Column& out);

/// Returns the part of `heights` (a column's layers or water surfaces, from the top down) that lies in the range, to
/// touch_tolerance.
inline std::span<const double> heights_within(std::span<const double> heights, const ZRange& z)
{
    std::size_t first = 0, end = heights.size();
    while (first < end && heights[first] > z.high + touch_tolerance) ++first;
    while (end > first && heights[end - 1] < z.low - touch_tolerance) --end;
    return heights.subspan(first, end - first);
}

/// Returns the top of the highest span that overlaps the range `z`, if it is higher than all `layers`, which are the
/// column's layers within the range; nothing otherwise. Such a span is an obstacle, or terrain whose top is above the
/// range. Both count as obstacles within the range.
inline std::optional<double> obstacle_above(const ColumnView& column, std::span<const double> layers, const ZRange& z)
{
    for (const Span& span : column.spans) {
        if (span.bottom > z.high) continue;
        if (span.top < z.low || (!layers.empty() && span.top <= layers.front())) return std::nullopt;
        return span.top;
    }
    return std::nullopt;
}

/// Which surfaces of a scene the columns contain: all, or only those of solids.
enum class Surfaces { All, Filled };

/// Returns those of a tile's elements, one bit for each, that columns of these surfaces contain.
std::uint64_t counted(const Tile& tile, std::uint64_t elements, Surfaces surfaces);

/// Finds the hits of the vertical line through (x, y), in the order of their elements.
void find_hits(const Geometry& geometry, double x, double y, Surfaces surfaces, std::vector<SurfaceHit>& hits);

/// A grid of columns at x = x0 + (col + shift) * step, y = y0 + (row + shift) * step.
struct ColumnGrid {
    double x0 = 0, y0 = 0, step = 1;
    int first_col = 0, first_row = 0, cols = 0, rows = 0;  ///< the block of columns to compute
    double shift = 0;                                      ///< 0.5: at the centres of cells

    double x_of(int col) const { return x0 + (col + shift) * step; }
    double y_of(int row) const { return y0 + (row + shift) * step; }
};

/// Columns and rows of a block, counted from its first ones; the last ones are included.
struct ColumnRange {
    int first_col, last_col, first_row, last_row;
};

/// The columns of a block of a grid, or at a list of places. They are identical to those that column_at returns one by
/// one.
///
/// If there are many more elements than columns, column after column is looked up in the geometry. Otherwise each
/// element is visited once and added to all columns that it meets (scan conversion): O(elements + columns).
class Columns {
public:
    Columns() = default;
    SPAWNFIELD_MODULE_API Columns(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces = Surfaces::All);

    /// Computes the columns of another block in the same memory, which is faster than fresh memory for each block.
    void set(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces = Surfaces::All);

    /// Returns whether the last block read all tiles in it, because it has many columns for its elements.
    bool are_dense() const { return are_dense_; }

    /// Computes the columns at these places (x, y), m, of which neighbours should follow each other. The column of
    /// places[i] is at(i, 0).
    void set(const Geometry& geometry, std::span<const Vec2> places);

    /// Returns the column in column grid.first_col + i and row grid.first_row + j of the grid.
    ColumnView at(int i, int j) const
    {
        const Slot& slot = slots_[number(i, j)];
        if (slot.round != round_) return {};
        if (!slot.has_more)
            return {{&slot.span, slot.has_span},
                    {&slot.span.top, slot.has_span && slot.span.terrain},
                    {&slot.water, slot.has_water}};
        const Start &from = starts_[slot.index], &to = starts_[slot.index + 1];
        return {std::span(column_.spans).subspan(from.span, to.span - from.span),
                std::span(column_.layers).subspan(from.layer, to.layer - from.layer),
                std::span(column_.water).subspan(from.water, to.water - from.water)};
    }

    /// The heights of a terrain surface and of a water surface, m; NaN for one that does not exist.
    struct OpenGround {
        double terrain, water;
    };
    /// Writes the surfaces of the first columns of a row that contain one terrain surface, at most one water surface,
    /// and nothing else; no surfaces for other columns.
    void open_ground(int j, std::span<OpenGround> out) const
    {
        // A number whose bits are all set is a NaN. There is no branch, because that cannot be foretold.
        const auto if_exists = [](bool exists, double height) {
            return std::bit_cast<double>(std::bit_cast<std::uint64_t>(height) | (std::uint64_t{exists} - 1));
        };
        const Slot* slot = slots_.data() + number(0, j);
        for (OpenGround& ground : out) {
            const bool is_open = (slot->round == round_) & slot->has_span & slot->span.terrain & !slot->has_more;
            ground = {if_exists(is_open, slot->span.top), if_exists(is_open & slot->has_water, slot->water)};
            ++slot;
        }
    }

private:
    /// What a column contains. Most columns have at most one surface of a sheet and one water surface: the slot has
    /// both. All others have more; they are one after the other in column_.
    struct Slot {
        Span span;
        double water = 0;  ///< m
        /// Only if the column has more. While scanning: the last of its other hits, in listed_. Then: its place in
        /// starts_.
        std::uint32_t index = 0;
        bool has_span : 1 = false, has_water : 1 = false, has_more : 1 = false;
        /// The slot is empty if this is not Columns::round_. So a block need not empty all slots before it uses them,
        /// which would take 5 % of the time of a dense raster.
        std::uint16_t round = 0;
    };
    struct Start {
        std::uint32_t span = 0, layer = 0, water = 0;
    };
    /// A hit that its column's slot cannot hold.
    struct ListedHit {
        std::uint32_t hit;   ///< index in hits_; columns share the hits of level triangles
        std::uint32_t next;  ///< index in listed_ of another hit of the column, or `none`
    };
    static constexpr std::uint32_t none = 0xffffffff;
    /// Vertical lines that are compared with the elements of one tile.
    struct Lines {
        static constexpr std::size_t most = 64;
        std::array<Vec2, most> at;             ///< m
        std::array<std::uint32_t, most> slot;  ///< of their columns
    };
    /// A line and a triangle of a tile.
    struct Pair {
        std::uint8_t line, triangle;
    };
    /// Pairs of one tile.
    struct PairList {
        std::array<Pair, Lines::most * TileBoxes::most + FourPairs::width> at;  ///< with room to fill up the last four
        std::size_t count = 0;

        /// Adds a pair if it counts. There is no branch, because that cannot be foretold.
        void add(const Pair& pair, bool counts)
        {
            at[count] = pair;
            count += counts;
        }
    };

    void start(int cols, int rows);
    void look_up(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces);
    void scan(const Geometry& geometry, const ColumnGrid& grid, Surfaces surfaces);
    void add_triangle(const SeenTriangle& seen, const ColumnRange& range);
    void add_columns(const Tile& tile, const ElementBox& box, Surfaces surfaces, const ColumnRange& range);
    void add_grid(const Tile& tile, const ElementBox& box, Surfaces surfaces, const ColumnRange& range);
    void add_from_grid(const Tile& tile, const ElementBox& box, std::uint64_t lines);
    template <class Near>
    void look_in_grid(const Tile& tile, std::uint32_t found, std::uint64_t elements, std::uint32_t line,
                      const Near& near);
    void pair(const Tile& tile, std::uint32_t line, std::uint64_t elements);
    void add_pairs(const Tile& tile, const ElementBox& box);
    void add_inside(Slot& slot, const SeenTriangle& seen, const TrianglePlane& plane, double x, double y);
    void add_rim(Slot& slot, const SeenTriangle& seen, const TrianglePlane& plane, double x, double y);
    void add_primitive(const Tile& tile, std::uint32_t element, const ColumnRange& range);
    void refresh(Slot& slot);
    void add_sheet(Slot& slot, const SeenTriangle& seen, const TrianglePlane& plane, double z);
    SurfaceHit& list_new(Slot& slot);
    void list(Slot& slot, std::uint32_t hit);
    bool is_like_last(const Slot& slot) const;
    void complete_all();
    void complete(Slot& slot);
    void end_column(Slot& slot);
    std::size_t number(int i, int j) const { return std::size_t(j) * std::size_t(cols_) + std::size_t(i); }

    int cols_ = 0;
    std::size_t count_ = 0;    ///< of the block's columns; slots_ may have more
    std::uint16_t round_ = 0;  ///< counts the blocks
    bool are_dense_ = false;
    std::vector<double> x_, y_;  ///< of the block's columns, m, and x of a few more for TriangleSides; while scanning
    Lines lines_;
    PairList pairs_, inside_, rim_;  ///< those to look at, and those of them that meet, or may meet
    std::vector<Slot> slots_;
    Column column_;
    std::vector<Start> starts_;

    // Only used while the columns are computed:
    std::vector<SurfaceHit> hits_;  ///< of all columns of the block, as far as slots cannot hold them
    std::vector<ListedHit> listed_;
    std::vector<std::uint32_t> full_;   ///< the slots whose columns have hits in listed_
    std::vector<std::uint64_t> order_;  ///< a column's hits: the element and, in the lower half, the index in hits_
    std::vector<SurfaceHit> ordered_;   ///< the hits of a column
    const Slot* last_ = nullptr;        ///< the last one that was completed
    std::uint32_t last_hit_ = none;     ///< its index was this one before
    ColumnBuilder builder_;
};

}  // namespace spawnfield

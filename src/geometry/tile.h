#pragma once

#include "base/tile_store.h"

#include <spawnfield/geometry.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <string>

namespace spawnfield {

// The records of a tile have the same bytes in memory and in geometry.bin, without padding. The arrays of records that
// contain doubles come first in a tile, and their sizes are multiples of 8 bytes, so that all arrays are aligned.

/// The bounding box of an element, widened by 1e-8 m and rounded outwards.
struct ElementBox {
    std::array<float, 3> min, max;
};

/// Whether the lower left corner of an element's box lies in this tile's column of tiles (col) and in its row of tiles
/// (row).
struct Home {
    std::uint8_t col, row;
};

struct TileTriangle {
    Triangle corners;     ///< indices in the tile's vertices
    std::uint32_t piece;  ///< index in the tile's pieces
    Label label;
    Home home;
    std::uint8_t unused;
};

struct TilePiece {
    double bottom;        ///< Piece::bottom, m
    std::uint32_t piece;  ///< index in the scene
    std::uint32_t part;
    std::uint8_t solid, open, sides_up;
    std::array<std::uint8_t, 5> unused;
};

struct TilePrimitive {
    std::array<double, 3> size, position;
    std::array<double, 9> rotation;  ///< column by column
    std::uint32_t part;
    ShapeKind kind;
    Label label;
    Home home;

    Shape shape() const { return {kind, Vec3(size.data()), {Vec3(position.data()), Mat3(rotation.data())}}; }
};

struct TileHead {
    double x0, y0, bin;  ///< lower left corner of the tile; side of its bins, m
    std::uint32_t vertices, triangles, primitives, pieces, refs, bin_cols, bin_rows, unused;
};

/// Returns the number of the column or row of cells that contains an offset from the grid's corner. An offset beyond
/// the grid belongs to the outermost cell.
inline std::uint32_t cell_number(double offset, double cell, std::uint32_t count)
{
    return static_cast<std::uint32_t>(std::clamp(std::floor(offset / cell), 0.0, double(count - 1)));
}

/// A view of a tile's bytes as typed arrays. The tile's elements are numbered: first its triangles, then its
/// primitives.
struct Tile {
    const TileHead* head;
    std::span<const Vec3> vertices;
    std::span<const TilePrimitive> primitives;
    std::span<const TilePiece> pieces;
    std::span<const TileTriangle> triangles;
    std::span<const ElementBox> boxes;
    std::span<const std::uint32_t> ids;     ///< the elements' numbers in the scene, ascending
    std::span<const std::uint32_t> starts;  ///< where each bin begins in refs, then the size of refs
    std::span<const std::uint32_t> refs;    ///< elements of the tile, ascending within a bin

    /// Reads the head and finds the arrays behind it. The head's counts must fit the bytes (see tile_size).
    explicit Tile(std::string_view bytes);

    std::uint32_t elements() const { return head->triangles + head->primitives; }
    bool is_triangle(std::uint32_t element) const { return element < head->triangles; }
    std::array<Vec3, 3> corners(std::uint32_t triangle) const
    {
        const Triangle& t = triangles[triangle].corners;
        return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    }
    const TilePrimitive& primitive(std::uint32_t element) const { return primitives[element - head->triangles]; }
    Home home(std::uint32_t element) const
    {
        return is_triangle(element) ? triangles[element].home : primitive(element).home;
    }
    Label label(std::uint32_t element) const
    {
        return is_triangle(element) ? triangles[element].label : primitive(element).label;
    }
    std::uint32_t part(std::uint32_t element) const
    {
        return is_triangle(element) ? pieces[triangles[element].piece].part : primitive(element).part;
    }
    std::uint32_t bin_col(double x) const { return cell_number(x - head->x0, head->bin, head->bin_cols); }
    std::uint32_t bin_row(double y) const { return cell_number(y - head->y0, head->bin, head->bin_rows); }
    std::span<const std::uint32_t> bin(std::uint32_t col, std::uint32_t row) const
    {
        const std::size_t number = std::size_t{row} * head->bin_cols + col;
        return refs.subspan(starts[number], starts[number + 1] - starts[number]);
    }
};

/// Returns the size of a tile with this head, bytes, without the padding at its end.
std::uint64_t tile_size(const TileHead& head);

/// The height range of a run of consecutive elements of a tile. Consecutive elements of a scene are mostly near each
/// other, so that a query can skip whole runs.
struct HeightRun {
    static constexpr std::uint32_t length = 32;  ///< elements
    float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();

    bool meets(const Interval& z) const { return low <= z.top && high >= z.bottom; }
};

struct Geometry::Impl {
    double x0 = 0, y0 = 0;  ///< lower left corner of every level, m
    std::uint64_t elements = 0;
    Bounds bounds;            ///< of all elements
    std::vector<Part> parts;  ///< of the scene, in its order
    LabelCounts labels{};
    bool has_filled_meshes = false;

    Impl() = default;
    Impl(Impl&&) = default;
    Impl& operator=(Impl&&) = delete;
    ~Impl();

    /// Gives the geometry its tiles. A cell of their levels is one tile.
    void set_tiles(TileStore tiles);
    const TileStore& tiles() const { return tiles_; }
    const std::vector<TileLevel>& levels() const { return tiles_.levels(); }

    /// Returns a tile. Throws FileError for a damaged tile of a file.
    Tile open(std::size_t level, std::size_t tile) const
    {
        return Tile(tiles_.open(level, tile, [this](std::string_view bytes) { return is_consistent(bytes); }));
    }

    /// Calls visit(tile, bin) for the bin of each level that contains (x, y).
    template <class Visit>
    void visit_at(double x, double y, const Visit& visit) const
    {
        const double dx = x - x0, dy = y - y0;
        if (dx < 0 || dy < 0) return;
        for (std::size_t l = 0; l < levels().size(); ++l) {
            const TileLevel& level = levels()[l];
            if (dx > level.cell * level.cols || dy > level.cell * level.rows) continue;
            const std::size_t t = std::size_t{cell_number(dy, level.cell, level.rows)} * level.cols +
                                  cell_number(dx, level.cell, level.cols);
            if (level.tiles[t].size == 0) continue;
            const Tile tile = open(l, t);
            visit(tile, tile.bin(tile.bin_col(x), tile.bin_row(y)));
        }
    }

    /// Calls visit(tile, element) once for each element whose box meets the closed rectangle.
    template <class Visit>
    void visit_in(double low_x, double low_y, double high_x, double high_y, const Visit& visit) const
    {
        const auto meets = [&](const ElementBox& box) {
            return box.min[0] <= high_x && box.max[0] >= low_x && box.min[1] <= high_y && box.max[1] >= low_y;
        };
        visit_if(low_x, low_y, high_x, high_y, AnyHeight(), meets, visit);
    }

    /// Calls visit(tile, element) once for each element whose box meets the closed box `space`.
    template <class Visit>
    void visit_in(const Bounds& space, const Visit& visit) const
    {
        const Vec3 &low = space.min, &high = space.max;
        const auto meets = [&](const ElementBox& box) {  // compares heights first: tiles may be tall
            return box.min[2] <= high.z() && box.max[2] >= low.z() && box.min[0] <= high.x() && box.max[0] >= low.x() &&
                   box.min[1] <= high.y() && box.max[1] >= low.y();
        };
        visit_if(low.x(), low.y(), high.x(), high.y(), Interval{low.z(), high.z()}, meets, visit);
    }

    /// Calls visit(tile, element) once for each element whose box fulfils meets(box). For boxes outside the closed
    /// rectangle, meets(box) must be false, but need not be so within a margin of rounding.
    template <class Meets, class Visit>
    void visit_in(double low_x, double low_y, double high_x, double high_y, const Meets& meets,
                  const Visit& visit) const
    {
        visit_if(low_x, low_y, high_x, high_y, AnyHeight(), meets, visit);
    }

    /// Estimates how many elements lie in a rectangle, from the sizes of the tiles that it meets. Each tile counts by
    /// the share of its area in the rectangle.
    double elements_near(double low_x, double low_y, double high_x, double high_y) const;

private:
    struct AnyHeight {};

    /// Calls visit(tile, element) once for each element near the rectangle whose box fulfils meets(box). meets(box)
    /// must be false for boxes outside the rectangle and outside `heights`, which is an Interval, or AnyHeight for no
    /// limit.
    template <class Heights, class Meets, class Visit>
    void visit_if(double low_x, double low_y, double high_x, double high_y, const Heights& heights, const Meets& meets,
                  const Visit& visit) const
    {
        for (std::size_t l = 0; l < levels().size(); ++l) {
            const TileLevel& level = levels()[l];
            // Skips rectangles beyond the grid, because cell_number would return the outermost tiles for them.
            if (high_x < x0 || high_y < y0 || low_x > x0 + level.cell * level.cols ||
                low_y > y0 + level.cell * level.rows)
                continue;
            const std::uint32_t col0 = cell_number(low_x - x0, level.cell, level.cols),
                                col1 = cell_number(high_x - x0, level.cell, level.cols);
            const std::uint32_t row0 = cell_number(low_y - y0, level.cell, level.rows),
                                row1 = cell_number(high_y - y0, level.cell, level.rows);
            for (std::uint32_t row = row0; row <= row1; ++row)
                for (std::uint32_t col = col0; col <= col1; ++col) {
                    const std::size_t t = std::size_t{row} * level.cols + col;
                    if (level.tiles[t].size == 0) continue;
                    const Tile tile = open(l, t);
                    const HeightRun* runs = nullptr;
                    if constexpr (std::is_same_v<Heights, Interval>) runs = height_runs(l, t, tile);
                    const auto may_meet = [&](std::uint32_t element) {
                        if constexpr (std::is_same_v<Heights, Interval>)
                            return runs == nullptr || runs[element / HeightRun::length].meets(heights);
                        else
                            return true;
                    };
                    visit_tile(tile, low_x, low_y, high_x, high_y, may_meet, meets, [&](std::uint32_t element) {
                        // An element may be in several tiles. It is visited in the tile that contains the lower left
                        // corner of the intersection of its box and the rectangle.
                        const ElementBox& box = tile.boxes[element];
                        const Home home = tile.home(element);
                        if ((box.min[0] > low_x ? home.col != 0 : col == col0) &&
                            (box.min[1] > low_y ? home.row != 0 : row == row0))
                            visit(tile, element);
                    });
                }
        }
    }

    /// Calls visit(element) once for each element of the tile whose box fulfils meets(box). may_meet(element) must be
    /// the same for all elements of a HeightRun; if it is false, the run is skipped.
    template <class MayMeet, class Meets, class Visit>
    static void visit_tile(const Tile& tile, double low_x, double low_y, double high_x, double high_y,
                           const MayMeet& may_meet, const Meets& meets, const Visit& visit)
    {
        const std::uint32_t col0 = tile.bin_col(low_x), col1 = tile.bin_col(high_x), row0 = tile.bin_row(low_y),
                            row1 = tile.bin_row(high_y);
        // If the rectangle covers most bins, all elements are visited in their order instead of bin by bin.
        if (2.0 * (col1 - col0 + 1) * (row1 - row0 + 1) > double(tile.head->bin_cols) * tile.head->bin_rows) {
            for (std::uint32_t first = 0; first < tile.elements(); first += HeightRun::length) {
                if (!may_meet(first)) continue;
                const std::uint32_t end = std::min(tile.elements(), first + HeightRun::length);
                for (std::uint32_t element = first; element < end; ++element)
                    if (meets(tile.boxes[element])) visit(element);
            }
            return;
        }
        Visits& visits = visits_of_thread();
        visits.start(tile.elements());
        for (std::uint32_t row = row0; row <= row1; ++row)
            for (std::uint32_t col = col0; col <= col1; ++col)
                for (const std::uint32_t element : tile.bin(col, row))
                    if (may_meet(element) && meets(tile.boxes[element]) && visits.is_first(element)) visit(element);
    }

    /// Remembers which elements of a tile were visited, because an element may be in several bins.
    class Visits {
    public:
        void start(std::size_t element_count)
        {
            if (stamps_.size() < element_count) stamps_.resize(element_count, 0);
            if (++round_ != 0) return;
            std::fill(stamps_.begin(), stamps_.end(), 0);
            round_ = 1;
        }
        bool is_first(std::uint32_t element)
        {
            if (stamps_[element] == round_) return false;
            stamps_[element] = round_;
            return true;
        }

    private:
        std::vector<std::uint32_t> stamps_;
        std::uint32_t round_ = 0;
    };
    /// Returns the Visits of the calling thread. They serve one visit at a time: `visit` must not start another visit
    /// in the same thread.
    static Visits& visits_of_thread();

    /// Returns whether all counts and indices of a tile fit its bytes and the number of parts.
    bool is_consistent(std::string_view bytes) const;

    /// Returns the height runs of a tile with many elements; nullptr for other tiles. The first call for a tile makes
    /// its runs, which take a quarter of a byte for each element.
    const HeightRun* height_runs(std::size_t level, std::size_t number, const Tile& tile) const
    {
        constexpr std::uint32_t many = 16 * HeightRun::length;
        if (tile.elements() < many) return nullptr;
        const HeightRun* const made = runs_[level][number].load(std::memory_order_acquire);
        return made != nullptr ? made : make_height_runs(level, number, tile);
    }
    const HeightRun* make_height_runs(std::size_t level, std::size_t number, const Tile& tile) const;

    TileStore tiles_;
    mutable std::vector<std::unique_ptr<std::atomic<const HeightRun*>[]>> runs_;  ///< owned; nullptr: not made yet
};

}  // namespace spawnfield

#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace spawnfield {

// A heightmap is a grid of rectangular cells with two triangles each. A tile of such triangles stores which triangle is
// in which half of which cell. So the triangle at a place is found by its coordinates, without a look at the others.

/// How large the grid of a tile is; 0 columns if it has none.
struct TriangleGridSize {
    static constexpr std::uint8_t most = 16;  ///< columns or rows
    std::uint8_t cols, rows;
    std::uint8_t is_rising;  ///< 1: each diagonal joins the corners at the smallest and largest x and y; 0: the others
    std::uint8_t unused;

    bool exists() const { return cols > 0; }
    std::size_t halves() const { return std::size_t{2} * cols * rows; }  ///< of cells
    std::size_t bytes() const;                                           ///< of the whole grid, a multiple of 8
};
static_assert(sizeof(TriangleGridSize) == 4);

struct TriangleGridHead {
    std::array<double, 2> low;        ///< x and y of the first cell's corner, m
    std::array<double, 2> per_metre;  ///< cells, along x and y
    std::uint64_t members;            ///< a bit for each triangle of the tile that is in the grid
};
static_assert(sizeof(TriangleGridHead) == 40);

inline std::size_t TriangleGridSize::bytes() const
{
    return exists() ? sizeof(TriangleGridHead) + (halves() + 7) / 8 * 8 : 0;
}

/// A view of the grid of a tile: the head, then for each cell the numbers of its lower and its upper triangle, row by
/// row, from the smallest x and y on.
class TriangleGrid {
public:
    static constexpr std::uint32_t none = 64;  ///< in place of a triangle that is not in the grid
    static constexpr std::uint32_t rim = 65;   ///< within `margin` of an edge or diagonal: compare all triangles

    /// How far corners of triangles may be from those of cells, in cells.
    static constexpr double tolerance = 0.001;
    /// How far a place must be from edges for an answer, in cells. Corners beyond their cells take up to 0.002 of it at
    /// a diagonal. What is left is at least 2 um (least_cell), far more than touch_tolerance and all rounding.
    static constexpr float margin = 0.004F;
    static constexpr double least_cell = 0.001;  ///< m

    /// `bytes` are those of a grid of this size.
    TriangleGrid(const TriangleGridSize& size, const char* bytes)
        : size_(size), head_(reinterpret_cast<const TriangleGridHead*>(bytes)),
          halves_(reinterpret_cast<const std::uint8_t*>(bytes + sizeof(TriangleGridHead)))
    {
    }

    std::uint64_t members() const { return head_->members; }
    std::span<const std::uint8_t> halves() const { return {halves_, size_.halves()}; }

    /// Where a coordinate lies along x or y.
    struct Along {
        std::uint32_t cell;    ///< its number; 0 if it is outside
        float part;            ///< of the cell, 0 .. 1; along x, from the side where a diagonal is lowest
        bool at_rim, outside;  ///< of the grid
    };
    Along along_x(double x) const
    {
        Along out = along(0, x, size_.cols);
        if (size_.is_rising == 0) out.part = 1 - out.part;
        return out;
    }
    Along along_y(double y) const { return along(1, y, size_.rows); }

    /// Returns the number of the triangle in the grid that contains a place, or `none` or `rim`.
    std::uint32_t find(const Along& x, const Along& y) const
    {
        const float above = y.part - x.part;  // the diagonal
        const std::uint32_t half = 2 * (y.cell * size_.cols + x.cell) + std::uint32_t(above > 0);
        const bool is_outside = x.outside | y.outside;  // `|`: no branches, because they cannot be foretold
        const bool is_at_rim = x.at_rim | y.at_rim | !(std::abs(above) > margin);
        const std::uint32_t found = is_outside ? none : halves_[half];
        return is_at_rim ? rim : found;
    }

private:
    Along along(std::size_t axis, double at, std::uint32_t cells) const
    {
        const double in_cells = (at - head_->low[axis]) * head_->per_metre[axis];
        const bool is_in = (in_cells > 0) & (in_cells < double(cells));
        const bool is_near = (in_cells > -double(margin)) & (in_cells < double(cells) + double(margin));
        const auto cell = std::int32_t(is_in ? in_cells : 0);
        const auto part = float(in_cells - cell);
        const bool is_clear = (part > margin) & (part < 1 - margin);
        return {std::uint32_t(cell), part, is_near && !is_clear, !is_in};
    }

    TriangleGridSize size_;
    const TriangleGridHead* head_;
    const std::uint8_t* halves_;
};

/// Returns whether the numbers in a grid are those of triangles of a tile that has `triangles` of them.
bool is_consistent_grid(const TriangleGridSize& size, const TriangleGrid& grid, std::uint32_t triangles);

/// A grid, and its bytes; none if the size says so.
struct GridBytes {
    TriangleGridSize size{};
    std::string bytes;
};

using TriangleFromAbove = std::array<std::array<double, 2>, 3>;  ///< x and y of the three corners, m

/// Finds the grid that the triangles of a tile form; none if there are fewer than 16 of them in it.
GridBytes triangle_grid_of(std::span<const TriangleFromAbove> triangles);

}  // namespace spawnfield

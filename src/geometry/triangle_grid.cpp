#include "geometry/triangle_grid.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

namespace spawnfield {
namespace {

struct Extent {
    double low, high;
};

/// Returns how far a triangle's corners reach along an axis, m.
Extent extent_of(const TriangleFromAbove& corners, std::size_t axis)
{
    const auto [low, high] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    return {low, high};
}

/// The lines of a grid along one axis.
struct Lattice {
    double low, cell;  ///< m

    double of(double at) const { return (at - low) / cell; }
};

/// The half of a cell that a triangle fills.
struct Half {
    std::array<int, 2> cell;
    bool is_rising, is_upper;
};

/// Returns the half of a cell whose corners are those of a triangle, to `tolerance` (in cells), if there is one.
std::optional<Half> half_of(const TriangleFromAbove& corners, const std::array<Lattice, 2>& lattices, double tolerance)
{
    constexpr double most = 1e6;  // cells
    Half out{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double low = lattices[axis].of(extent_of(corners, axis).low);
        if (!(std::abs(low) < most)) return std::nullopt;
        out.cell[axis] = int(std::lround(low));
    }
    // Corner k of a cell has the larger x if bit 0 of k is set, and the larger y if bit 1 is set.
    unsigned found = 0;
    for (const auto& corner : corners) {
        unsigned number = 0;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const double from_cell = lattices[axis].of(corner[axis]) - out.cell[axis];
            const bool is_high = from_cell > 0.5;
            if (!(std::abs(from_cell - (is_high ? 1 : 0)) <= tolerance)) return std::nullopt;
            number |= unsigned{is_high} << axis;
        }
        found |= 1U << number;
    }
    if (std::popcount(found) != 3) return std::nullopt;
    const int missing = std::countr_one(found);
    out.is_rising = missing == 1 || missing == 2;
    out.is_upper = missing < 2;
    return out;
}

/// Returns the grid whose first cell is around this triangle, if it has the right angle of a half of a cell.
std::optional<std::array<Lattice, 2>> lattices_of(const TriangleFromAbove& corners)
{
    std::array<Lattice, 2> out;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const Extent extent = extent_of(corners, axis);
        out[axis] = {extent.low, extent.high - extent.low};
        if (!(out[axis].cell >= TriangleGrid::least_cell)) return std::nullopt;
    }
    if (!half_of(corners, out, TriangleGrid::tolerance)) return std::nullopt;
    return out;
}

/// Returns the same grid, so that its first cell is the first one of all triangles that are halves of cells, and its
/// cells have their average size; none if it is too large.
std::optional<std::array<Lattice, 2>> fitted(const std::array<Lattice, 2>& lattices,
                                             std::span<const TriangleFromAbove> triangles, TriangleGridSize& size)
{
    constexpr double rough = 0.1;  // cells: many of them, counted from one triangle's size
    std::array<Lattice, 2> out = lattices;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        Extent extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (const TriangleFromAbove& corners : triangles)
            if (half_of(corners, lattices, rough)) {
                const Extent here = extent_of(corners, axis);
                extent = {std::min(extent.low, here.low), std::max(extent.high, here.high)};
            }
        const double cells = std::round((extent.high - extent.low) / lattices[axis].cell);
        if (!(cells >= 1 && cells <= TriangleGridSize::most)) return std::nullopt;
        out[axis] = {extent.low, (extent.high - extent.low) / cells};
        (axis == 0 ? size.cols : size.rows) = std::uint8_t(cells);
    }
    return out;
}

}  // namespace

bool is_consistent_grid(const TriangleGridSize& size, const TriangleGrid& grid, std::uint32_t triangles)
{
    if (size.cols > TriangleGridSize::most || size.rows > TriangleGridSize::most) return false;
    const auto is_known = [&](std::uint8_t number) { return number < triangles || number == TriangleGrid::none; };
    return std::bit_width(grid.members()) <= triangles &&
           std::all_of(grid.halves().begin(), grid.halves().end(), is_known);
}

GridBytes triangle_grid_of(std::span<const TriangleFromAbove> triangles)
{
    constexpr int least = 16;  // with fewer triangles in it, a grid saves little
    if (triangles.size() < least || triangles.size() > TriangleGrid::none) return {};
    const TriangleFromAbove& middle = triangles[triangles.size() / 2];
    const auto rough = lattices_of(middle);
    if (!rough) return {};
    GridBytes out;
    const auto lattices = fitted(*rough, triangles, out.size);
    const auto of_middle = lattices ? half_of(middle, *lattices, TriangleGrid::tolerance) : std::nullopt;
    if (!of_middle) return {};
    out.size.is_rising = of_middle->is_rising;
    TriangleGridHead head{
        {(*lattices)[0].low, (*lattices)[1].low}, {1 / (*lattices)[0].cell, 1 / (*lattices)[1].cell}, 0};
    std::string halves(out.size.bytes() - sizeof head, '\0');
    std::fill_n(halves.begin(), out.size.halves(), char(TriangleGrid::none));
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const auto half = half_of(triangles[t], *lattices, TriangleGrid::tolerance);
        if (!half || half->is_rising != of_middle->is_rising) continue;
        const auto [col, row] = half->cell;
        if (col < 0 || row < 0 || col >= out.size.cols || row >= out.size.rows) continue;
        char& number = halves[std::size_t(2 * (row * out.size.cols + col) + int{half->is_upper})];
        if (number != char(TriangleGrid::none)) continue;  // one triangle above another
        number = char(t);
        head.members |= std::uint64_t{1} << t;
    }
    if (std::popcount(head.members) < least) return {};
    out.bytes.assign(reinterpret_cast<const char*>(&head), sizeof head);
    out.bytes += halves;
    return out;
}

}  // namespace spawnfield

#pragma once

#include <spawnfield/export.h>
#include <spawnfield/query.h>

#include <vector>

namespace spawnfield {

/// One layer of a square of columns of a 2D raster, whose poses all have one verdict. Each column is the middle of a
/// square whose side is the step of the raster; the cell consists of these squares.
struct RasterCell {
    int col = 0, row = 0;      ///< of its first column, in RasterResult::grid
    int side = 1;              ///< number of columns along a side: a power of 2
    std::size_t pose = 0;      ///< index in RasterResult::poses: of column col + side / 2 in row row + side / 2
    double low = 0, high = 0;  ///< m: lowest and highest z of its poses on this layer
};

/// Returns large cells where many poses of a 2D raster have one verdict, and small ones near edges: together, they have
/// each pose once. A cell contains whole columns of the grid, which have equal layers with equal verdicts (with a
/// HeadingRule of several headings: that are also valid at equal headings). If that is not so in a square of columns,
/// the square is divided into four. The largest ones begin at the first column and row of the grid.
///
/// The cells are in the order of their poses. So the first cell of several layers is the highest one. O(poses +
/// columns). Throws ArgumentError for a raster with other dims than 2.
SPAWNFIELD_API std::vector<RasterCell> raster_cells(const RasterResult& raster);

/// Writes the columns of write_raster_csv() for the pose of each cell, and size,x_low,y_low,z_low,z_high, m: the cell
/// is the square from x_low, y_low to x_low + size, y_low + size, and its poses are z_low to z_high.
/// Passes the text to `sink` in pieces.
SPAWNFIELD_API void write_raster_cells_csv(const RasterResult& raster, const std::vector<RasterCell>& cells,
                                           const std::function<void(std::string_view)>& sink, int threads = 0);

}  // namespace spawnfield

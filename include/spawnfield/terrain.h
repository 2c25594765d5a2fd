#pragma once

#include <spawnfield/export.h>
#include <spawnfield/column.h>

#include <limits>
#include <string>
#include <vector>

namespace spawnfield {

/// A raster over the ground. Row 0 is the largest y, column 0 the smallest x.
struct GridFrame {
    double x0 = 0, y0 = 0;  ///< lower left corner of the raster, m
    double cell = 0.1;      ///< side of a cell, m
    int rows = 0, cols = 0;

    double x_of(int col) const { return x0 + (col + 0.5) * cell; }         ///< of the cell's centre
    double y_of(int row) const { return y0 + (rows - row - 0.5) * cell; }  ///< of the cell's centre
};

/// Cells of side `cell` that cover the bounds from their lower limits on. Throws ArgumentError unless cell > 0 and
/// there are at most max_columns of them.
SPAWNFIELD_API GridFrame frame_around(const Bounds& bounds, double cell);
inline constexpr double max_columns = 1e8;
inline constexpr double max_side = 1e6;  ///< rows or columns, as libpng takes them

/// A value for each cell of a raster, row after row; row 0 is the largest y. NaN where there is nothing.
struct HeightImage {
    int rows = 0, cols = 0;
    std::vector<float> values = {};  ///< rows * cols; heights in m

    HeightImage() = default;
    HeightImage(int rows_, int cols_, float value = std::numeric_limits<float>::quiet_NaN())
        : rows(rows_), cols(cols_), values(std::size_t(rows_) * std::size_t(cols_), value)
    {
    }
    float operator()(int row, int col) const { return values[std::size_t(row) * std::size_t(cols) + std::size_t(col)]; }
    float& operator()(int row, int col) { return values[std::size_t(row) * std::size_t(cols) + std::size_t(col)]; }
};

/// What stands in each column of a raster, as pages of float32 metres; NaN where there is nothing.
///
/// height.K       layer K at the cell's centre, K = 0 the highest
/// water          highest water surface at the cell's centre
/// obstacle       highest obstacle at the cell's centre where it stands above height.0, or where there is no terrain
///
/// Pages are kept as deflated tiles of tile x tile cells, row after row, the last ones padded with NaN: a tile of
/// nothing takes about 300 bytes. There are no pages of nothing but height.0.
struct TerrainMap {
    static constexpr int tile = 256;
    struct Page {
        std::string name;                ///< "height.0", …
        std::vector<std::string> tiles;  ///< zlib streams (TIFF predictor 3), row after row of tiles
    };
    GridFrame frame;
    std::vector<Page> pages;

    int tile_rows() const { return (frame.rows + tile - 1) / tile; }
    int tile_cols() const { return (frame.cols + tile - 1) / tile; }
    SPAWNFIELD_API const Page* find(const std::string& name) const;  ///< nullptr if there is no such page
    SPAWNFIELD_API int layers() const;                               ///< number of height pages
};

/// A whole page, frame.rows x frame.cols; all NaN if there is no such page. Throws std::runtime_error on damaged tiles.
SPAWNFIELD_API HeightImage page_image(const TerrainMap& terrain, const std::string& name);

/// The highest layer of each cell within a range of heights, frame.rows x frame.cols, m; NaN where there is none.
/// Throws std::runtime_error on damaged tiles.
SPAWNFIELD_API HeightImage highest_within(const TerrainMap& terrain, const ZRange& z);

/// Vertical rays at the cells' centres. Layers and water beyond the z limits are left out, and so are obstacles that
/// begin above them or end below them. O(elements + cells covered).
SPAWNFIELD_API TerrainMap rasterize_terrain(const Geometry& geometry, const GridFrame& frame, int threads = 0,
                                            const Progress& progress = {}, const ZRange& z_limits = {});

}  // namespace spawnfield

#pragma once

#include <spawnfield/export.h>
#include <spawnfield/column.h>

#include <limits>
#include <string>
#include <vector>

namespace spawnfield {

/// The place and the size of a raster in the x-y plane. Row 0 is the largest y, column 0 the smallest x.
struct GridFrame {
    double x0 = 0, y0 = 0;  ///< lower left corner of the raster, m
    double cell = 0.1;      ///< side of a cell, m
    int rows = 0, cols = 0;

    double x_of(int col) const { return x0 + (col + 0.5) * cell; }         ///< x of the cells' centres
    double y_of(int row) const { return y0 + (rows - row - 0.5) * cell; }  ///< y of the cells' centres
};

/// Returns a raster of cells of side `cell` that covers the bounds; its lower left corner is theirs. Throws
/// ArgumentError unless cell > 0, and for more than max_columns cells or more than max_side rows or columns.
SPAWNFIELD_API GridFrame frame_around(const Bounds& bounds, double cell);
inline constexpr double max_columns = 1e8;
inline constexpr double max_side = 1e6;  ///< most rows, and most columns, because libpng accepts no more

/// A value for each cell of a raster; row 0 is the largest y. A cell without a value is NaN.
struct HeightImage {
    int rows = 0, cols = 0;
    std::vector<float> values = {};  ///< rows * cols, row after row; heights in m

    HeightImage() = default;
    HeightImage(int rows_, int cols_, float value = std::numeric_limits<float>::quiet_NaN())
        : rows(rows_), cols(cols_), values(std::size_t(rows_) * std::size_t(cols_), value)
    {
    }
    float operator()(int row, int col) const { return values[std::size_t(row) * std::size_t(cols) + std::size_t(col)]; }
    float& operator()(int row, int col) { return values[std::size_t(row) * std::size_t(cols) + std::size_t(col)]; }
};

/// The heights of terrain, water and obstacles in each cell of a raster, as pages of float32 metres. A cell without
/// such a height is NaN.
///
/// height.K       layer K at the cell's centre; layer 0 is the highest
/// water          highest water surface at the cell's centre
/// obstacle       highest obstacle at the cell's centre, if it is higher than height.0 or if there is no terrain
///
/// Pages are kept as deflated tiles of tile x tile cells, row after row. Tiles at the end of a row or column are padded
/// with NaN. A tile that is all NaN takes about 300 bytes. Pages that are all NaN are left out, except height.0.
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

/// Returns a whole page, frame.rows x frame.cols; all NaN if there is no such page. Throws std::runtime_error on
/// damaged tiles.
SPAWNFIELD_API HeightImage page_image(const TerrainMap& terrain, const std::string& name);

/// Returns the height of the highest layer within the range `z` in each cell, frame.rows x frame.cols, m; NaN where
/// there is none. Throws std::runtime_error on damaged tiles.
SPAWNFIELD_API HeightImage highest_within(const TerrainMap& terrain, const ZRange& z);

/// Returns the heights at which vertical lines through the cells' centres meet the scene. Layers and water beyond the z
/// limits are left out, and so are obstacles that begin above the limits or end below them. O(elements + cells that
/// they cover).
SPAWNFIELD_API TerrainMap rasterize_terrain(const Geometry& geometry, const GridFrame& frame, int threads = 0,
                                            const Progress& progress = {}, const ZRange& z_limits = {});

}  // namespace spawnfield

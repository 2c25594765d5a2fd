#include "base/deflate.h"
#include "base/number.h"
#include "base/parallel.h"
#include "map/cell_clip.h"

#include <spawnfield/error.h>
#include <spawnfield/terrain.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr std::size_t max_spans = 8;  // pages of solid_*
constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

/// Pages of one tile, by name without number; made as they are needed.
struct TilePages {
    using Values = std::vector<float>;
    std::vector<Values> height, solid_top, solid_bottom;
    Values water;

    static float& at(std::vector<Values>& pages, std::size_t page, std::size_t cell)
    {
        while (pages.size() <= page) pages.emplace_back(TerrainMap::tile * TerrainMap::tile, nothing);
        return pages[page][cell];
    }
};

class TileRaster {
public:
    TileRaster(const Geometry& geometry, const GridFrame& frame, int tile_row, int tile_col)
        : geometry_(geometry), frame_(frame), row0_(tile_row * TerrainMap::tile), col0_(tile_col * TerrainMap::tile),
          rows_(std::min(TerrainMap::tile, frame.rows - row0_)), cols_(std::min(TerrainMap::tile, frame.cols - col0_))
    {
    }

    TilePages run()
    {
        const Columns centres(geometry_, {frame_.x0, frame_.y0, frame_.cell, col0_, frame_.rows - row0_ - rows_, cols_, rows_, 0.5});
        for (int j = 0; j < rows_; ++j)  // upwards in y, as the block counts
            for (int i = 0; i < cols_; ++i) add_cell(rows_ - 1 - j, i, centres.at(i, j));
        return std::move(pages_);
    }

private:
    void add_cell(int row, int col, const ColumnView& column)
    {
        const std::size_t cell = std::size_t(row) * TerrainMap::tile + std::size_t(col);
        for (std::size_t layer = 0; layer < column.layers.size(); ++layer)
            TilePages::at(pages_.height, layer, cell) = float(column.layers[layer]);
        if (!column.water.empty()) {
            if (pages_.water.empty()) pages_.water.assign(TerrainMap::tile * TerrainMap::tile, nothing);
            pages_.water[cell] = float(column.water.front());
        }
        const std::vector<Interval> solid = solid_intervals(column);
        for (std::size_t k = 0; k < std::min(solid.size(), max_spans); ++k) {
            const Interval& span = solid[solid.size() - 1 - k];
            TilePages::at(pages_.solid_top, k, cell) = float(span.top);
            TilePages::at(pages_.solid_bottom, k, cell) = float(span.bottom);
        }
    }

    const Geometry& geometry_;
    const GridFrame& frame_;
    const int row0_, col0_, rows_, cols_;
    TilePages pages_;
};

std::string deflated(const std::vector<float>& values)
{
    return deflate_bytes({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
}

/// A tile's pages by full name.
using NamedTiles = std::vector<std::pair<std::string, std::string>>;

NamedTiles deflate_tile(const TilePages& pages)
{
    NamedTiles out;
    const auto add = [&](const std::string& name, const std::vector<TilePages::Values>& list) {
        for (std::size_t k = 0; k < list.size(); ++k) out.emplace_back(name + "." + std::to_string(k), deflated(list[k]));
    };
    add("height", pages.height);
    if (!pages.water.empty()) out.emplace_back("water", deflated(pages.water));
    add("solid_top", pages.solid_top);
    add("solid_bottom", pages.solid_bottom);
    return out;
}

std::vector<std::string> page_names(const std::vector<NamedTiles>& tiles)
{
    std::vector<std::string> out;
    for (const char* quantity : {"height", "water", "solid_top", "solid_bottom", "bound_top", "bound_bottom"}) {
        const std::string name = quantity;
        std::size_t count = name == "height" ? 1 : 0;  // a page of heights even if there is no terrain
        for (const NamedTiles& tile : tiles)
            count = std::max(count, std::size_t(std::count_if(tile.begin(), tile.end(), [&](const auto& page) {
                return page.first == name || page.first.starts_with(name + ".");
            })));
        for (std::size_t k = 0; k < count; ++k) out.push_back(name == "water" ? name : name + "." + std::to_string(k));
    }
    return out;
}

}  // namespace

GridFrame frame_around(const Bounds& bounds, double cell)
{
    if (!(cell > 0) || !std::isfinite(cell)) throw ArgumentError("frame_around", "cell", cell, "> 0 m");
    const auto count = [&](int axis) { return std::max(1.0, std::ceil((bounds.max[axis] - bounds.min[axis]) / cell - 1e-9)); };
    const double cols = count(0), rows = count(1);
    if (!(cols * rows <= max_columns))
        throw ArgumentError("frame_around", "columns at a cell of " + number(cell) + " m", cols * rows,
                            "at most " + number(max_columns) + "; take a coarser resolution");
    if (!(std::max(cols, rows) <= max_side))
        throw ArgumentError("frame_around", "columns along one side at a cell of " + number(cell) + " m", std::max(cols, rows),
                            "at most " + number(max_side) + " (PNG's limit); take a coarser resolution");
    return {bounds.min.x(), bounds.min.y(), cell, int(rows), int(cols)};
}

const TerrainMap::Page* TerrainMap::find(const std::string& name) const
{
    const auto page = std::find_if(pages.begin(), pages.end(), [&](const Page& p) { return p.name == name; });
    return page == pages.end() ? nullptr : &*page;
}

int TerrainMap::layers() const
{
    return int(std::count_if(pages.begin(), pages.end(), [](const Page& p) { return p.name.starts_with("height."); }));
}

HeightImage page_image(const TerrainMap& terrain, const std::string& name)
{
    HeightImage image = HeightImage::Constant(terrain.frame.rows, terrain.frame.cols, nothing);
    const TerrainMap::Page* page = terrain.find(name);
    if (page == nullptr) return image;
    using Pixels = Eigen::Array<float, TerrainMap::tile, TerrainMap::tile, Eigen::RowMajor>;
    for (std::size_t t = 0; t < page->tiles.size(); ++t) {
        const std::string bytes = inflate_bytes(page->tiles[t], sizeof(Pixels));
        const int row = int(t) / terrain.tile_cols() * TerrainMap::tile, col = int(t) % terrain.tile_cols() * TerrainMap::tile;
        const int rows = std::min(TerrainMap::tile, terrain.frame.rows - row), cols = std::min(TerrainMap::tile, terrain.frame.cols - col);
        const Eigen::Map<const Pixels, Eigen::Unaligned> tile(reinterpret_cast<const float*>(bytes.data()));
        image.block(row, col, rows, cols) = tile.topLeftCorner(rows, cols);
    }
    return image;
}

TerrainMap rasterize_terrain(const Geometry& geometry, const GridFrame& frame, int threads,
                             const Progress& progress)
{
    TerrainMap out;
    out.frame = frame;
    std::vector<NamedTiles> tiles(std::size_t(out.tile_rows()) * std::size_t(out.tile_cols()));
    parallel_for(tiles.size(), threads, progress, [&](std::size_t t) {
        TileRaster raster(geometry, frame, int(t) / out.tile_cols(), int(t) % out.tile_cols());
        tiles[t] = deflate_tile(raster.run());
    });
    const std::string empty = deflated(std::vector<float>(TerrainMap::tile * TerrainMap::tile, nothing));
    for (const std::string& name : page_names(tiles)) {
        TerrainMap::Page page{name, {}};
        for (NamedTiles& tile : tiles) {
            const auto found = std::find_if(tile.begin(), tile.end(), [&](const auto& p) { return p.first == name; });
            page.tiles.push_back(found == tile.end() ? empty : std::move(found->second));
        }
        out.pages.push_back(std::move(page));
    }
    return out;
}

}  // namespace spawnfield

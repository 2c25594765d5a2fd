#include "base/deflate.h"
#include "base/number.h"
#include "base/parallel.h"
#include "column/columns.h"
#include "column/uniform_column.h"
#include "map/changed_terrain.h"

#include <spawnfield/error.h>
#include <spawnfield/terrain.h>

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t page_tile_cells = std::size_t(TerrainMap::tile) * TerrainMap::tile;

std::string deflated(const std::vector<float>& values) { return deflate_floats(values, TerrainMap::tile); }

const std::string& empty_tile()
{
    static const std::string stream = deflated(std::vector<float>(page_tile_cells, nothing));
    return stream;
}

/// Returns whether a tile is all NaN. Another version of zlib may have written other bytes than those of empty_tile().
bool is_empty(const std::string& stream)
{
    if (stream == empty_tile()) return true;
    if (stream.size() > 2 * empty_tile().size()) return false;
    std::vector<float> values(page_tile_cells);
    inflate_floats(stream, TerrainMap::tile, values);
    return std::all_of(values.begin(), values.end(), [](float value) { return std::isnan(value); });
}

/// The pages of one tile. A page is made when the first height is set.
template <class Page>
struct TilePages {
    std::vector<Page> height;
    Page water, obstacle;  ///< empty: has no heights
};

class TileRaster {
public:
    TileRaster(const Geometry& geometry, const GridFrame& frame, const ZRange& z_limits, int tile_row, int tile_col)
        : geometry_(geometry), frame_(frame), z_limits_(z_limits), row0_(tile_row * TerrainMap::tile),
          col0_(tile_col * TerrainMap::tile), rows_(std::min(TerrainMap::tile, frame.rows - row0_)),
          cols_(std::min(TerrainMap::tile, frame.cols - col0_))
    {
    }

    TilePages<std::string> run()
    {
        scan();
        TilePages<std::string> out;
        for (const auto& layer : pages_.height) out.height.push_back(deflated(layer));
        if (!pages_.water.empty()) out.water = deflated(pages_.water);
        if (!pages_.obstacle.empty()) out.obstacle = deflated(pages_.obstacle);
        return out;
    }

    /// Returns the largest number of layers in a cell of the tile.
    std::size_t count_layers()
    {
        scan();
        return pages_.height.size();
    }

private:
    void scan()
    {
        constexpr int part = 64;  // cells; the columns of part x part cells stay in a core's cache
        const int first_row = frame_.rows - row0_ - rows_;
        Columns centres;
        for (int j0 = 0; j0 < rows_; j0 += part)  // upwards in y, like the rows of Columns
            for (int i0 = 0; i0 < cols_; i0 += part) {
                const int rows = std::min(part, rows_ - j0), cols = std::min(part, cols_ - i0);
                const double x0 = frame_.x0 + (col0_ + i0) * frame_.cell,
                             y0 = frame_.y0 + (first_row + j0) * frame_.cell;
                if (const auto same = uniform_column(geometry_,
                                                     {x0, y0, x0 + cols * frame_.cell, y0 + rows * frame_.cell})) {
                    for (int j = 0; j < rows; ++j)
                        for (int i = 0; i < cols; ++i) add_cell(rows_ - 1 - j0 - j, i0 + i, *same);
                    continue;
                }
                centres.set(geometry_,
                            {frame_.x0, frame_.y0, frame_.cell, col0_ + i0, first_row + j0, cols, rows, 0.5});
                for (int j = 0; j < rows; ++j)
                    for (int i = 0; i < cols; ++i) add_cell(rows_ - 1 - j0 - j, i0 + i, centres.at(i, j));
            }
    }

    void add_cell(int row, int col, const ColumnView& column)
    {
        const std::size_t cell = std::size_t(row) * TerrainMap::tile + std::size_t(col);
        const std::span<const double> layers = heights_within(column.layers, z_limits_),
                                      water = heights_within(column.water, z_limits_);
        while (pages_.height.size() < layers.size()) pages_.height.emplace_back();
        for (std::size_t layer = 0; layer < layers.size(); ++layer) set(pages_.height[layer], cell, layers[layer]);
        if (!water.empty()) set(pages_.water, cell, water.front());
        if (const auto top = obstacle_above(column, layers, z_limits_)) set(pages_.obstacle, cell, *top);
    }

    static void set(std::vector<float>& page, std::size_t cell, double height)
    {
        if (page.empty()) page.assign(page_tile_cells, nothing);
        page[cell] = float(height);
    }

    const Geometry& geometry_;
    const GridFrame& frame_;
    const ZRange& z_limits_;
    const int row0_, col0_, rows_, cols_;
    TilePages<std::vector<float>> pages_;
};

/// Moves the tiles of one page from `tiles` to a new page of `out`. If no tile has heights, the page is only added with
/// even_if_empty.
void add_page(const std::string& name, std::vector<TilePages<std::string>>& tiles, bool even_if_empty, TerrainMap& out,
              const auto& stream_of)
{
    TerrainMap::Page page{name, {}};
    bool any = even_if_empty;
    for (auto& tile : tiles) {
        std::string* const stream = stream_of(tile);
        const bool some = stream != nullptr && !stream->empty();
        any = any || some;
        page.tiles.push_back(some ? std::move(*stream) : empty_tile());
    }
    if (any) out.pages.push_back(std::move(page));
}

}  // namespace

GridFrame frame_around(const Bounds& bounds, double cell)
{
    if (!(cell > 0) || !std::isfinite(cell)) throw ArgumentError("frame_around", "cell", cell, "> 0 m");
    const auto count = [&](int axis) {
        return std::max(1.0, std::ceil((bounds.max[axis] - bounds.min[axis]) / cell - 1e-9));
    };
    const double cols = count(0), rows = count(1);
    if (!(cols * rows <= max_columns))
        throw ArgumentError("frame_around", "columns at a cell of " + number(cell) + " m", cols * rows,
                            "at most " + number(max_columns) + "; take a coarser resolution");
    if (!(std::max(cols, rows) <= max_side))
        throw ArgumentError("frame_around", "columns along one side at a cell of " + number(cell) + " m",
                            std::max(cols, rows),
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
    HeightImage image(terrain.frame.rows, terrain.frame.cols);
    const TerrainMap::Page* page = terrain.find(name);
    if (page == nullptr) return image;
    HeightImage tile(TerrainMap::tile, TerrainMap::tile);
    for (std::size_t t = 0; t < page->tiles.size(); ++t) {
        if (page->tiles[t] == empty_tile()) continue;
        inflate_floats(page->tiles[t], TerrainMap::tile, tile.values);
        const int row = int(t) / terrain.tile_cols() * TerrainMap::tile,
                  col = int(t) % terrain.tile_cols() * TerrainMap::tile;
        const int rows = std::min(TerrainMap::tile, terrain.frame.rows - row),
                  cols = std::min(TerrainMap::tile, terrain.frame.cols - col);
        for (int r = 0; r < rows; ++r) std::copy_n(&tile(r, 0), cols, &image(row + r, col));
    }
    return image;
}

HeightImage highest_within(const TerrainMap& terrain, const ZRange& z)
{
    HeightImage out = page_image(terrain, "height.0");
    if (z.is_unlimited()) return out;
    constexpr double float_step = 1e-6;  // share of a height by which rounding to float32 may change it
    const auto is_within = [&](float height) { return z.contains(height, std::abs(double(height)) * float_step); };
    for (float& height : out.values)
        if (!is_within(height)) height = nothing;
    for (int k = 1; k < terrain.layers(); ++k) {  // from the top down: the first layer within z is kept
        const HeightImage page = page_image(terrain, "height." + std::to_string(k));
        for (std::size_t i = 0; i < out.values.size(); ++i)
            if (std::isnan(out.values[i]) && is_within(page.values[i])) out.values[i] = page.values[i];
    }
    return out;
}

namespace {

/// Returns the map of these tiles, row after row.
TerrainMap terrain_of(const GridFrame& frame, std::vector<TilePages<std::string>> tiles)
{
    TerrainMap out;
    out.frame = frame;
    std::size_t layers = 1;  // one page of heights is written even without terrain
    for (const auto& tile : tiles) layers = std::max(layers, tile.height.size());
    for (std::size_t k = 0; k < layers; ++k)
        add_page("height." + std::to_string(k), tiles, true, out,
                 [&](auto& tile) { return k < tile.height.size() ? &tile.height[k] : nullptr; });
    add_page("water", tiles, false, out, [](auto& tile) { return &tile.water; });
    add_page("obstacle", tiles, false, out, [](auto& tile) { return &tile.obstacle; });
    return out;
}

/// Returns the pages of one tile of a map.
TilePages<std::string> tile_of(const TerrainMap& terrain, std::size_t tile)
{
    const auto stream = [&](const std::string& name) {
        const TerrainMap::Page* const page = terrain.find(name);
        return page == nullptr || is_empty(page->tiles[tile]) ? std::string() : page->tiles[tile];
    };
    TilePages<std::string> out{.height = {}, .water = stream("water"), .obstacle = stream("obstacle")};
    for (int k = 0; k < terrain.layers(); ++k) {
        out.height.push_back(stream("height." + std::to_string(k)));
        if (out.height.back().empty()) {  // lower layers have no heights either
            out.height.pop_back();
            break;
        }
    }
    return out;
}

/// Returns whether a tile of a map meets a box of a change, or comes within a cell of one.
bool may_change(const TerrainMap& terrain, std::size_t tile, std::span<const ElementBox> boxes)
{
    const GridFrame& frame = terrain.frame;
    const int row = int(tile) / terrain.tile_cols(), col = int(tile) % terrain.tile_cols();
    const double side = TerrainMap::tile * frame.cell, x = frame.x0 + col * side,
                 y = frame.y0 + frame.rows * frame.cell - row * side, pad = frame.cell;
    return std::any_of(boxes.begin(), boxes.end(), [&](const ElementBox& box) {
        return box.min[0] <= x + side + pad && box.max[0] >= x - pad && box.min[1] <= y + pad &&
               box.max[1] >= y - side - pad;
    });
}

}  // namespace

TerrainMap rasterize_terrain(const Geometry& geometry, const GridFrame& frame, int threads, const Progress& progress,
                             const ZRange& z_limits)
{
    TerrainMap out;
    out.frame = frame;
    std::vector<TilePages<std::string>> tiles(std::size_t(out.tile_rows()) * std::size_t(out.tile_cols()));
    parallel_for(tiles.size(), threads, progress, [&](std::size_t t) {
        tiles[t] = TileRaster(geometry, frame, z_limits, int(t) / out.tile_cols(), int(t) % out.tile_cols()).run();
    });
    return terrain_of(frame, std::move(tiles));
}

TerrainMap changed_terrain(const TerrainMap& base, const Geometry& geometry, std::span<const ElementBox> boxes,
                           const ZRange& z_limits, int threads)
{
    const int cols = base.tile_cols();
    std::vector<TilePages<std::string>> tiles(std::size_t(base.tile_rows()) * std::size_t(cols));
    parallel_for(tiles.size(), threads, {}, [&](std::size_t t) {
        tiles[t] = may_change(base, t, boxes)
                       ? TileRaster(geometry, base.frame, z_limits, int(t) / cols, int(t) % cols).run()
                       : tile_of(base, t);
    });
    return terrain_of(base.frame, std::move(tiles));
}

int changed_layers(const TerrainMap& base, const Geometry& geometry, std::span<const ElementBox> boxes,
                   const ZRange& z_limits, int threads)
{
    const int cols = base.tile_cols();
    std::vector<std::size_t> layers(std::size_t(base.tile_rows()) * std::size_t(cols));
    parallel_for(layers.size(), threads, {}, [&](std::size_t t) {
        layers[t] = may_change(base, t, boxes)
                        ? TileRaster(geometry, base.frame, z_limits, int(t) / cols, int(t) % cols).count_layers()
                        : tile_of(base, t).height.size();
    });
    return int(*std::max_element(layers.begin(), layers.end()));
}

bool has_same_tiles(const TerrainMap& a, const TerrainMap& b, const std::string& page)
{
    const TerrainMap::Page *const in_a = a.find(page), *const in_b = b.find(page);
    return in_a != nullptr && in_b != nullptr && in_a->tiles == in_b->tiles;
}

int count_layers(const TerrainMap& terrain)
{
    const TerrainMap::Page* const top = terrain.find("height.0");
    return top == nullptr || std::all_of(top->tiles.begin(), top->tiles.end(), is_empty) ? 0 : terrain.layers();
}

}  // namespace spawnfield

#include "base/intervals.h"
#include "base/parallel.h"
#include "column/cell_clip.h"
#include "column/uniform_column.h"
#include "free_space/bounds_raster.h"

#include <xxhash.h>

#include <cstring>

namespace spawnfield {
namespace {

constexpr double least_solid = 1e-4;  // m; a thinner solid is in the bounds, but not in the solids
constexpr std::uint32_t side = BoundsTile::side;

/// Adds one cell to a tile. `surfaces` has the surfaces anywhere in the cell; `inside` has the spans of solids on the
/// vertical line through its centre.
void add_cell(const CellSpans& surfaces, std::uint32_t cell, std::span<const Span> inside, LooseTile& out)
{
    if (inside.empty() && !surfaces.has_more(cell)) {  // open ground
        if (const Interval& only = surfaces.first(cell); only.bottom <= only.top) out.bounds.spans.push_back(only);
        return;
    }
    thread_local std::vector<Interval> bounds, solids;
    surfaces.get(cell, bounds);
    solids.clear();
    // At heights where the cell has no surface, the whole cell is inside a solid, or outside, as its centre is.
    for (const Span& span : inside) {
        if (span.top > span.bottom) bounds.push_back({span.bottom, span.top});
        if (span.sealed && span.top - span.bottom >= least_solid) solids.push_back({span.bottom, span.top});
    }
    if (!inside.empty()) {
        join_intervals(bounds, touch_tolerance);
        join_intervals(solids, touch_tolerance);
    }
    out.bounds.spans.insert(out.bounds.spans.end(), bounds.begin(), bounds.end());
    out.solids.spans.insert(out.solids.spans.end(), solids.begin(), solids.end());
}

/// Returns a tile whose cells all have this column everywhere. Its spans are those of sheets.
LooseTile uniform_tile(const ColumnView& column)
{
    LooseTile out;
    out.bounds.spans = solid_intervals(column);
    out.bounds.starts[1] = std::uint32_t(out.bounds.spans.size());
    out.bounds.repeat_first();
    return out;
}

}  // namespace

std::string rasterized_tile(const Geometry& geometry, const SolidBounds::Impl& raster, const TileLevel& level,
                            std::uint32_t tile_col, std::uint32_t tile_row)
{
    const int col0 = int(tile_col * side), row0 = int(tile_row * side);
    const int cols = std::min(int(side), int(level.cols) - col0), rows = std::min(int(side), int(level.rows) - row0);
    const CellBlock block{raster.x0 + col0 * level.cell, raster.y0 + row0 * level.cell, level.cell, cols, rows};
    if (cols == int(side) && rows == int(side))
        if (const auto same = uniform_column(
                geometry, {block.x0, block.y0, block.x0 + side * block.cell, block.y0 + side * block.cell}))
            return packed(uniform_tile(*same));
    const CellSpans surfaces(geometry, block);
    thread_local Columns centres;  // its memory is used again for the next tile
    centres.set(geometry, {raster.x0, raster.y0, level.cell, col0, row0, cols, rows, 0.5}, Surfaces::Filled);
    LooseTile out;
    out.bounds.spans.reserve(BoundsTile::cells);
    if (!surfaces.is_tight()) out.slack = std::numeric_limits<double>::infinity();
    for (int row = 0; row < int(side); ++row)
        for (int col = 0; col < int(side); ++col) {
            if (row < rows && col < cols) add_cell(surfaces, block.id(col, row), centres.at(col, row).spans, out);
            const std::size_t next = std::size_t(row) * side + std::size_t(col) + 1;
            out.bounds.starts[next] = std::uint32_t(out.bounds.spans.size());
            out.solids.starts[next] = std::uint32_t(out.solids.spans.size());
        }
    return packed(out);
}

std::string pooled_tile(const std::array<BoundsTile, 4>& tiles)
{
    LooseTile out;
    for (const BoundsTile& tile : tiles) out.slack = std::max(out.slack, tile.slack);
    out.bounds.spans.reserve(BoundsTile::cells);
    std::vector<Interval> joined;
    for (std::uint32_t row = 0; row < side; ++row)
        for (std::uint32_t col = 0; col < side; ++col) {
            joined.clear();
            const BoundsTile& tile = tiles[(row >= side / 2 ? 2 : 0) + (col >= side / 2 ? 1 : 0)];
            std::uint16_t highest = 0;  // top of the finer cells without gaps, which may be solid all the way down
            for (std::uint32_t k = 0; k < 4 && !tile.is_empty(); ++k) {
                const std::uint32_t cell = (2 * row + k / 2) % side * side + (2 * col + k % 2) % side;
                if (!tile.bounds.has(cell)) {
                    highest = std::max(highest, tile.tops[cell]);
                } else {
                    for (const QuantizedSpan& span : tile.bounds.of(cell))
                        joined.push_back({tile.height(span.bottom), tile.height(span.top)});
                }
            }
            if (highest > 0) joined.push_back({tile.height(0), tile.height(highest)});
            if (joined.size() > 1) join_intervals(joined, touch_tolerance);
            out.bounds.spans.insert(out.bounds.spans.end(), joined.begin(), joined.end());
            out.bounds.starts[row * side + col + 1] = std::uint32_t(out.bounds.spans.size());
        }
    return packed(out);
}

bool is_whole_in(const Bounds& solid, const Bounds& bounds)
{
    return solid.is_empty() ||
           ((solid.min - bounds.min).head<2>().minCoeff() >= 0 && (bounds.max - solid.max).head<2>().minCoeff() >= 0);
}

SolidBounds::SolidBounds() : impl_(std::make_shared<const Impl>()) {}

SolidBounds::SolidBounds(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

SolidBounds::SolidBounds(const Geometry& geometry, const Bounds& bounds, double cell, int threads,
                         const Progress& progress)
{
    auto impl = std::make_shared<Impl>();
    impl->x0 = bounds.min.x();
    impl->y0 = bounds.min.y();
    const auto count = [&](int axis) {
        return std::uint32_t(std::max(1.0, std::ceil((bounds.max[axis] - bounds.min[axis]) / cell - 1e-9)));
    };
    impl->is_whole = is_whole_in(geometry.bounds(), bounds);
    TileStoreBuilder store(XXH64(nullptr, 0, 0));
    for (TileLevel level(cell, count(0), count(1), side);;) {
        const bool is_finest = store.levels().empty();
        std::vector<std::string> tiles(std::size_t{level.tile_cols} * level.tile_rows);
        parallel_for(tiles.size(), threads, is_finest ? progress : Progress{}, [&](std::size_t t) {
            const auto col = std::uint32_t(t % level.tile_cols), row = std::uint32_t(t / level.tile_cols);
            const auto finer_tile = [&](std::uint32_t fine_col, std::uint32_t fine_row) {
                const std::size_t number = std::size_t{fine_row} * store.levels().back().tile_cols + fine_col;
                const std::string_view bytes = store.tile_of_last_level(number);
                return bytes.empty() ? BoundsTile() : BoundsTile(bytes);
            };
            tiles[t] = is_finest ? rasterized_tile(geometry, *impl, level, col, row)
                                 : pooled_tile(four_tiles(store.levels().back(), col, row, finer_tile));
        });
        const TileLevel coarser(2 * level.cell, (level.cols + 1) / 2, (level.rows + 1) / 2, side);
        const bool is_coarsest = std::max(level.cols, level.rows) <= 4;
        store.add(std::move(level), std::move(tiles), threads);
        if (is_coarsest) break;
        level = coarser;
    }
    impl->tiles = store.build();
    impl_ = std::move(impl);
}

}  // namespace spawnfield

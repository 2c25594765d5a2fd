#include "base/intervals.h"
#include "base/parallel.h"
#include "column/cell_clip.h"
#include "free_space/bounds_tile.h"

#include <xxhash.h>

#include <cstring>

namespace spawnfield {
namespace {

constexpr double steps = 65500;         // quantized heights of a tile; fewer than 65535, so that rounding outwards fits
constexpr double least_quantum = 1e-6;  // m
constexpr double least_solid = 1e-4;    // m; a thinner solid is in the bounds, but not in the solids
constexpr std::uint32_t side = BoundsTile::side;

/// Intervals of heights in each cell of a tile, before they are packed. Those of cell c are spans[starts[c]] ..
/// spans[starts[c + 1] - 1].
struct CellList {
    std::array<std::uint32_t, BoundsTile::cells + 1> starts{};
    std::vector<Interval> spans;  ///< from the bottom up, with gaps between them
};

/// A tile before it is packed.
struct LooseTile {
    CellList bounds, solids;  ///< as in BoundsTile
    double slack = 0;         ///< as in BoundsHead, before the heights are rounded
    bool is_empty() const { return bounds.spans.empty(); }
};

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

/// Returns one tile of the finest level. Its cells beyond the raster stay empty.
LooseTile rasterized(const Geometry& geometry, const SolidBounds::Impl& raster, const TileLevel& level,
                     std::uint32_t tile_col, std::uint32_t tile_row)
{
    const int col0 = int(tile_col * side), row0 = int(tile_row * side);
    const int cols = std::min(int(side), int(level.cols) - col0), rows = std::min(int(side), int(level.rows) - row0);
    const CellBlock block{raster.x0 + col0 * level.cell, raster.y0 + row0 * level.cell, level.cell, cols, rows};
    const CellSpans surfaces(geometry, block);
    const Columns centres(geometry, {raster.x0, raster.y0, level.cell, col0, row0, cols, rows, 0.5}, Surfaces::Filled);
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
    return out;
}

std::uint32_t count_of(const CellList& list, std::size_t cell) { return list.starts[cell + 1] - list.starts[cell]; }

/// Packs a tile into bytes: heights become 16-bit numbers. A cell with one interval of bounds has only its top in the
/// tile; only cells with two or more have their intervals.
class TilePacker {
public:
    explicit TilePacker(const LooseTile& tile) : tile_(tile)
    {
        double low = tile.bounds.spans[0].bottom, high = tile.bounds.spans[0].top;
        for (const Interval& span : tile.bounds.spans) {
            low = std::min(low, span.bottom);
            high = std::max(high, span.top);
        }
        head_.quantum = std::max(least_quantum, (high - low) / steps);
        head_.base = low - 2 * head_.quantum;
        head_.slack = tile.slack + head_.quantum;
        count(tile.bounds, 2, head_.bound_cells, head_.bounds);
        count(tile.solids, 1, head_.solid_cells, head_.solids);
    }

    std::string pack()
    {
        out_.reserve(bounds_tile_size(head_) + tile_alignment);
        put(head_);
        put_list(tile_.bounds, 2, head_.bound_cells, [&](const Interval& span) {
            return QuantizedSpan{down(span.bottom), up(span.top)};
        });
        put_list(tile_.solids, 1, head_.solid_cells, [&](const Interval& span) {
            return QuantizedSpan{up(span.bottom), down(span.top)};
        });
        std::array<std::uint16_t, BoundsTile::cells> tops;
        for (std::size_t cell = 0; cell < BoundsTile::cells; ++cell) {
            const std::uint32_t end = tile_.bounds.starts[cell + 1];
            tops[cell] = end > tile_.bounds.starts[cell] ? up(tile_.bounds.spans[end - 1].top) : std::uint16_t{0};
        }
        put(tops);
        return std::move(out_);
    }

private:
    double height(double value) const { return head_.base + value * head_.quantum; }
    std::uint16_t down(double z) const
    {
        double value = std::floor((z - head_.base) / head_.quantum);
        while (height(value) > z) --value;
        return std::uint16_t(std::clamp(value, 1.0, 65535.0));
    }
    std::uint16_t up(double z) const
    {
        double value = std::ceil((z - head_.base) / head_.quantum);
        while (height(value) < z) ++value;
        return std::uint16_t(std::clamp(value, 1.0, 65535.0));
    }

    template <class T>
    void put(const T& value)
    {
        out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }

    /// Counts the cells with at least `least` intervals, and the intervals of these cells.
    static void count(const CellList& list, std::uint32_t least, std::uint32_t& cells, std::uint32_t& spans)
    {
        for (std::size_t cell = 0; cell < BoundsTile::cells; ++cell)
            if (const std::uint32_t n = count_of(list, cell); n >= least) {
                ++cells;
                spans += n;
            }
    }

    template <class Quantize>
    void put_list(const CellList& list, std::uint32_t least, std::uint32_t cells, const Quantize& quantize)
    {
        if (cells == 0) return;
        std::array<std::uint64_t, BoundsTile::cells / 64> marks{};
        std::array<std::uint16_t, BoundsTile::cells / 64> ranks{};
        std::vector<std::uint32_t> starts{0};
        std::vector<QuantizedSpan> spans;
        for (std::size_t cell = 0; cell < BoundsTile::cells; ++cell) {
            if (cell % 64 == 0) ranks[cell / 64] = std::uint16_t(starts.size() - 1);
            if (count_of(list, cell) < least) continue;
            marks[cell / 64] |= std::uint64_t{1} << (cell % 64);
            for (std::uint32_t k = list.starts[cell]; k < list.starts[cell + 1]; ++k)
                spans.push_back(quantize(list.spans[k]));
            starts.push_back(std::uint32_t(spans.size()));
        }
        put(marks);
        for (const std::uint32_t start : starts) put(start);
        for (const QuantizedSpan& span : spans) put(span);
        // Padding, so that the next marks begin at a multiple of 8 bytes.
        if ((starts.size() + spans.size()) % 2 == 1) put(std::uint32_t{0});
        put(ranks);
    }

    const LooseTile& tile_;
    BoundsHead head_{};
    std::string out_;
};

std::string packed(const LooseTile& tile) { return tile.is_empty() ? std::string() : TilePacker(tile).pack(); }

/// Returns a tile of the next coarser level. Each of its cells is the union of four finer cells, so a gap remains only
/// where all four have a gap. Solids are not kept.
LooseTile pooled(const TileStoreBuilder& finer, std::uint32_t tile_col, std::uint32_t tile_row)
{
    LooseTile out;
    std::array<BoundsTile, 4> tiles;
    for (std::uint32_t t = 0; t < 4; ++t) {
        const std::uint32_t col = 2 * tile_col + t % 2, row = 2 * tile_row + t / 2;
        const TileLevel& fine = finer.levels().back();
        if (col >= fine.tile_cols || row >= fine.tile_rows) continue;
        const std::string_view bytes = finer.tile_of_last_level(std::size_t{row} * fine.tile_cols + col);
        if (bytes.empty()) continue;
        tiles[t] = BoundsTile(bytes);
        out.slack = std::max(out.slack, tiles[t].head->slack);
    }
    out.bounds.spans.reserve(BoundsTile::cells);
    std::vector<Interval> joined;
    for (std::uint32_t row = 0; row < side; ++row)
        for (std::uint32_t col = 0; col < side; ++col) {
            joined.clear();
            const BoundsTile& tile = tiles[(row >= side / 2 ? 2 : 0) + (col >= side / 2 ? 1 : 0)];
            std::uint16_t highest = 0;  // top of the finer cells without gaps, which may be solid all the way down
            for (std::uint32_t k = 0; k < 4 && tile.head != nullptr; ++k) {
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
    return out;
}

}  // namespace

std::uint64_t bounds_tile_size(const BoundsHead& head)
{
    const auto list = [](std::uint64_t cells, std::uint64_t spans) {
        return cells == 0 ? 0 : BoundsTile::cells / 64 * 10 + (cells + 1 + spans + 1) / 2 * 8;
    };
    return sizeof(BoundsHead) + list(head.bound_cells, head.bounds) + list(head.solid_cells, head.solids) +
           std::uint64_t{BoundsTile::cells} * sizeof(std::uint16_t);
}

BoundsTile::BoundsTile(std::string_view bytes) : head(reinterpret_cast<const BoundsHead*>(bytes.data()))
{
    const char* at = bytes.data() + sizeof(BoundsHead);
    const auto list = [&](std::size_t marked, std::size_t count, CellIntervals& out) {
        if (marked == 0) return;
        out.marks = reinterpret_cast<const std::uint64_t*>(at);
        out.starts = reinterpret_cast<const std::uint32_t*>(out.marks + cells / 64);
        out.spans = reinterpret_cast<const QuantizedSpan*>(out.starts + marked + 1);
        at += cells / 64 * 8 + (marked + 1 + count + 1) / 2 * 8;
        out.ranks = reinterpret_cast<const std::uint16_t*>(at);
        at += cells / 64 * 2;
    };
    list(head->bound_cells, head->bounds, bounds);
    list(head->solid_cells, head->solids, solids);
    tops = reinterpret_cast<const std::uint16_t*>(at);
}

bool SolidBounds::Impl::is_consistent(std::string_view bytes)
{
    if (bytes.size() < sizeof(BoundsHead)) return false;
    BoundsHead head;
    std::memcpy(&head, bytes.data(), sizeof head);
    const std::uint64_t size = bounds_tile_size(head);
    if (bytes.size() < size || bytes.size() >= size + tile_alignment) return false;
    if (!(head.quantum > 0) || !std::isfinite(head.base) || !(head.slack >= 0)) return false;
    const BoundsTile tile(bytes);
    const auto counts_up = [](const CellIntervals& list, std::uint32_t cells, std::uint32_t spans) {
        if (cells == 0) return true;
        std::uint32_t marked = 0;
        for (std::size_t word = 0; word < BoundsTile::cells / 64; ++word) {
            if (list.ranks[word] != marked) return false;
            marked += std::uint32_t(std::popcount(list.marks[word]));
        }
        return marked == cells && list.starts[0] == 0 && list.starts[cells] == spans &&
               std::is_sorted(list.starts, list.starts + cells + 1);
    };
    return counts_up(tile.bounds, head.bound_cells, head.bounds) &&
           counts_up(tile.solids, head.solid_cells, head.solids);
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
    const Bounds solid = geometry.bounds();
    impl->is_whole = solid.is_empty() || ((solid.min - bounds.min).head<2>().minCoeff() >= 0 &&
                                          (bounds.max - solid.max).head<2>().minCoeff() >= 0);
    TileStoreBuilder store(XXH64(nullptr, 0, 0));
    for (TileLevel level(cell, count(0), count(1), side);;) {
        const bool is_finest = store.levels().empty();
        std::vector<std::string> tiles(std::size_t{level.tile_cols} * level.tile_rows);
        parallel_for(tiles.size(), threads, is_finest ? progress : Progress{}, [&](std::size_t t) {
            const auto col = std::uint32_t(t % level.tile_cols), row = std::uint32_t(t / level.tile_cols);
            tiles[t] = packed(is_finest ? rasterized(geometry, *impl, level, col, row) : pooled(store, col, row));
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

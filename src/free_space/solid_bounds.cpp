#include "base/parallel.h"
#include "free_space/bounds_tile.h"
#include "map/cell_clip.h"

#include <spawnfield/error.h>

#include <xxhash.h>

#include <cstring>

namespace spawnfield {
namespace {

constexpr double steps = 65500;           // of a tile's heights, with room for rounding outwards
constexpr double least_quantum = 1e-6;    // m
constexpr double least_solid = 1e-4;      // m; thinner ones are surfaces, which the intervals tell
constexpr std::size_t alignment = 64;
constexpr std::uint32_t side = BoundsTile::side;

/// What is solid in each cell of a tile, before it is packed.
struct CellList {
    std::array<std::uint32_t, BoundsTile::cells + 1> starts{};
    std::vector<Interval> spans;  ///< from the bottom up, with gaps between them
};

struct LooseTile {
    CellList bounds, solids;
    double slack = 0;  ///< as BoundsHead, before the heights are rounded
    bool is_empty() const { return bounds.spans.empty(); }
};

/// Cells of one tile of the finest level; those beyond the raster stay empty.
LooseTile rasterized(const Geometry& geometry, const SolidBounds::Impl& raster, std::uint32_t tile_col, std::uint32_t tile_row)
{
    const BoundsLevel& level = raster.levels[0];
    const int col0 = int(tile_col * side), row0 = int(tile_row * side);
    const int cols = std::min(int(side), int(level.cols) - col0), rows = std::min(int(side), int(level.rows) - row0);
    const CellBlock block{raster.x0 + col0 * level.cell, raster.y0 + row0 * level.cell, level.cell, cols, rows};
    const CellSpans surfaces(geometry, block);
    const Columns centres(geometry, {raster.x0, raster.y0, level.cell, col0, row0, cols, rows, 0.5});
    LooseTile out;
    if (!surfaces.is_tight()) out.slack = std::numeric_limits<double>::infinity();
    std::vector<Interval> bounds, solids;
    for (int row = 0; row < int(side); ++row)
        for (int col = 0; col < int(side); ++col) {
            if (row < rows && col < cols) {
                surfaces.get(block.id(col, row), bounds);
                solids.clear();
                // Where no surface passes at a height, the whole cell is inside or outside there, as its centre is.
                for (const Span& span : centres.at(col, row).spans) {
                    if (span.top > span.bottom) bounds.push_back({span.bottom, span.top});
                    if (span.sealed && span.top - span.bottom >= least_solid) solids.push_back({span.bottom, span.top});
                }
                join_spans(bounds);
                join_spans(solids);
                out.bounds.spans.insert(out.bounds.spans.end(), bounds.begin(), bounds.end());
                out.solids.spans.insert(out.solids.spans.end(), solids.begin(), solids.end());
            }
            const std::size_t next = std::size_t(row) * side + std::size_t(col) + 1;
            out.bounds.starts[next] = std::uint32_t(out.bounds.spans.size());
            out.solids.starts[next] = std::uint32_t(out.solids.spans.size());
        }
    return out;
}

std::string packed(const LooseTile& tile)
{
    if (tile.is_empty()) return {};
    double low = tile.bounds.spans[0].bottom, high = tile.bounds.spans[0].top;
    bool has_gaps = false;
    for (const Interval& span : tile.bounds.spans) {
        low = std::min(low, span.bottom);
        high = std::max(high, span.top);
    }
    for (std::size_t cell = 0; cell < BoundsTile::cells; ++cell) has_gaps = has_gaps || tile.bounds.starts[cell + 1] > tile.bounds.starts[cell] + 1;
    BoundsHead head{};
    head.quantum = std::max(least_quantum, (high - low) / steps);
    head.base = low - 2 * head.quantum;
    head.slack = tile.slack + head.quantum;
    head.spans = has_gaps ? std::uint32_t(tile.bounds.spans.size()) : 0;
    head.solids = std::uint32_t(tile.solids.spans.size());
    const auto height = [&](double value) { return head.base + value * head.quantum; };
    const auto down = [&](double z) {
        double value = std::floor((z - head.base) / head.quantum);
        while (height(value) > z) --value;
        return std::uint16_t(std::clamp(value, 1.0, 65535.0));
    };
    const auto up = [&](double z) {
        double value = std::ceil((z - head.base) / head.quantum);
        while (height(value) < z) ++value;
        return std::uint16_t(std::clamp(value, 1.0, 65535.0));
    };
    std::string out;
    out.reserve(bounds_tile_size(head) + alignment);
    const auto put = [&](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
    put(head);
    for (std::size_t cell = 0; cell < BoundsTile::cells; ++cell) {
        const bool some = tile.bounds.starts[cell + 1] > tile.bounds.starts[cell];
        put(some ? up(tile.bounds.spans[tile.bounds.starts[cell + 1] - 1].top) : std::uint16_t{0});
    }
    if (head.spans > 0) {
        put(tile.bounds.starts);
        for (const Interval& span : tile.bounds.spans) put(QuantizedSpan{down(span.bottom), up(span.top)});
    }
    if (head.solids > 0) {
        put(tile.solids.starts);
        for (const Interval& span : tile.solids.spans) put(QuantizedSpan{up(span.bottom), down(span.top)});
    }
    out.resize((out.size() + alignment - 1) / alignment * alignment, '\0');
    return out;
}

bool is_consistent(std::string_view view)
{
    if (view.size() < sizeof(BoundsHead)) return false;
    BoundsHead head;
    std::memcpy(&head, view.data(), sizeof head);
    const std::uint64_t size = bounds_tile_size(head);
    if (view.size() < size || view.size() >= size + alignment) return false;
    if (!(head.quantum > 0) || !std::isfinite(head.base) || !(head.slack >= 0)) return false;
    const BoundsTile tile(view);
    const auto counts_up = [](const std::uint32_t* starts, std::uint32_t count) {
        return starts == nullptr || (starts[0] == 0 && starts[BoundsTile::cells] == count && std::is_sorted(starts, starts + BoundsTile::cells + 1));
    };
    return counts_up(tile.span_starts, head.spans) && counts_up(tile.solid_starts, head.solids);
}

/// The next coarser cells: what is solid in any of the four finer ones. A gap stays only where all four have it.
LooseTile pooled(const SolidBounds::Impl& raster, const std::vector<std::string>& finer, std::uint32_t tile_col, std::uint32_t tile_row)
{
    LooseTile out;
    std::array<BoundsTile, 4> tiles;
    for (std::uint32_t t = 0; t < 4; ++t) {
        const std::uint32_t col = 2 * tile_col + t % 2, row = 2 * tile_row + t / 2;
        const BoundsLevel& fine = raster.levels.back();
        if (col >= fine.tile_cols || row >= fine.tile_rows) continue;
        const std::string& bytes = finer[std::size_t{row} * fine.tile_cols + col];
        if (bytes.empty()) continue;
        tiles[t] = BoundsTile(bytes);
        out.slack = std::max(out.slack, tiles[t].head->slack);
    }
    std::vector<Interval> joined;
    for (std::uint32_t row = 0; row < side; ++row)
        for (std::uint32_t col = 0; col < side; ++col) {
            joined.clear();
            const BoundsTile& tile = tiles[(row >= side / 2 ? 2 : 0) + (col >= side / 2 ? 1 : 0)];
            for (std::uint32_t k = 0; k < 4 && tile.head != nullptr; ++k) {
                const std::uint32_t cell = (2 * row + k / 2) % side * side + (2 * col + k % 2) % side;
                if (tile.tops[cell] == 0) continue;
                if (tile.span_starts == nullptr) {
                    joined.push_back({tile.height(0), tile.height(tile.tops[cell])});
                } else {
                    for (const QuantizedSpan& span : tile.spans_of(cell)) joined.push_back({tile.height(span.bottom), tile.height(span.top)});
                }
            }
            join_spans(joined);
            out.bounds.spans.insert(out.bounds.spans.end(), joined.begin(), joined.end());
            out.bounds.starts[row * side + col + 1] = std::uint32_t(out.bounds.spans.size());
        }
    return out;
}

}  // namespace

std::uint64_t bounds_tile_size(const BoundsHead& head)
{
    const auto list = [](std::uint32_t count) {
        return count == 0 ? 0 : (std::uint64_t{BoundsTile::cells} + 1) * sizeof(std::uint32_t) + std::uint64_t{count} * sizeof(QuantizedSpan);
    };
    return sizeof(BoundsHead) + std::uint64_t{BoundsTile::cells} * sizeof(std::uint16_t) + list(head.spans) + list(head.solids);
}

BoundsTile::BoundsTile(std::string_view bytes) : head(reinterpret_cast<const BoundsHead*>(bytes.data()))
{
    const char* at = bytes.data() + sizeof(BoundsHead);
    tops = reinterpret_cast<const std::uint16_t*>(at);
    at += cells * sizeof(std::uint16_t);
    const auto list = [&](std::uint32_t count, const std::uint32_t*& starts, const QuantizedSpan*& intervals) {
        if (count == 0) return;
        starts = reinterpret_cast<const std::uint32_t*>(at);
        at += (cells + 1) * sizeof(std::uint32_t);
        intervals = reinterpret_cast<const QuantizedSpan*>(at);
        at += count * sizeof(QuantizedSpan);
    };
    list(head->spans, span_starts, spans);
    list(head->solids, solid_starts, solids);
}

void SolidBounds::Impl::make_states()
{
    states_.clear();
    for (const BoundsLevel& level : levels) states_.push_back(std::make_unique<std::atomic<std::uint8_t>[]>(level.tiles.size()));
}

void SolidBounds::Impl::verify(std::string_view view, const TileEntry& entry) const
{
    if (file.empty()) return;
    if (XXH64(view.data(), view.size(), 0) != entry.checksum)
        throw FileError(file, "is damaged (the checksum of a tile differs); bake the map again");
    if (!is_consistent(view)) throw FileError(file, "contradicts itself; bake the map again");
}

SolidBounds::SolidBounds() : impl_(std::make_shared<const Impl>()) {}

SolidBounds::SolidBounds(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

SolidBounds::SolidBounds(const Geometry& geometry, const Bounds& bounds, double cell, int threads, const Progress& progress)
{
    auto impl = std::make_shared<Impl>();
    impl->x0 = bounds.min.x();
    impl->y0 = bounds.min.y();
    const auto count = [&](int axis, double size) { return std::uint32_t(std::max(1.0, std::ceil((bounds.max[axis] - bounds.min[axis]) / size - 1e-9))); };
    const Bounds solid = geometry.bounds();
    impl->is_whole = solid.is_empty() || ((solid.min - bounds.min).head<2>().minCoeff() >= 0 && (bounds.max - solid.max).head<2>().minCoeff() >= 0);
    std::string bytes;
    std::vector<std::string> finer;
    for (double size = cell;; size *= 2) {
        BoundsLevel level;
        level.cell = size;
        const bool first = impl->levels.empty();
        level.cols = first ? count(0, cell) : (impl->levels.back().cols + 1) / 2;
        level.rows = first ? count(1, cell) : (impl->levels.back().rows + 1) / 2;
        level.tile_cols = (level.cols + side - 1) / side;
        level.tile_rows = (level.rows + side - 1) / side;
        level.tiles.resize(std::size_t{level.tile_cols} * level.tile_rows);
        std::vector<std::string> tiles(level.tiles.size());
        if (first) impl->levels.push_back(level);
        parallel_for(level.tiles.size(), threads, first ? progress : Progress{}, [&](std::size_t t) {
            const auto col = std::uint32_t(t % level.tile_cols), row = std::uint32_t(t / level.tile_cols);
            const LooseTile loose = first ? rasterized(geometry, *impl, col, row) : pooled(*impl, finer, col, row);
            tiles[t] = packed(loose);
            level.tiles[t].checksum = XXH64(tiles[t].data(), tiles[t].size(), 0);
        });
        for (std::size_t t = 0; t < level.tiles.size(); ++t) {
            level.tiles[t].offset = bytes.size();
            level.tiles[t].size = tiles[t].size();
            bytes += tiles[t];
        }
        if (first) impl->levels.back() = level;
        else impl->levels.push_back(level);
        finer = std::move(tiles);
        if (std::max(level.cols, level.rows) <= 4) break;
    }
    impl->bytes = bytes_of(std::move(bytes));
    impl->make_states();
    impl_ = std::move(impl);
}

}  // namespace spawnfield

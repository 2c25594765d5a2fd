#include "free_space/row_columns.h"

namespace spawnfield {

void RowColumns::set(std::span<const double> x, const Extent& part, const Raster& raster)
{
    const Rect& reach = part.reach;
    const double per_cell = 1 / raster.cell;
    wide_ = floor_of((reach.high_x - reach.low_x) / raster.cell) + 1;
    core_wide_ = 1;
    if (part.core) core_wide_ = std::max(1, int((part.core->high_x - part.core->low_x) * per_cell) - 1);
    cells_.clear();
    tiles_.clear();
    seen_.clear();
    unknown_.clear();
    if (!fit_windows()) return;
    const auto fits = [](const CellRange& range, int wide) {
        return range.count() == wide || range.count() == wide + 1;
    };
    std::size_t first = x.size(), end = 0;  // of the poses that meet no columns beyond the raster
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double from_left = x[i] - raster.x0;
        const auto& [all, core] = cells_.emplace_back(Cells{
            cells_around((from_left + reach.low_x) * per_cell, (from_left + reach.high_x) * per_cell),
            part.core
                ? cells_inside((from_left + part.core->low_x) * per_cell, (from_left + part.core->high_x) * per_cell)
                : no_cells});
        const bool is_within = all.first >= 0 && all.last < raster.known_cols;
        if (!is_within || !fits(all, wide_) || (core.first <= core.last && !fits(core, core_wide_)))
            unknown_.push_back(i);
        if (!is_within) continue;
        first = std::min(first, i);
        end = i + 1;
    }
    list_tiles(first, end);
}

/// Lists the tiles that these poses meet.
void RowColumns::list_tiles(std::size_t first, std::size_t end)
{
    constexpr int side = BoundsTile::side;
    for (int col = -1; first < end;) {
        col = std::max(col + 1, cells_[first].all.first / side);
        const int left = col * side, right = left + side;
        std::size_t pose = first;
        const std::size_t first_seen = seen_.size();
        for (; pose < end && cells_[pose].all.first < right; ++pose) seen_.push_back(seen(cells_[pose], left));
        tiles_.push_back({std::uint32_t(col), first, first_seen, pose - first});
        while (first < end && cells_[first].all.last < right) ++first;
    }
}

/// Returns what a pose meets of the tile that begins at column `tile_left`.
RowColumns::Seen RowColumns::seen(const Cells& cells, int tile_left) const
{
    const CellRange all = cells.all.in_tile(tile_left);
    Seen out{bits_between(all.first, all.last),
             RowMaxima::columns(cells.all.first - tile_left, cells.all.last - tile_left, wide_),
             {}};
    if (cells.core.first > cells.core.last) return out;
    if (const CellRange core = cells.core.in_tile(tile_left); core.first <= core.last)
        out.core = RowMaxima::columns(cells.core.first - tile_left, cells.core.last - tile_left, core_wide_);
    return out;
}

}  // namespace spawnfield

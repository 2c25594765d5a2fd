#include "free_space/mask.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace spawnfield {

/// Looks at these rows of a tile, and at windows of so many columns. Does nothing if it has looked at them last: rows
/// of poses that are nearer to each other than cells share them.
void Mask::TileRows::set(const OpenTile& opened, const CellRange& all, int wide, const CellRange& inner, int inner_wide)
{
    open = &opened;
    if (all == rows && inner == core_rows && col == opened.col && row == opened.row && wide == whole.wide() &&
        inner_wide == core.wide())
        return;
    const BoundsTile& tile = opened.tile;
    col = opened.col;
    row = opened.row;
    rows = all;
    core_rows = inner;
    RowMaxima::Values maxima{};
    const auto raise = [&](int from, int to) {
        for (int r = from; r <= to; ++r) {
            const std::uint16_t* const tops = tile.tops + r * int(BoundsTile::side);
            for (std::size_t c = 0; c < BoundsTile::side; ++c) maxima[c] = maxima[c] < tops[c] ? tops[c] : maxima[c];
        }
    };
    if (inner.first <= inner.last) {
        raise(inner.first, inner.last);
        core.set(maxima, inner_wide);
        raise(all.first, inner.first - 1);
        raise(inner.last + 1, all.last);
    } else {
        if (inner != no_cells) core.set_zero(inner_wide);
        raise(all.first, all.last);
    }
    whole.set(maxima, wide);
    listed = filled = 0;
    for (auto r = std::uint32_t(all.first); r <= std::uint32_t(all.last); ++r) {
        listed |= tile.bounds.marks_of(r);
        filled |= tile.solids.marks_of(r);
    }
    has_gaps = false;
}

/// Sets `floors` and `ceilings` for `rows`.
void Mask::TileRows::set_gaps()
{
    const BoundsTile& tile = open->tile;
    RowMaxima::Values high_floors{}, low_ceilings;
    low_ceilings.fill(std::numeric_limits<std::uint16_t>::max());
    for (auto r = std::uint32_t(rows.first); r <= std::uint32_t(rows.last); ++r) {
        RowMaxima::Values lowest;
        std::copy_n(tile.tops + r * BoundsTile::side, BoundsTile::side, lowest.begin());
        tile.bounds.visit_row(r, [&](std::uint32_t c, std::span<const QuantizedSpan> spans) {
            lowest[c] = spans[0].top;
            if (spans.size() > 1) low_ceilings[c] = std::min(low_ceilings[c], spans[1].bottom);
        });
        for (std::size_t c = 0; c < BoundsTile::side; ++c)
            high_floors[c] = high_floors[c] < lowest[c] ? lowest[c] : high_floors[c];
    }
    has_gaps = true;
    floors = high_floors;
    ceilings = low_ceilings;
}

/// Looks at the rows that set() got, in the columns of each pose, for what the part meets at heights z. Changes
/// Clear to Plain or Layered. Poses whose z is NaN stay as they are.
void Mask::TileRows::look_around(std::span<const RowColumns::Seen> columns, const Prism& part,
                                 std::span<const double> z, std::span<Surroundings> out)
{
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const double bottom = z[i] + part.bottom;
        if (open->are_below(whole.highest(columns[i].all), bottom)) continue;
        if (out[i] != Surroundings::Clear || std::isnan(z[i])) continue;
        out[i] = (listed & columns[i].bits) == 0 ? Surroundings::Plain
                                                 : between_layers(columns[i].bits, bottom, z[i] + part.top);
    }
}

/// Looks at these columns, in some of which a cell has several intervals, for what lies between two heights, m. Returns
/// Clear or Layered.
Mask::Surroundings Mask::TileRows::between_layers(std::uint64_t columns, double bottom, double top)
{
    if (!has_gaps) set_gaps();
    const auto first = std::countr_zero(columns), end = 64 - std::countl_zero(columns);
    const std::uint16_t ceiling = *std::min_element(ceilings.begin() + first, ceilings.begin() + end),
                        floor = *std::max_element(floors.begin() + first, floors.begin() + end);
    return open->tile.height(ceiling) > top && open->are_below(floor, bottom) ? Surroundings::Clear
                                                                              : Surroundings::Layered;
}

/// Sets the x of the poses that follow.
void Mask::set_row(std::span<const double> x)
{
    if (x.size() == row_x_.size() && std::memcmp(x.data(), row_x_.data(), x.size_bytes()) == 0) return;
    row_x_.assign(x.begin(), x.end());
    for (Part& part : parts_)
        for (Pass& pass : part.passes) pass.has_columns = false;
}

/// Returns the columns of cells that the part meets at the poses of the row.
const RowColumns& Mask::columns_of(const Part& part, Pass& pass) const
{
    if (!pass.has_columns)
        pass.columns.set(row_x_, {part.reach, part.core},
                         {raster_.x0, raster_.levels()[pass.level].cell, pass.known_cols});
    pass.has_columns = true;
    return pass.columns;
}

/// Returns the rows of cells that the next row of poses needs besides `rows`, if it is as far from the row at y as this
/// one is from the row before; none before the second row of a block. To fetch them now takes 6 % less time for rasters
/// whose rows share few cells.
CellRange Mask::next_rows(const Part& part, Pass& pass, double y, const CellRange& rows) const
{
    const double step = y - std::exchange(pass.last_y, y), up = y + step - raster_.y0;
    if (!(step > 0)) return {0, -1};
    CellRange out = cells_around((up + part.reach.low_y) * pass.per_cell, (up + part.reach.high_y) * pass.per_cell);
    out.first = std::max(out.first, rows.last + 1);
    return out;
}

/// Looks at the rectangle of coarse cells around the part at each pose of the row whose z[i] is not NaN. A pose whose
/// cells are not known, or lie in too many columns, is Plain.
void Mask::look_around(const Part& part, Pass& pass, double y, std::span<const double> z,
                       std::span<Surroundings> out) const
{
    constexpr int side = BoundsTile::side;
    const double per_cell = pass.per_cell, up = y - raster_.y0;
    const CellRange rows = cells_around((up + part.reach.low_y) * per_cell, (up + part.reach.high_y) * per_cell);
    const RowColumns& columns = columns_of(part, pass);
    const bool is_known = columns.fit_windows() && rows.first >= 0 && rows.last < pass.known_rows;
    std::fill(out.begin(), out.end(), is_known ? Surroundings::Clear : Surroundings::Plain);
    if (!is_known) return;
    const CellRange next = next_rows(part, pass, y, rows);
    for (int row = rows.first / side; row <= rows.last / side; ++row)
        for (const RowColumns::InTile& seen : columns.tiles()) {
            const OpenTile& open = tile_of(pass, seen.col, std::uint32_t(row));
            if (open.tile.is_empty()) continue;
            pass.last_rows.set(open, rows.in_tile(row * side), columns.wide());
            open.fetch(next.in_tile(row * side));
            pass.last_rows.look_around(columns.seen_in(seen), part.footprint.outer,
                                       z.subspan(seen.first_pose, seen.count),
                                       out.subspan(seen.first_pose, seen.count));
        }
    for (int row = rows.last / side + 1; row <= std::min(next.last, pass.known_rows - 1) / side; ++row)
        for (const RowColumns::InTile& seen : columns.tiles())
            raster_.fetch_head(pass.level, seen.col, std::uint32_t(row));
    for (const std::size_t pose : columns.unknown()) out[pose] = Surroundings::Plain;
}

/// Looks at the cells around a part and at those inside it, in the rows that set() got. Returns Found bits.
std::uint8_t Mask::TileRows::look_closer(const RowColumns::Seen& columns, const Footprint& part, double z) const
{
    if (open->are_below(whole.highest(columns.all), z + part.outer.bottom)) return 0;
    const std::uint8_t out = ((listed | filled) & columns.bits) != 0 ? Above | Undecided : Above;
    const std::uint16_t top = core.highest(columns.core);
    if (top == 0) return out;
    const auto value = [&](double height) { return (height - open->tile.base) * open->inverse_quantum; };
    if (top > value(z + part.inner.top)) return out | Undecided;
    return top >= value(z + part.inner.bottom + open->tile.slack) ? out | Inside : out;
}

/// Does for a whole row of poses what proof_of_rectangle() does for one of them: changes Plain to Clear, Hit or Unclear
/// where the cells of this pass decide. Poses that lie near each other share the maxima of the cells. Does nothing if
/// they are so far apart that it would take longer.
void Mask::look_closer(const Part& part, Pass& pass, double y, std::span<const double> z, std::span<Surroundings> out)
{
    constexpr int side = BoundsTile::side;
    constexpr double fewest = 2;  // poses for each tile
    const double per_cell = pass.per_cell, up = y - raster_.y0,
                 tiles = (row_x_.back() - row_x_.front()) * per_cell / side + 1;
    if (double(std::count(out.begin(), out.end(), Surroundings::Plain)) < fewest * tiles) return;
    const Rect &reach = part.reach, &core = *part.core;
    const CellRange rows = cells_around((up + reach.low_y) * per_cell, (up + reach.high_y) * per_cell),
                    core_rows = cells_inside((up + core.low_y) * per_cell, (up + core.high_y) * per_cell);
    const RowColumns& columns = columns_of(part, pass);
    if (!columns.fit_windows() || rows.first < 0 || rows.last >= pass.known_rows) return;
    const CellRange next = next_rows(part, pass, y, rows);
    found_.assign(out.size(), &pass == &part.passes.back() ? 0 : Undecided);
    for (int row = rows.first / side; row <= rows.last / side; ++row)
        for (const RowColumns::InTile& tile : columns.tiles()) {
            const auto begin = out.begin() + std::ptrdiff_t(tile.first_pose), end = begin + std::ptrdiff_t(tile.count);
            const auto first = std::size_t(std::find(begin, end, Surroundings::Plain) - begin);
            if (first == tile.count) continue;
            const OpenTile& open = tile_of(pass, tile.col, std::uint32_t(row));
            if (open.tile.is_empty()) continue;
            TileRows& seen_rows = pass.last_rows;
            seen_rows.set(open, rows.in_tile(row * side), columns.wide(), core_rows.in_tile(row * side),
                          columns.core_wide());
            open.fetch(next.in_tile(row * side));
            const std::span<const RowColumns::Seen> seen = columns.seen_in(tile);
            for (std::size_t k = first; k < tile.count; ++k)
                if (const std::size_t i = tile.first_pose + k; out[i] == Surroundings::Plain)
                    found_[i] |= seen_rows.look_closer(seen[k], part.footprint, z[i]);
        }
    for (const std::size_t pose : columns.unknown()) found_[pose] = Above | Undecided;
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (out[i] != Surroundings::Plain || std::isnan(z[i])) continue;
        if ((found_[i] & Above) == 0)
            out[i] = Surroundings::Clear;
        else if ((found_[i] & Inside) != 0)
            out[i] = Surroundings::Hit;
        else if ((found_[i] & Undecided) == 0)
            out[i] = Surroundings::Unclear;
    }
}

void Mask::prove(std::span<const double> x, double y, std::span<const double> z, std::span<Proof> out)
{
    std::fill(out.begin(), out.end(), Proof::Candidate);
    if (!is_in_reach(x.front(), y) || !is_in_reach(x.back(), y)) return;
    std::fill(out.begin(), out.end(), Proof::Free);
    surroundings_.resize(x.size());
    set_row(x);
    for (Part& part : parts_) {
        look_around(part, part.passes.front(), y, z, surroundings_);
        if (part.core && !coarse_only_) look_closer(part, second_pass(part), y, z, surroundings_);
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (surroundings_[i] == Surroundings::Clear || out[i] == Proof::Blocked) continue;
            if (surroundings_[i] == Surroundings::Hit)
                out[i] = Proof::Blocked;
            else if (surroundings_[i] == Surroundings::Unclear)
                out[i] = Proof::Candidate;
            else if (std::isnan(z[i]))
                continue;
            else if (const Proof proof = proof_near(part, {x[i], y, z[i]}, surroundings_[i]); proof != Proof::Free)
                out[i] = proof;
        }
    }
}

}  // namespace spawnfield

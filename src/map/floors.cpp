#include "base/deflate.h"
#include "base/parallel.h"

#include <spawnfield/floors.h>
#include <spawnfield/shape.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace spawnfield {
namespace {

constexpr double step = 0.01;             // m between counted heights
constexpr double head_room = 1.5;         // m; least free height above ground; excludes the inside of hollow slabs
constexpr int smoothing = 25;             // a height also counts up to this many steps above and below, but less
constexpr double highest_valley = 0.5;    // share of the lower of two peaks; floors are separated by a lower density
constexpr double flat_within = 0.25;      // m above and below a floor's height
constexpr double least_flat_share = 0.5;  // share of a floor's ground that must be flat
constexpr double least_share = 0.02;      // share of the map's ground that a floor must have
constexpr double least_area = 1;          // m2 that a floor must have
constexpr std::size_t tile_cells = std::size_t(TerrainMap::tile) * TerrainMap::tile;

/// The number of ground cells at each height, in steps. Contains only the heights that occur.
using Histogram = std::map<std::int64_t, std::uint64_t>;

/// Returns the heights in a tile of a page; NaN where there is nothing.
std::vector<float> tile_of(const TerrainMap::Page& page, std::size_t tile)
{
    std::vector<float> heights(tile_cells);
    inflate_floats(page.tiles[tile], TerrainMap::tile, heights);
    return heights;
}

/// Returns how often each bin (a height in steps) occurs. If the bins lie close together, as they mostly do in one
/// tile, they are counted in a table, which is faster than a look-up in the histogram for each cell.
Histogram counted(const std::vector<std::int64_t>& bins)
{
    Histogram out;
    if (bins.empty()) return out;
    const auto [low, high] = std::minmax_element(bins.begin(), bins.end());
    constexpr std::int64_t largest_table = 1 << 20;
    if (*high - *low >= largest_table) {
        for (const std::int64_t bin : bins) ++out[bin];
        return out;
    }
    std::vector<std::uint32_t> table(std::size_t(*high - *low + 1));
    for (const std::int64_t bin : bins) ++table[std::size_t(bin - *low)];
    for (std::size_t i = 0; i < table.size(); ++i)
        if (table[i] > 0) out.emplace_hint(out.end(), *low + std::int64_t(i), table[i]);
    return out;
}

/// Counts the ground cells of a tile with a free height of at least `room`, m.
Histogram ground_in_tile(const std::vector<const TerrainMap::Page*>& layers, std::size_t tile, double room)
{
    std::vector<std::int64_t> bins;
    std::vector<float> above;
    for (const TerrainMap::Page* layer : layers) {
        std::vector<float> heights = tile_of(*layer, tile);
        for (std::size_t cell = 0; cell < tile_cells; ++cell) {
            const bool is_low = !above.empty() && above[cell] - heights[cell] < room;
            if (!std::isnan(heights[cell]) && !is_low)
                bins.push_back(std::int64_t(std::round(double(heights[cell]) / step)));
        }
        above = std::move(heights);
    }
    return counted(bins);
}

/// Counts the ground cells of a map with a free height of at least `room`, m.
Histogram ground_of(const TerrainMap& terrain, double room, int threads)
{
    std::vector<const TerrainMap::Page*> layers;
    for (int k = 0; k < terrain.layers(); ++k) layers.push_back(terrain.find("height." + std::to_string(k)));
    std::vector<Histogram> tiles(std::size_t(terrain.tile_rows()) * std::size_t(terrain.tile_cols()));
    parallel_for(tiles.size(), threads, {},
                 [&](std::size_t tile) { tiles[tile] = ground_in_tile(layers, tile, room); });
    Histogram sum;
    for (const Histogram& tile : tiles)
        for (const auto& [bin, cells] : tile) sum[bin] += cells;
    return sum;
}

/// The number of ground cells of a map at each height, with cumulative sums. Peaks are found in a smoothed copy of
/// these numbers, the density.
class GroundHeights {
public:
    explicit GroundHeights(const Histogram& counts)
    {
        Histogram density;
        for (const auto& [bin, cells] : counts) {
            bins_.push_back(bin);
            sums_.push_back(total() + cells);
            for (int by = -smoothing; by <= smoothing; ++by)
                density[bin + by] += cells * std::uint64_t(smoothing + 1 - std::abs(by));
        }
        density_.assign(density.begin(), density.end());
    }

    std::uint64_t total() const { return sums_.empty() ? 0 : sums_.back(); }
    std::int64_t median() const
    {
        return bins_[std::size_t(std::lower_bound(sums_.begin(), sums_.end(), (total() + 1) / 2) - sums_.begin())];
    }

    /// Returns the number of cells whose bins are first .. last.
    std::uint64_t cells_in(std::int64_t first, std::int64_t last) const
    {
        return cells_below(last + 1) - cells_below(first);
    }

    std::uint64_t flat_cells(std::int64_t peak) const
    {
        constexpr std::int64_t reach = std::int64_t(flat_within / step + 0.5);
        return cells_in(peak - reach, peak + reach);
    }

    /// Returns the bins of the peaks that are separated by valleys and have at least `least` flat cells, in rising
    /// order.
    std::vector<std::int64_t> separate_peaks(double least) const
    {
        std::vector<std::size_t> candidates, chosen;
        for (std::size_t i = 0; i < density_.size(); ++i)
            if (density_at(i, -1) < density_[i].second && density_at(i, 1) <= density_[i].second &&
                double(flat_cells(density_[i].first)) >= least)
                candidates.push_back(i);
        std::stable_sort(candidates.begin(), candidates.end(),
                         [&](std::size_t a, std::size_t b) { return density_[a].second > density_[b].second; });
        for (const std::size_t peak : candidates) {
            const auto above = std::lower_bound(chosen.begin(), chosen.end(), peak);
            if (above != chosen.end() && !has_valley(peak, *above, peak)) continue;
            if (above != chosen.begin() && !has_valley(*(above - 1), peak, peak)) continue;
            chosen.insert(above, peak);
        }
        std::vector<std::int64_t> out;
        for (const std::size_t peak : chosen) out.push_back(density_[peak].first);
        return out;
    }

private:
    std::uint64_t cells_below(std::int64_t bin) const
    {
        const std::size_t before = std::size_t(std::lower_bound(bins_.begin(), bins_.end(), bin) - bins_.begin());
        return before == 0 ? 0 : sums_[before - 1];
    }

    /// Returns the density one bin above (by = 1) or below (by = -1) entry i; 0 if there is no ground.
    std::uint64_t density_at(std::size_t i, int by) const
    {
        const std::size_t next = i + std::size_t(std::int64_t(by));
        return next < density_.size() && density_[next].first == density_[i].first + by ? density_[next].second : 0;
    }

    /// Returns whether the density has a valley between entries `from` and `to`. `peak` is the lower of these two.
    bool has_valley(std::size_t from, std::size_t to, std::size_t peak) const
    {
        const double deep = highest_valley * double(density_[peak].second);
        for (std::size_t i = from; i < to; ++i)
            if (double(std::min(density_[i].second, density_at(i, 1))) < deep) return true;
        return false;
    }

    std::vector<std::int64_t> bins_;   ///< bins with ground, in rising order
    std::vector<std::uint64_t> sums_;  ///< number of cells in each of bins_ and all before it
    std::vector<std::pair<std::int64_t, std::uint64_t>> density_;  ///< bins with a density above 0, in rising order
};

double height_of(std::int64_t bin) { return double(bin) * step; }

/// Returns floors at the given peaks. Ground between two peaks belongs to the nearer one.
std::vector<Floor> floors_at(const std::vector<std::int64_t>& peaks, const GroundHeights& ground, double cell_area)
{
    std::vector<Floor> out;
    std::int64_t first = std::numeric_limits<std::int64_t>::min() / 2;
    for (std::size_t k = 0; k < peaks.size(); ++k) {
        Floor floor;
        floor.height = height_of(peaks[k]);
        if (k > 0) floor.z.low = out.back().z.high + 4 * touch_tolerance;  // so that no layer is in both
        const bool is_top = k + 1 == peaks.size();
        if (!is_top) floor.z.high = (height_of(peaks[k]) + height_of(peaks[k + 1])) / 2;
        const std::int64_t last = is_top ? std::numeric_limits<std::int64_t>::max() / 2
                                         : std::int64_t(std::floor(double(peaks[k] + peaks[k + 1]) / 2));
        const double cells = double(ground.cells_in(first, last));
        floor.area = cells * cell_area;
        floor.share = cells / double(ground.total());
        first = last + 1;
        out.push_back(floor);
    }
    return out;
}

/// Returns the peak whose ground is least flat, if less than least_flat_share of it is flat.
std::optional<std::size_t> least_flat(const std::vector<std::int64_t>& peaks, const std::vector<Floor>& floors,
                                      const GroundHeights& ground)
{
    std::optional<std::size_t> worst;
    double least = least_flat_share;
    for (std::size_t k = 0; k < peaks.size(); ++k) {
        const double share = double(ground.flat_cells(peaks[k])) / (floors[k].share * double(ground.total()));
        if (share >= least) continue;
        least = share;
        worst = k;
    }
    return worst;
}

}  // namespace

std::vector<Floor> find_floors(const TerrainMap& terrain, int threads)
{
    Histogram counts = ground_of(terrain, head_room, threads);
    if (counts.empty()) counts = ground_of(terrain, 0, threads);
    if (counts.empty()) return {};
    const GroundHeights ground(counts);
    const double cell_area = terrain.frame.cell * terrain.frame.cell;
    const double least = std::max(least_share * double(ground.total()), least_area / cell_area);
    std::vector<std::int64_t> peaks = ground.separate_peaks(least);
    std::vector<Floor> floors = floors_at(peaks, ground, cell_area);
    while (const auto worst = least_flat(peaks, floors, ground)) {
        peaks.erase(peaks.begin() + std::ptrdiff_t(*worst));
        floors = floors_at(peaks, ground, cell_area);
    }
    return floors.empty() ? floors_at({ground.median()}, ground, cell_area) : floors;
}

}  // namespace spawnfield

#include "reach/reach_graph.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <ranges>

namespace spawnfield {
namespace {

/// Returns the headings at which a run begins: those that no turn reaches from the heading before.
HeadingSet starts_of(HeadingSet valid, HeadingSet turns) { return HeadingSet(valid & ~std::rotl(turns, 1)); }

}  // namespace

int count_runs(HeadingSet valid, HeadingSet turns)
{
    if (valid == 0) return 0;
    return std::max(1, std::popcount(starts_of(valid, turns)));  // without a start, turns connect all headings
}

std::size_t ReachGraph::Impl::run_of(std::size_t place, int heading) const
{
    const HeadingSet starts = starts_of(valid[place], turns[place]);
    const int count = std::max(1, std::popcount(starts)),
              up_to_here = std::popcount(HeadingSet(starts & ((2u << heading) - 1)));
    return first_run[place] + std::size_t((up_to_here + count - 1) % count);
}

/// Joins the runs of all places between which there is a way.
DisjointSets ReachGraph::Impl::joined_runs() const
{
    DisjointSets out(first_run.back());
    const auto join_ways = [&](std::size_t place, int col, int row) {
        for (const Way way : moving_ways) {
            const std::vector<Ways>& targets = ways[std::size_t(way)];
            if (targets.empty()) continue;
            for (int heading = 0; heading < lattice_headings; ++heading) {
                const std::uint8_t index = targets[place][std::size_t(heading)];
                if (index == nowhere) continue;
                const WayEnd end = way_end(way, heading);
                const std::size_t to = first[column_of(col + end.move.cols, row + end.move.rows)] + index;
                out.join(std::uint32_t(run_of(place, heading)), std::uint32_t(run_of(to, end.heading)));
            }
        }
    };
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col)
            for (std::size_t p = first[column_of(col, row)]; p < first[column_of(col, row) + 1]; ++p)
                join_ways(p, col, row);
    return out;
}

void ReachGraph::Impl::find_islands()
{
    first_run.assign(1, 0);
    for (std::size_t p = 0; p < ground.size(); ++p)
        first_run.push_back(first_run.back() + std::uint32_t(count_runs(valid[p], turns[p])));
    DisjointSets sets = joined_runs();
    // A place counts once for each island on which it has a heading.
    std::vector<std::uint32_t> sizes(first_run.back(), 0);
    for (std::size_t p = 0; p < ground.size(); ++p)
        for (std::uint32_t run = first_run[p]; run < first_run[p + 1]; ++run) {
            const std::uint32_t root = sets.find(run);
            const auto is_same = [&](std::uint32_t other) { return sets.find(other) == root; };
            const auto earlier = std::ranges::iota_view(first_run[p], run);
            sizes[root] += std::none_of(earlier.begin(), earlier.end(), is_same);
        }
    std::vector<std::uint32_t> roots;
    for (std::uint32_t run = 0; run < sizes.size(); ++run)
        if (sizes[run] > 0) roots.push_back(run);
    std::stable_sort(roots.begin(), roots.end(), [&](std::uint32_t a, std::uint32_t b) { return sizes[a] > sizes[b]; });
    std::vector<std::uint32_t> numbers(sizes.size());
    for (std::uint32_t i = 0; i < roots.size(); ++i) numbers[roots[i]] = i;
    run_islands.resize(sizes.size());
    for (std::uint32_t run = 0; run < run_islands.size(); ++run) run_islands[run] = numbers[sets.find(run)];
    islands.clear();
    for (const std::uint32_t root : roots)
        islands.push_back(
            {.area = sizes[root] * grid.step * grid.step, .share = double(sizes[root]) / double(ground.size())});
    set_places();
}

/// Sets the place and the heights of each island.
void ReachGraph::Impl::set_places()
{
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<Eigen::Vector2d> middles(islands.size(), Eigen::Vector2d::Zero());
    std::vector<std::uint32_t> counts(islands.size(), 0);
    std::vector<double> nearest(islands.size(), infinity);
    for (Island& island : islands) island.low = infinity, island.high = -infinity;
    const auto for_each_run = [&](const auto& visit) {
        for_each_place([&](std::size_t p, double x, double y) {
            for (std::uint32_t run = first_run[p]; run < first_run[p + 1]; ++run)
                visit(run_islands[run], Vec3(x, y, ground[p]));
        });
    };
    for_each_run([&](std::uint32_t i, const Vec3& at) {
        islands[i].low = std::min(islands[i].low, at.z());
        islands[i].high = std::max(islands[i].high, at.z());
        middles[i] += at.head<2>();
        ++counts[i];
    });
    for_each_run([&](std::uint32_t i, const Vec3& at) {
        const double distance = (at.head<2>() - middles[i] / counts[i]).norm();
        if (!(distance < nearest[i])) return;
        nearest[i] = distance;
        islands[i].place = at;
    });
}

}  // namespace spawnfield

#include "base/parallel.h"
#include "reach/reach_graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>

namespace spawnfield {
namespace {

/// Returns the two headings around a yaw, the nearer one first.
std::array<int, 2> headings_around(double yaw)
{
    const auto ahead_of_it = [&](int heading) { return turn_between(yaw, lattice_yaw(heading)); };
    int nearest = 0;
    for (int k = 1; k < lattice_headings; ++k)
        if (std::abs(ahead_of_it(k)) < std::abs(ahead_of_it(nearest))) nearest = k;
    return {nearest, lattice_heading(nearest, ahead_of_it(nearest) > 0 ? -1 : 1)};
}

constexpr std::size_t part = 1 << 16;  // nodes or places

std::size_t part_count(std::size_t count) { return (count + part - 1) / part; }

/// Calls visit(begin, end) for parts of `count` items, on some threads.
template <class Visit>
void in_parts(std::size_t count, int threads, const Visit& visit)
{
    parallel_for(part_count(count), threads, {},
                 [&](std::size_t k) { visit(k * part, std::min(count, (k + 1) * part)); });
}

}  // namespace

/// Numbers the sets of nodes, the one with most places first, and adds up their places.
void ReachGraph::Impl::find_islands(DisjointSets& nodes)
{
    const std::vector<std::uint32_t> roots = find_roots(nodes);
    const std::vector<std::uint32_t> sizes = number_sets(roots);
    std::vector<std::uint32_t> order(roots.size()), numbers(roots.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return sizes[a] > sizes[b]; });
    islands.clear();
    for (const std::uint32_t set : order) {
        numbers[set] = std::uint32_t(islands.size());
        islands.push_back(
            {.area = sizes[set] * grid.step * grid.step, .share = double(sizes[set]) / double(ground.size())});
    }
    if (!std::is_sorted(order.begin(), order.end()))
        in_parts(node_islands.size(), options.threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t node = begin; node < end; ++node) node_islands[node] = numbers[node_islands[node]];
        });
    set_places(set_heights());
}

/// Sets node_islands to the smallest node of each node's set. Returns these, in ascending order.
std::vector<std::uint32_t> ReachGraph::Impl::find_roots(DisjointSets& nodes)
{
    node_islands.resize(first_node.back());
    std::vector<std::vector<std::uint32_t>> of_parts(part_count(node_islands.size()));
    in_parts(node_islands.size(), options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t node = begin; node < end; ++node) {
            node_islands[node] = nodes.find(std::uint32_t(node));
            if (node_islands[node] == node) of_parts[begin / part].push_back(std::uint32_t(node));
        }
    });
    std::vector<std::uint32_t> out;
    for (const std::vector<std::uint32_t>& roots : of_parts) out.insert(out.end(), roots.begin(), roots.end());
    return out;
}

/// Replaces the smallest node of a set by its index in `roots`. Returns the number of places of each set.
std::vector<std::uint32_t> ReachGraph::Impl::number_sets(const std::vector<std::uint32_t>& roots)
{
    PerThread<std::vector<std::uint32_t>> sizes_of_threads{std::vector<std::uint32_t>(roots.size())};
    in_parts(ground.size(), options.threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t>& sizes = sizes_of_threads.local();
        std::size_t set = 0;  // most nodes have that of the one before
        for (std::size_t place = begin; place < end; ++place) {
            for (std::size_t node = first_node[place]; node < first_node[place + 1]; ++node) {
                const std::uint32_t root = node_islands[node];
                if (roots[set] != root)
                    set = std::size_t(std::lower_bound(roots.begin(), roots.end(), root) - roots.begin());
                node_islands[node] = std::uint32_t(set);
            }
            for_each_island(place, [&](std::uint32_t island) { ++sizes[island]; });
        }
    });
    std::vector<std::uint32_t> out(roots.size(), 0);
    for (const std::vector<std::uint32_t>& sizes : sizes_of_threads)
        std::transform(sizes.begin(), sizes.end(), out.begin(), out.begin(), std::plus<>());
    return out;
}

/// Calls visit(of_islands[i], i, place, col, row) for each place on island i, on some threads: `of_threads` has a
/// vector `of_islands` for each of them.
template <class OfThreads, class Visit>
void ReachGraph::Impl::visit_islands(OfThreads& of_threads, const Visit& visit) const
{
    constexpr int rows = 64;  // that a thread looks at together
    parallel_for(std::size_t((grid.rows + rows - 1) / rows), options.threads, {}, [&](std::size_t k) {
        auto& of_islands = of_threads.local();
        for_each_place(int(k) * rows, std::min(grid.rows, int(k + 1) * rows), [&](std::size_t p, int col, int row) {
            for_each_island(p, [&](std::uint32_t i) { visit(of_islands[i], i, p, col, row); });
        });
    });
}

/// Sets the heights of each island. Returns the middle of all of its places, in columns and rows. Sums of whole numbers
/// do not depend on the order in which threads add them.
std::vector<Vec2> ReachGraph::Impl::set_heights()
{
    struct Sums {
        double low = std::numeric_limits<double>::infinity(), high = -low;  ///< m
        std::uint64_t cols = 0, rows = 0, count = 0;                        ///< of all places
    };
    PerThread<std::vector<Sums>> of_threads{std::vector<Sums>(islands.size())};
    visit_islands(of_threads, [&](Sums& sums, std::uint32_t, std::size_t p, int col, int row) {
        sums.low = std::min(sums.low, ground[p]);
        sums.high = std::max(sums.high, ground[p]);
        sums.cols += std::uint64_t(col);
        sums.rows += std::uint64_t(row);
        ++sums.count;
    });
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < islands.size(); ++i) {
        Sums all;
        for (const std::vector<Sums>& of_islands : of_threads) {
            all.low = std::min(all.low, of_islands[i].low);
            all.high = std::max(all.high, of_islands[i].high);
            all.cols += of_islands[i].cols;
            all.rows += of_islands[i].rows;
            all.count += of_islands[i].count;
        }
        islands[i].low = all.low;
        islands[i].high = all.high;
        out.emplace_back(double(all.cols) / double(all.count), double(all.rows) / double(all.count));
    }
    return out;
}

/// Sets the place of each island: the one nearest to the middle of all of its places; of equally near ones, the first.
void ReachGraph::Impl::set_places(std::span<const Vec2> middles)
{
    struct Nearest {
        double square = std::numeric_limits<double>::infinity();  ///< of the distance from the middle, in columns
        std::size_t place = 0;
        int col = 0, row = 0;
    };
    const auto take = [](Nearest& best, const Nearest& other) {
        if (std::tie(other.square, other.place) < std::tie(best.square, best.place)) best = other;
    };
    PerThread<std::vector<Nearest>> of_threads{std::vector<Nearest>(islands.size())};
    visit_islands(of_threads, [&](Nearest& nearest, std::uint32_t i, std::size_t p, int col, int row) {
        take(nearest, {(Vec2(col, row) - middles[i]).squaredNorm(), p, col, row});
    });
    for (std::size_t i = 0; i < islands.size(); ++i) {
        Nearest nearest;
        for (const std::vector<Nearest>& of_islands : of_threads) take(nearest, of_islands[i]);
        islands[i].place = {grid.x_of(nearest.col), grid.y_of(nearest.row), ground[nearest.place]};
    }
}

std::optional<std::size_t> ReachGraph::Impl::island_of(const SettledPose& pose) const
{
    const auto state = state_of(pose);
    return state ? std::optional<std::size_t>(node_islands[node_of(state->place, state->heading)]) : std::nullopt;
}

std::optional<ReachGraph::Impl::State> ReachGraph::Impl::state_of(const SettledPose& pose) const
{
    if (pose.verdict != Verdict::Valid) return std::nullopt;
    const Vec2 at = pose.position.head<2>();
    struct NearColumn {
        int col, row;
        double distance;  ///< from the pose, m
    };
    std::vector<NearColumn> columns;
    const double col = std::floor((at.x() - grid.x0) / grid.step), row = std::floor((at.y() - grid.y0) / grid.step);
    for (const double c : {col, col + 1})
        for (const double r : {row, row + 1})
            if (c >= 0 && r >= 0 && c < grid.cols && r < grid.rows)
                columns.push_back({int(c), int(r), (Vec2(grid.x_of(int(c)), grid.y_of(int(r))) - at).norm()});
    const auto is_nearer = [](const NearColumn& a, const NearColumn& b) { return a.distance < b.distance; };
    std::stable_sort(columns.begin(), columns.end(), is_nearer);
    for (const NearColumn& column : columns)
        for (const int heading : headings_around(pose.yaw))
            if (const auto place = place_near(pose, column.col, column.row, heading)) return State{*place, heading};
    return std::nullopt;
}

/// Returns the place of a column to which the robot can go from a valid settled pose, where it then stands at a
/// heading.
std::optional<std::size_t> ReachGraph::Impl::place_near(const SettledPose& pose, int col, int row, int heading) const
{
    const std::size_t begin = first[column_of(col, row)], end = first[column_of(col, row) + 1];
    std::vector<PlaceStates> places;
    for (std::size_t p = begin; p < end; ++p) places.push_back({.ground = ground[p], .valid = valid[p]});
    const auto k = way_judges.local().place_near(pose, {grid.x_of(col), grid.y_of(row)}, places, heading);
    return k ? std::optional(begin + *k) : std::nullopt;
}

}  // namespace spawnfield

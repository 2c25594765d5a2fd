#include "base/parallel.h"
#include "reach/reach_graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
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

}  // namespace

/// Numbers the sets of nodes, and adds up their places.
void ReachGraph::Impl::find_islands(DisjointSets& nodes)
{
    const std::size_t count = first_node.back();
    node_islands.resize(count);  // first the smallest node of each set
    constexpr std::size_t part = 1 << 16;
    parallel_for((count + part - 1) / part, options.threads, {}, [&](std::size_t k) {
        for (std::size_t node = k * part; node < std::min(count, (k + 1) * part); ++node)
            node_islands[node] = nodes.find(std::uint32_t(node));
    });
    std::vector<std::uint32_t> sizes(count, 0);  // later the numbers of the islands
    for (std::size_t p = 0; p < ground.size(); ++p) for_each_island(p, [&](std::uint32_t root) { ++sizes[root]; });
    std::vector<std::uint32_t> roots;
    for (std::uint32_t node = 0; node < count; ++node)
        if (sizes[node] > 0) roots.push_back(node);
    std::stable_sort(roots.begin(), roots.end(), [&](std::uint32_t a, std::uint32_t b) { return sizes[a] > sizes[b]; });
    islands.clear();
    for (const std::uint32_t root : roots) {
        islands.push_back(
            {.area = sizes[root] * grid.step * grid.step, .share = double(sizes[root]) / double(ground.size())});
        sizes[root] = std::uint32_t(islands.size() - 1);
    }
    for (std::uint32_t& island : node_islands) island = sizes[island];
    set_places();
}

/// Sets the heights of each island, and its place: the one nearest to the middle of all of its places; of equally near
/// ones, the first.
void ReachGraph::Impl::set_places()
{
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<Eigen::Vector2d> middles(islands.size(), Eigen::Vector2d::Zero());
    std::vector<std::uint32_t> counts(islands.size(), 0);
    for (Island& island : islands) island.low = infinity, island.high = -infinity;
    for_each_place(0, grid.rows, [&](std::size_t p, double x, double y) {
        for_each_island(p, [&](std::uint32_t i) {
            islands[i].low = std::min(islands[i].low, ground[p]);
            islands[i].high = std::max(islands[i].high, ground[p]);
            middles[i] += Eigen::Vector2d(x, y);
            ++counts[i];
        });
    });
    for (std::size_t i = 0; i < islands.size(); ++i) middles[i] /= counts[i];
    struct Nearest {
        double distance = std::numeric_limits<double>::infinity();  ///< from the middle, m
        std::size_t place = 0;
        Vec3 at = Vec3::Zero();
    };
    const auto take = [](Nearest& best, const Nearest& other) {
        if (std::tie(other.distance, other.place) < std::tie(best.distance, best.place)) best = other;
    };
    PerThread<std::vector<Nearest>> nearest_of_threads(std::vector<Nearest>(islands.size()));
    constexpr int part = 64;  // rows
    parallel_for(std::size_t((grid.rows + part - 1) / part), options.threads, {}, [&](std::size_t k) {
        std::vector<Nearest>& nearest = nearest_of_threads.local();
        for_each_place(int(k) * part, std::min(grid.rows, int(k + 1) * part), [&](std::size_t p, double x, double y) {
            for_each_island(p, [&](std::uint32_t i) {
                const double distance = (Eigen::Vector2d(x, y) - middles[i]).norm();
                if (distance <= nearest[i].distance) take(nearest[i], {distance, p, {x, y, ground[p]}});
            });
        });
    });
    std::vector<Nearest> nearest(islands.size());
    for (const std::vector<Nearest>& of_thread : nearest_of_threads)
        for (std::size_t i = 0; i < islands.size(); ++i) take(nearest[i], of_thread[i]);
    for (std::size_t i = 0; i < islands.size(); ++i) islands[i].place = nearest[i].at;
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

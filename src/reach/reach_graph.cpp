#include "reach/reach_graph.h"

#include "base/binary.h"
#include "base/number.h"
#include "base/parallel.h"
#include "base/polygon2.h"
#include "reach/graph_builder.h"
#include "settle/convex.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace spawnfield {
namespace {

constexpr double largest_turning_radius = 100;  // m

/// Returns how many things each of some groups has, from the number of the first thing of each, and of all.
std::vector<std::uint32_t> counts_of(const std::vector<std::uint32_t>& first)
{
    std::vector<std::uint32_t> out(first.size() - 1);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = first[k + 1] - first[k];
    return out;
}

/// The reverse. Throws std::runtime_error if each group has more than `most` things on average: a damaged file might
/// claim so many that they do not fit the memory.
std::vector<std::uint32_t> first_of(const std::vector<std::uint32_t>& counts, std::uint64_t most)
{
    std::vector<std::uint32_t> out(counts.size() + 1, 0);
    std::partial_sum(counts.begin(), counts.end(), out.begin() + 1);
    if (out.back() > most * counts.size()) throw std::runtime_error("it has too many places for its ground");
    return out;
}

}  // namespace

double auto_reach_step(const Robot& robot)
{
    Polygon2 outline;
    for (const RobotPart& part : robot.parts) {
        const Convex body = convex_of(part);
        constexpr int directions = 64;  // around round parts
        for (int k = 0; k < directions; ++k) {
            const double angle = 2 * std::numbers::pi * k / directions;
            outline.push_back(body.support({std::cos(angle), std::sin(angle), 0}).head<2>());
        }
    }
    return width(convex_hull(std::move(outline))) / 4;
}

ReachOptions with_defaults(const ReachOptions& options, const Robot& robot)
{
    constexpr const char* function = "ReachGraph";
    const RobotDrive& own = robot.drive;
    ReachOptions out = options;
    out.drive = options.drive ? options.drive : own.kind.value_or(Drive::Differential);
    const bool is_car = out.drive == Drive::Car;
    if (!out.step) out.step = auto_reach_step(robot);
    if (!out.max_step) out.max_step = own.max_step;
    if (!out.max_step && out.drive == Drive::Legged)
        throw ArgumentError(function,
                            "a legged robot needs the largest step that it climbs: --max-step, or max_step in "
                            "robot.yaml, m");
    if (!out.max_step) out.max_step = own.wheel_radius ? *own.wheel_radius / 4 : 0.03;
    if (out.turning_radius && !is_car)
        throw ArgumentError(function,
                            "turning_radius is only for a car; the drive is " + std::string(name_of(*out.drive)));
    if (is_car && !out.turning_radius) out.turning_radius = own.turning_radius;
    if (is_car && !out.turning_radius)
        throw ArgumentError(function,
                            "a car needs the smallest radius of its curves: --turning-radius, or "
                            "turning_radius in robot.yaml, m");
    if (!(*out.step > 0) || !std::isfinite(*out.step)) throw ArgumentError(function, "step", *out.step, "> 0 m");
    if (!(*out.max_step >= 0) || !std::isfinite(*out.max_step))
        throw ArgumentError(function, "max_step", *out.max_step, ">= 0 m");
    if (is_car && !(*out.turning_radius > 0 && *out.turning_radius <= largest_turning_radius))
        throw ArgumentError(function, "turning_radius", *out.turning_radius,
                            "> 0 m, at most " + number(largest_turning_radius) + " m");
    return out;
}

ReachGraph::Impl::Impl(const Judge& judge_, const ReachOptions& options_, Keep keep_, Empty)
    : judge(judge_), options(with_defaults(options_, judge.robot())),
      lattice(options.turning_radius.value_or(0) / *options.step), keep(keep_),
      way_judges([this] { return WayJudge(judge.impl(), *options.max_step, lattice, grid.step); })
{
    judge.impl().settler();  // throws if the obstacles are voxels
    grid = raster_grid(judge.map().bounds, {.step = *options.step});
}

ReachGraph::Impl::Impl(const Judge& judge_, const ReachOptions& options_, Keep keep_)
    : Impl(judge_, options_, keep_, Empty())
{
    DisjointSets nodes = GraphBuilder(*this).run();
    find_islands(nodes);
}

std::string ReachGraph::Impl::bytes() const
{
    std::array<BinaryWriter, 5> arrays;
    parallel_for(arrays.size(), options.threads, {}, [&](std::size_t k) {
        switch (k) {
        case 0: return arrays[k].put_runs(counts_of(first));
        case 1: return arrays[k].put_runs(ground);
        case 2: return arrays[k].put_runs(valid);
        case 3: return arrays[k].put_runs(counts_of(first_node));
        default: return arrays[k].put_runs(node_islands);
        }
    });
    BinaryWriter out;
    for (BinaryWriter& array : arrays) out.put_all(std::move(array));
    out.put(std::uint64_t(islands.size()));
    for (const Island& island : islands)
        for (const double value :
             {island.area, island.share, island.place.x(), island.place.y(), island.place.z(), island.low, island.high})
            out.put(value);
    for (const std::vector<Ways>& of_kind : ways) out.put_runs(of_kind);
    return out.take();
}

ReachGraph::Impl::Impl(const Judge& judge_, const ReachOptions& options_, Keep keep_, std::string_view bytes)
    : Impl(judge_, options_, keep_, Empty())
{
    BinaryReader in(bytes);
    first = first_of(in.get_runs<std::uint32_t>(std::uint64_t(grid.cols) * std::uint64_t(grid.rows)), nowhere);
    ground = in.get_runs<double>(first.back());
    valid = in.get_runs<HeadingSet>(first.back());
    first_node = first_of(in.get_runs<std::uint32_t>(first.back()), lattice_headings);
    node_islands = in.get_runs<std::uint32_t>(first_node.back());
    for (auto count = in.get<std::uint64_t>(); count > 0; --count) {
        Island& island = islands.emplace_back();
        for (double* const value : {&island.area, &island.share, &island.place.x(), &island.place.y(),
                                    &island.place.z(), &island.low, &island.high})
            *value = in.get<double>();
    }
    for (std::vector<Ways>& of_kind : ways) of_kind = in.get_runs<Ways>(ground.size());
    if (!is_consistent()) throw std::runtime_error("its numbers do not fit each other");
}

bool ReachGraph::Impl::is_consistent() const
{
    const std::size_t columns = std::size_t(grid.cols) * std::size_t(grid.rows), places = ground.size();
    if (first.size() != columns + 1 || first[0] != 0 || first.back() != places || valid.size() != places ||
        first_node.size() != places + 1 || first_node[0] != 0 || first_node.back() != node_islands.size() ||
        !std::is_sorted(first.begin(), first.end()))
        return false;
    for (std::size_t p = 0; p < places; ++p) {
        const std::uint32_t nodes = first_node[p + 1] - first_node[p];  // wraps around if they are not ascending
        if (valid[p] == 0 || (nodes != 1 && nodes != std::uint32_t(std::popcount(valid[p])))) return false;
    }
    // The lengths of paths are whole numbers, which larger heights would exceed.
    const Bounds& space = judge.map().geometry.bounds();
    constexpr double rounding = 1e-3;  // m
    const ZRange heights{space.min.z() - rounding, space.max.z() + rounding};
    if (!std::ranges::all_of(ground, [&](double height) { return heights.contains(height, 0); })) return false;
    for (const Way way : all_ways) {
        const bool is_kept = keep == Keep::Ways && (way != Way::Aside || goes_aside(*options.drive));
        if (ways[std::size_t(way)].size() != (is_kept ? places : 0)) return false;
    }
    return std::ranges::all_of(node_islands, [&](std::uint32_t island) { return island < islands.size(); }) &&
           are_ways_inside();
}

/// Returns whether all ways lead to places.
bool ReachGraph::Impl::are_ways_inside() const
{
    std::atomic<bool> out{true};
    parallel_for(std::size_t(grid.rows), options.threads, {}, [&](std::size_t row) {
        for (int col = 0; col < grid.cols; ++col)
            if (!are_ways_inside(col, int(row))) out = false;
    });
    return out;
}

/// Returns whether all ways from the places of a column lead to places.
bool ReachGraph::Impl::are_ways_inside(int col, int row) const
{
    const std::size_t column = column_of(col, row);
    for (std::size_t place = first[column]; place < first[column + 1]; ++place)
        for (const Way way : moving_ways) {
            if (ways[std::size_t(way)].empty()) continue;
            const Ways& of_place = ways[std::size_t(way)][place];
            for (int heading = 0; heading < lattice_headings; ++heading) {
                const std::uint8_t index = of_place[std::size_t(heading)];
                if (index == nowhere) continue;
                const LatticeMove move = lattice.end(way, heading).move;
                const int end_col = col + move.cols, end_row = row + move.rows;
                if (end_col < 0 || end_row < 0 || end_col >= grid.cols || end_row >= grid.rows) return false;
                const std::size_t end = column_of(end_col, end_row);
                if (index >= first[end + 1] - first[end]) return false;
            }
        }
    return true;
}

ReachGraph::ReachGraph(const Judge& judge, const ReachOptions& options)
    : impl_(std::make_shared<const Impl>(judge, options, options.keep_ways ? Impl::Keep::Ways : Impl::Keep::Islands))
{
}

bool goes_aside(Drive drive) { return drive == Drive::Omni || drive == Drive::Legged; }

const ReachOptions& ReachGraph::options() const { return impl_->options; }

std::span<const Island> ReachGraph::islands() const { return impl_->islands; }

std::vector<ReachPlace> ReachGraph::places() const
{
    std::vector<ReachPlace> out;
    out.reserve(impl_->ground.size());
    impl_->for_each_place([&](std::size_t p, int col, int row) {
        const std::uint32_t begin = impl_->first_node[p], end = impl_->first_node[p + 1];
        const auto nodes = std::span(impl_->node_islands).subspan(begin, end - begin);
        out.push_back({impl_->grid.x_of(col), impl_->grid.y_of(row), impl_->ground[p],
                       *std::min_element(nodes.begin(), nodes.end())});
    });
    return out;
}

std::optional<std::size_t> ReachGraph::island_of(const SettledPose& pose) const { return impl_->island_of(pose); }

}  // namespace spawnfield

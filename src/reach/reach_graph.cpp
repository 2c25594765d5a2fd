#include "reach/reach_graph.h"

#include "base/binary.h"
#include "base/polygon2.h"
#include "reach/graph_builder.h"
#include "settle/convex.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace spawnfield {

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

ReachGraph::Impl::Impl(const Judge& judge_, const ReachOptions& options_, Keep keep_, Empty)
    : judge(judge_), options(options_), keep(keep_),
      way_judges([this] { return WayJudge(judge.impl(), options.max_step, longest_way() * grid.step); })
{
    judge.impl().settler();  // throws if the obstacles are voxels
    if (!options.step) options.step = auto_reach_step(judge.robot());
    if (!(*options.step > 0) || !std::isfinite(*options.step))
        throw ArgumentError("ReachGraph", "step", *options.step, "> 0 m");
    if (!(options.max_step >= 0) || !std::isfinite(options.max_step))
        throw ArgumentError("ReachGraph", "max_step", options.max_step, ">= 0 m");
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
    BinaryWriter out;
    out.put_array(first);
    out.put_array(ground);
    out.put_array(valid);
    out.put_array(first_node);
    out.put_array(node_islands);
    out.put(std::uint64_t(islands.size()));
    for (const Island& island : islands)
        for (const double value :
             {island.area, island.share, island.place.x(), island.place.y(), island.place.z(), island.low, island.high})
            out.put(value);
    return out.take();
}

ReachGraph::Impl::Impl(const Judge& judge_, const ReachOptions& options_, std::string_view bytes)
    : Impl(judge_, options_, Keep::Islands, Empty())
{
    BinaryReader in(bytes);
    first = in.get_array<std::uint32_t>();
    ground = in.get_array<double>();
    valid = in.get_array<HeadingSet>();
    first_node = in.get_array<std::uint32_t>();
    node_islands = in.get_array<std::uint32_t>();
    for (auto count = in.get<std::uint64_t>(); count > 0; --count) {
        Island& island = islands.emplace_back();
        for (double* const value : {&island.area, &island.share, &island.place.x(), &island.place.y(),
                                    &island.place.z(), &island.low, &island.high})
            *value = in.get<double>();
    }
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
    return std::ranges::all_of(node_islands, [&](std::uint32_t island) { return island < islands.size(); });
}

ReachGraph::ReachGraph(const Judge& judge, const ReachOptions& options)
    : impl_(std::make_shared<const Impl>(judge, options, options.keep_ways ? Impl::Keep::Ways : Impl::Keep::Islands))
{
}

const ReachOptions& ReachGraph::options() const { return impl_->options; }

std::span<const Island> ReachGraph::islands() const { return impl_->islands; }

std::vector<ReachPlace> ReachGraph::places() const
{
    std::vector<ReachPlace> out;
    out.reserve(impl_->ground.size());
    impl_->for_each_place([&](std::size_t p, double x, double y) {
        const std::uint32_t begin = impl_->first_node[p], end = impl_->first_node[p + 1];
        const auto nodes = std::span(impl_->node_islands).subspan(begin, end - begin);
        out.push_back({x, y, impl_->ground[p], *std::min_element(nodes.begin(), nodes.end())});
    });
    return out;
}

std::optional<std::size_t> ReachGraph::island_of(const SettledPose& pose) const { return impl_->island_of(pose); }

}  // namespace spawnfield

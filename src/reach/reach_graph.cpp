#include "reach/reach_graph.h"

#include "base/polygon2.h"
#include "reach/graph_builder.h"
#include "settle/convex.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <numbers>
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

ReachGraph::Impl::Impl(const Judge& judge_, const ReachOptions& options_, Keep keep_)
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
    DisjointSets nodes = GraphBuilder(*this).run();
    find_islands(nodes);
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

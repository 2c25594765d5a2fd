#include "reach/path_search.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace spawnfield {
namespace {

constexpr double nanometre = 1e-9;  // m
constexpr PathCost unreached = std::numeric_limits<PathCost>::max();

/// Returns the length of a quadratic Bezier curve whose control points have these lines between them. They must not be
/// parallel. Along the curve, its derivative is 2 (first + t bend).
double bezier_length(const Vec2& first, const Vec2& second)
{
    const Vec2 bend = second - first;
    const double size = bend.norm(), begin = first.dot(bend) / (size * size),
                 aside = std::abs(first.x() * second.y() - first.y() * second.x()) / (size * size);
    const auto integral = [&](double u) {  // of sqrt(u^2 + aside^2)
        return (u * std::hypot(u, aside) + aside * aside * std::asinh(u / aside)) / 2;
    };
    return 2 * size * (integral(begin + 1) - integral(begin));
}

Vec2 vector_of(const LatticeMove& move) { return {double(move.cols), double(move.rows)}; }

/// Returns a limit that the cost of no path up to this length exceeds.
PathCost most_cost(double longest)
{
    constexpr double largest = 1e5;  // m; costs beyond it may not be representable
    return (PathCost(std::ceil(std::min(longest, largest) / nanometre)) + 1) * cost_per_nanometre;
}

}  // namespace

double way_length(Way way, int heading)
{
    const WayEnd end = way_end(way, heading);
    if (way != Way::Left && way != Way::Right) return end.move.length();
    return bezier_length(vector_of(lattice_move(heading)), vector_of(lattice_move(end.heading)));
}

PathCost path_cost(double length, double rise)
{
    return PathCost(std::ceil(std::hypot(length, rise) / nanometre)) * cost_per_nanometre;
}

PathSearch::Impl::Impl(std::shared_ptr<const ReachGraph::Impl> graph)
    : graph_(std::move(graph)), labels_of_place_(graph_->ground.size(), none)
{
    if (graph_->keep != ReachGraph::Impl::Keep::Ways)
        throw ArgumentError("PathSearch", "the graph does not keep its ways; build it with ReachOptions::keep_ways");
    column_of_place_.reserve(graph_->ground.size());
    for (std::size_t column = 0; column + 1 < graph_->first.size(); ++column)
        column_of_place_.resize(graph_->first[column + 1], std::uint32_t(column));
    for (std::size_t way = 0; way < way_count; ++way)
        for (int heading = 0; heading < lattice_headings; ++heading)
            lengths_[way][std::size_t(heading)] = graph_->grid.step * way_length(Way(way), heading);
}

Vec3 PathSearch::Impl::ground_of(std::size_t place) const
{
    const int cols = graph_->grid.cols, column = int(column_of_place_[place]);
    return {graph_->grid.x_of(column % cols), graph_->grid.y_of(column / cols), graph_->ground[place]};
}

PathSearch::Impl::Label& PathSearch::Impl::label(StateId state)
{
    const std::size_t place = state / lattice_headings;
    if (labels_of_place_[place] == none) {
        labels_of_place_[place] = std::uint32_t(labels_.size());
        labels_.emplace_back().fill({unreached, 0});
        reached_.push_back(place);
    }
    return labels_[labels_of_place_[place]][state % lattice_headings];
}

/// Calls visit(state, cost) for all states to which a way leads from a state, and for those from which a way leads to
/// it: robots go back the same way.
template <class Visit>
void PathSearch::Impl::for_each_neighbour(StateId state, const Visit& visit) const
{
    const std::size_t place = state / lattice_headings;
    const int heading = int(state % lattice_headings), before = lattice_heading(heading, -1);
    const std::vector<ReachGraph::Impl::Ways>& turns = graph_->ways[std::size_t(Way::Turn)];
    const StateId first = StateId(place) * lattice_headings;
    if (turns[place][std::size_t(heading)] != ReachGraph::Impl::nowhere)
        visit(first + StateId(lattice_heading(heading, 1)), turn_cost);
    if (turns[place][std::size_t(before)] != ReachGraph::Impl::nowhere) visit(first + StateId(before), turn_cost);
    for (const Way way : ReachGraph::Impl::moving_ways)
        if (!graph_->ways[std::size_t(way)].empty()) for_each_moving_neighbour(state, way, visit);
}

template <class Visit>
void PathSearch::Impl::for_each_moving_neighbour(StateId state, Way way, const Visit& visit) const
{
    const RasterGrid& grid = graph_->grid;
    const std::vector<ReachGraph::Impl::Ways>& ways = graph_->ways[std::size_t(way)];
    const std::size_t place = state / lattice_headings;
    const int heading = int(state % lattice_headings), col = int(column_of_place_[place]) % grid.cols,
              row = int(column_of_place_[place]) / grid.cols;
    const auto go = [&](std::size_t other, int other_heading, int begin_heading) {
        visit(StateId(other) * lattice_headings + StateId(other_heading),
              path_cost(lengths_[std::size_t(way)][std::size_t(begin_heading)],
                        graph_->ground[other] - graph_->ground[place]));
    };
    if (const std::uint8_t index = ways[place][std::size_t(heading)]; index != ReachGraph::Impl::nowhere) {
        const WayEnd end = way_end(way, heading);
        go(graph_->first[graph_->column_of(col + end.move.cols, row + end.move.rows)] + index, end.heading, heading);
    }
    // Back: a curve to the left that ends at this heading began at the one before.
    const int begin = lattice_heading(heading, way == Way::Left ? -1 : way == Way::Right ? 1 : 0);
    const LatticeMove move = way_end(way, begin).move;
    const int from_col = col - move.cols, from_row = row - move.rows;
    if (from_col < 0 || from_row < 0 || from_col >= grid.cols || from_row >= grid.rows) return;
    const std::size_t here = graph_->first[column_of_place_[place]], column = graph_->column_of(from_col, from_row);
    for (std::size_t other = graph_->first[column]; other < graph_->first[column + 1]; ++other)
        if (ways[other][std::size_t(begin)] == place - here) go(other, begin, begin);
}

/// Returns a cost that no path from a state to a place falls short of: the straight line, without its rounding errors.
PathCost PathSearch::Impl::at_least(StateId state, const Vec3& goal) const
{
    constexpr PathCost rounding = 2;
    const double distance = (ground_of(state / lattice_headings) - goal).norm();
    return std::max<PathCost>(0, PathCost(std::floor(distance / nanometre)) - rounding) * cost_per_nanometre;
}

std::optional<PathSearch::Impl::Found> PathSearch::Impl::find(StateId start, StateId goal, double longest)
{
    const PathCost most = most_cost(longest);
    for (const std::size_t place : reached_) labels_of_place_[place] = none;
    reached_.clear();
    labels_.clear();
    const Vec3 target = ground_of(goal / lattice_headings);
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    label(start) = {0, start};
    queue.push({at_least(start, target), 0, start});
    while (!queue.empty()) {
        const Entry entry = queue.top();
        queue.pop();
        if (entry.estimate > most) return std::nullopt;
        if (entry.state == goal) return trace(start, goal);
        if (entry.cost > label(entry.state).cost) continue;  // there is a shorter path to it
        for_each_neighbour(entry.state, [&](StateId next, PathCost cost) {
            Label& known = label(next);
            const PathCost sum = entry.cost + cost;
            if (sum >= known.cost) return;
            known = {sum, entry.state};
            queue.push({sum + at_least(next, target), sum, next});
        });
    }
    return std::nullopt;
}

/// Returns the path that leads to a state.
PathSearch::Impl::Found PathSearch::Impl::trace(StateId start, StateId goal)
{
    Found out{.cost = label(goal).cost, .states = {goal}, .length = 0};
    while (out.states.back() != start) out.states.push_back(label(out.states.back()).parent);
    std::reverse(out.states.begin(), out.states.end());
    out.length = double(out.cost / cost_per_nanometre) * nanometre;
    return out;
}

std::optional<PathSearch::Impl::End> PathSearch::Impl::end_of(const SettledPose& pose) const
{
    const auto state = graph_->state_of(pose);
    if (!state) return std::nullopt;
    const Vec3 ground(pose.position.x(), pose.position.y(), pose.ground->height);
    return End{.state = StateId(state->place) * lattice_headings + StateId(state->heading),
               .island = graph_->node_islands[graph_->node_of(state->place, state->heading)],
               .ground = ground,
               .length = (ground - ground_of(state->place)).norm()};
}

std::optional<PathSearch::Impl::Found> PathSearch::Impl::find(const End& start, const End& goal, double longest)
{
    if (start.island != goal.island) return std::nullopt;
    auto out = find(start.state, goal.state, longest);
    if (!out) return std::nullopt;
    out->length += start.length + goal.length;
    return out->length <= longest ? out : std::nullopt;
}

Path PathSearch::Impl::path_of(const Found& found, const SettledPose& start, const SettledPose& goal) const
{
    Path out{.poses = {start}, .length = found.length};
    for (const StateId state : found.states)
        out.poses.push_back(
            graph_->judge.settle(ground_of(state / lattice_headings), lattice_yaw(int(state % lattice_headings))));
    out.poses.push_back(goal);
    return out;
}

PathSearch::PathSearch(const ReachGraph& graph) : impl_(std::make_unique<Impl>(graph.impl())) {}
PathSearch::PathSearch(PathSearch&&) noexcept = default;
PathSearch::~PathSearch() = default;

std::optional<double> PathSearch::length(const SettledPose& start, const SettledPose& goal, double longest)
{
    const auto first = impl_->end_of(start), last = impl_->end_of(goal);
    if (!first || !last) return std::nullopt;
    const auto found = impl_->find(*first, *last, longest);
    return found ? std::optional(found->length) : std::nullopt;
}

std::optional<Path> PathSearch::path(const SettledPose& start, const SettledPose& goal, double longest)
{
    const auto first = impl_->end_of(start), last = impl_->end_of(goal);
    if (!first || !last) return std::nullopt;
    const auto found = impl_->find(*first, *last, longest);
    return found ? std::optional(impl_->path_of(*found, start, goal)) : std::nullopt;
}

}  // namespace spawnfield

#include "reach/path_search.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <utility>

namespace spawnfield {
namespace {

/// Returns a cost that no path up to this length exceeds.
PathCost most_cost(double longest)
{
    constexpr double largest = 1e5;  // m
    return PathCost(std::ceil(std::min(longest, largest) / nanometre)) + 1;
}

int heading_of(PathGraph::StateId state) { return int(state % lattice_headings); }

}  // namespace

PathSearch::Impl::Impl(std::shared_ptr<const PathGraph> graph)
    : graph_(std::move(graph)), labels_(graph_->groups(), Label{0, 0, unnumbered})
{
}

/// Removes the next entry of the search, and returns it if its estimate is at most `most`.
std::optional<PathSearch::Impl::Entry> PathSearch::Impl::pop(PathCost most)
{
    if (ready_.empty()) {
        if (queue_.empty() || queue_.top().estimate > most) return std::nullopt;
        ready_.push_back(queue_.top());
        least_ = queue_.top().estimate;
        queue_.pop();
    }
    const Entry out = ready_.back();
    ready_.pop_back();
    return out;
}

/// Goes on with the search, until all groups whose estimate is at most `most` have been visited, or `until` is found.
/// Returns whether it is.
bool PathSearch::Impl::expand(PathCost most, Group until)
{
    while (const auto entry = pop(most)) {
        if (entry->cost > labels_[entry->group].cost) continue;  // there is a shorter path to it
        if (entry->group == until) return true;
        graph_->for_each_useful_leg(entry->group, entry->leg, [&](Group next, PathCost cost, std::uint8_t leg) {
            const PathCost sum = entry->cost + cost;
            if (is_reached(next) && sum >= labels_[next].cost) return;
            put(next, sum, leg);
        });
    }
    return false;
}

/// Begins a search at the start.
void PathSearch::Impl::start_search()
{
    queue_ = {};
    ready_.clear();
    least_ = 0;
    goal_group_ = graph_->group_of(goal_);
    if (++search_ == 0) {  // the numbers begin anew
        std::fill(labels_.begin(), labels_.end(), Label{0, 0, unnumbered});
        search_ = 1;
    }
    put(graph_->group_of(start_), 0, PathGraph::unknown_leg);
    has_searched_ = true;
}

void PathSearch::Impl::put(Group group, PathCost cost, std::uint8_t leg)
{
    labels_[group] = {cost, search_, unnumbered};
    const Entry entry{cost + graph_->at_least(group, goal_group_), cost, group, leg};
    if (entry.estimate <= least_)
        ready_.push_back(entry);
    else
        queue_.push(entry);
}

std::optional<double> PathSearch::Impl::find(StateId start, StateId goal, double longest)
{
    start_ = start;
    goal_ = goal;
    has_searched_ = false;
    const Group last = graph_->group_of(goal);
    if (const auto cost = graph_->cost_in_the_open(graph_->group_of(start), last)) {
        cost_ = *cost;
        if (cost_ > most_cost(longest)) return std::nullopt;
    } else {
        start_search();
        if (!expand(most_cost(longest), last)) return std::nullopt;
        cost_ = labels_[last].cost;
    }
    return double(cost_) * nanometre;
}

/// Finds all groups that are on a shortest path to the goal.
void PathSearch::Impl::find_path_groups()
{
    if (!has_searched_) start_search();
    expand(cost_, unnumbered);  // visits those that have not been needed to find the goal
    path_groups_.clear();
    const auto number = [&](Group group) {
        labels_[group].number = std::uint32_t(path_groups_.size());
        path_groups_.push_back({group});
    };
    number(graph_->group_of(goal_));
    for (std::size_t k = 0; k < path_groups_.size(); ++k)
        graph_->for_each_leg(path_groups_[k].group, [&, to = path_groups_[k].group](Group from, PathCost cost) {
            if (!is_on_way(from, to, cost)) return;
            path_groups_[k].back |= graph_->direction_of_leg(to, from);
            if (labels_[from].number == unnumbered) number(from);
        });
}

std::vector<PathSearch::Impl::StateId> PathSearch::Impl::states()
{
    find_path_groups();
    // Here, ways between these groups that belong to shortest paths cost nothing, and turns on the spot cost 1.
    reached_.assign(path_groups_.size() * lattice_headings, Reached{});
    const auto reached = [&](Group group, StateId state) -> Reached& {
        return reached_[std::size_t(labels_[group].number) * lattice_headings + state % lattice_headings];
    };
    reached(graph_->group_of(goal_), goal_) = {0, goal_};
    std::deque<std::pair<int, StateId>> queue{{0, goal_}};  // from the goal to the start
    while (!queue.empty()) {
        const auto [turns, state] = queue.front();
        queue.pop_front();
        if (state == start_) break;
        const Group to = graph_->group_of(state);
        if (turns > reached(to, state).turns) continue;
        const auto visit = [&, known = turns, next = state](StateId other, PathCost cost) {
            const bool is_turn = cost == 0;
            const Group from = is_turn ? to : graph_->group_of(other);
            if (!is_turn && !(is_on_way(from, to, cost) && labels_[from].number != unnumbered)) return;
            Reached& there = reached(from, other);
            const int sum = known + (is_turn ? 1 : 0);
            if (sum >= there.turns) return;
            there = {sum, next};
            if (is_turn)
                queue.emplace_back(sum, other);
            else
                queue.emplace_front(sum, other);
        };
        graph_->for_each_neighbour(state, path_groups_[labels_[to].number].back, visit);
    }
    std::vector<StateId> out{start_};
    while (out.back() != goal_) out.push_back(reached(graph_->group_of(out.back()), out.back()).next);
    return out;
}

std::optional<PathSearch::Impl::End> PathSearch::Impl::end_of(const SettledPose& pose) const
{
    const ReachGraph::Impl& graph = graph_->graph();
    const auto state = graph.state_of(pose);
    if (!state) return std::nullopt;
    const StateId id = StateId(state->place) * lattice_headings + StateId(state->heading);
    const Vec3 ground(pose.position.x(), pose.position.y(), pose.ground->height);
    return End{.state = id,
               .island = graph.node_islands[graph.node_of(state->place, state->heading)],
               .stop = {ground, pose.yaw},
               .length = (ground - graph_->ground_of(id)).norm()};
}

std::optional<double> PathSearch::Impl::find(const End& start, const End& goal, double longest)
{
    if (start.island != goal.island) return std::nullopt;
    const auto found = find(start.state, goal.state, longest);
    if (!found) return std::nullopt;
    length_ = *found + start.length + goal.length;
    return length_ <= longest ? std::optional(length_) : std::nullopt;
}

/// Returns the cost of the cheapest way between two neighbours.
PathCost PathSearch::Impl::cost_between(StateId from, StateId to) const
{
    PathCost out = std::numeric_limits<PathCost>::max();
    graph_->for_each_neighbour(from, PathGraph::all_directions, [&](StateId state, PathCost cost) {
        if (state == to) out = std::min(out, cost);
    });
    return out;
}

/// Returns the stops of a car on a curve between two states, without these.
std::vector<Stop> PathSearch::Impl::stops_on_curve(StateId from, StateId to) const
{
    const Vec3 way = graph_->ground_of(to) - graph_->ground_of(from);
    const LatticeMove ahead = lattice_move(heading_of(from));
    if (way.x() * ahead.cols + way.y() * ahead.rows < 0) {  // back: the curve begins at the other end
        std::vector<Stop> out = stops_on_curve(to, from);
        std::reverse(out.begin(), out.end());
        return out;
    }
    const PlaceStates begin{.ground = graph_->ground_of(from).z()}, end{.ground = graph_->ground_of(to).z()};
    const Way turn = heading_of(to) == lattice_heading(heading_of(from), 1) ? Way::Left : Way::Right;
    WayJudge& judge = graph_->graph().way_judges.local();
    const std::vector<RobotAtRest> standings = judge.follow(
        {graph_->ground_of(from).head<2>(), begin, heading_of(from)},
        {graph_->ground_of(to).head<2>(), end, heading_of(to)}, turn, judge.pieces_of_curve(turn, heading_of(from)));
    std::vector<Stop> out;
    for (std::size_t k = 0; k + 1 < standings.size(); ++k) out.push_back({standings[k].ground, standings[k].yaw});
    return out;
}

/// Returns the straight way from start to goal if that is what shortened() makes of the path that was found last.
/// Returns nothing if that is not certain.
std::optional<ShortPath> PathSearch::Impl::straight_path(const End& start, const End& goal) const
{
    constexpr double rounding = 1e-9;  // of the path's length, which shortened() adds up in another order
    auto stops = StraightWays(graph_->graph()).find(start.stop, goal.stop);
    if (!stops) return std::nullopt;
    const double length = length_between(*stops);
    if (!(length <= length_ * (1 - rounding))) return std::nullopt;
    return ShortPath{std::move(*stops), length};
}

ShortPath PathSearch::Impl::path(const End& start, const End& goal, bool shorten)
{
    const bool is_car = graph_->graph().options.drive == Drive::Car;
    if (shorten && !is_car)  // mostly, states() takes longer
        if (auto out = straight_path(start, goal)) return *std::move(out);
    std::vector<Stop> stops{start.stop};
    std::vector<double> lengths{start.length};
    const std::vector<StateId> found = states();
    for (std::size_t k = 0; k < found.size(); ++k) {
        stops.push_back({graph_->ground_of(found[k]), lattice_yaw(heading_of(found[k]))});
        if (k + 1 == found.size()) break;
        lengths.push_back(double(cost_between(found[k], found[k + 1])) * nanometre);
        if (is_car && heading_of(found[k]) != heading_of(found[k + 1]))
            for (Stop& stop : stops_on_curve(found[k], found[k + 1])) stops.push_back(std::move(stop));
    }
    stops.push_back(goal.stop);
    lengths.push_back(goal.length);
    if (shorten && !is_car) return shortened(graph_->graph(), stops, lengths);
    const double length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    return {std::move(stops), length};
}

std::vector<SettledPose> PathSearch::Impl::poses(const ShortPath& path, const SettledPose& start,
                                                 const SettledPose& goal) const
{
    std::vector<SettledPose> out{start};
    for (std::size_t k = 1; k + 1 < path.stops.size(); ++k)
        out.push_back(graph_->graph().judge.settle(path.stops[k].ground, path.stops[k].yaw));
    out.push_back(goal);
    return out;
}

PathSearch::PathSearch(const ReachGraph& graph)
    : impl_(std::make_unique<Impl>(std::make_shared<const PathGraph>(graph.impl())))
{
}
PathSearch::PathSearch(PathSearch&&) noexcept = default;
PathSearch::~PathSearch() = default;

std::optional<Path> PathSearch::path(const SettledPose& start, const SettledPose& goal, double longest)
{
    const auto first = impl_->end_of(start), last = impl_->end_of(goal);
    if (!first || !last || !impl_->find(*first, *last, longest * longest_graph_path)) return std::nullopt;
    const ShortPath found = impl_->path(*first, *last, true);
    if (found.length > longest) return std::nullopt;
    return Path{.poses = impl_->poses(found, start, goal), .length = found.length};
}

}  // namespace spawnfield

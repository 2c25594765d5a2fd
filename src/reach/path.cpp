#include "reach/path_search.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
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
    : graph_(std::move(graph)), labels_(graph_->groups(), Label{0, 0})
{
}

/// Goes on with the search, until all groups whose estimate is at most `most` have been visited, or `until` is found.
/// Returns whether it is.
bool PathSearch::Impl::expand(PathCost most, Group until)
{
    const Group goal = graph_->group_of(goal_);
    while (!queue_.empty() && queue_.top().estimate <= most) {
        const Entry entry = queue_.top();
        queue_.pop();
        if (entry.cost > labels_[entry.group].cost) continue;  // there is a shorter path to it
        if (entry.group == until) return true;
        graph_->for_each_leg(entry.group, [&](Group next, PathCost cost) {
            const PathCost sum = entry.cost + cost;
            if (is_reached(next) && sum >= labels_[next].cost) return;
            labels_[next] = {sum, search_};
            queue_.push({sum + graph_->at_least(next, goal), sum, next});
        });
    }
    return false;
}

std::optional<double> PathSearch::Impl::find(StateId start, StateId goal, double longest)
{
    start_ = start;
    goal_ = goal;
    queue_ = {};
    if (++search_ == 0) {  // the numbers begin anew
        std::fill(labels_.begin(), labels_.end(), Label{0, 0});
        search_ = 1;
    }
    const Group first = graph_->group_of(start), last = graph_->group_of(goal);
    labels_[first] = {0, search_};
    queue_.push({graph_->at_least(first, last), 0, first});
    if (!expand(most_cost(longest), last)) return std::nullopt;
    return double(labels_[last].cost) * nanometre;
}

/// Returns all groups that are on a shortest path to the goal.
std::vector<PathSearch::Impl::Group> PathSearch::Impl::groups_on_shortest_paths()
{
    const Group goal = graph_->group_of(goal_);
    constexpr Group none = std::numeric_limits<Group>::max();
    expand(labels_[goal].cost, none);  // visits those that have not been needed to find the goal
    std::vector<Group> out{goal};
    std::unordered_set<Group> known{goal};
    for (std::size_t k = 0; k < out.size(); ++k)
        graph_->for_each_leg(out[k], [&, to = out[k]](Group from, PathCost cost) {
            if (is_on_way(from, to, cost) && known.insert(from).second) out.push_back(from);
        });
    return out;
}

std::vector<PathSearch::Impl::StateId> PathSearch::Impl::states()
{
    const std::vector<Group> groups = groups_on_shortest_paths();
    const std::unordered_set<Group> is_on_path(groups.begin(), groups.end());
    // Here, ways between these groups that belong to shortest paths cost nothing, and turns on the spot cost 1.
    struct Known {
        int turns;
        StateId parent;
    };
    std::unordered_map<StateId, Known> known{{goal_, {0, goal_}}};
    std::deque<std::pair<int, StateId>> queue{{0, goal_}};  // from the goal to the start
    while (!queue.empty()) {
        const auto [turns, state] = queue.front();
        queue.pop_front();
        if (state == start_) break;
        if (turns > known.at(state).turns) continue;
        for (const auto& [other, cost] : graph_->neighbours(state)) {
            const Group from = graph_->group_of(other);
            const bool is_turn = cost == 0;
            if (!is_turn && !(is_on_path.contains(from) && is_on_way(from, graph_->group_of(state), cost))) continue;
            const int sum = turns + is_turn;
            const auto [there, is_new] = known.try_emplace(other, Known{sum, state});
            if (!is_new && sum >= there->second.turns) continue;
            there->second = {sum, state};
            if (is_turn)
                queue.emplace_back(sum, other);
            else
                queue.emplace_front(sum, other);
        }
    }
    std::vector<StateId> out{start_};
    while (out.back() != goal_) out.push_back(known.at(out.back()).parent);
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
    const double length = *found + start.length + goal.length;
    return length <= longest ? std::optional(length) : std::nullopt;
}

/// Returns the cost of the cheapest way between two neighbours.
PathCost PathSearch::Impl::cost_between(StateId from, StateId to) const
{
    PathCost out = std::numeric_limits<PathCost>::max();
    for (const auto& [state, cost] : graph_->neighbours(from))
        if (state == to) out = std::min(out, cost);
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
    const std::vector<SettledPose> poses = judge.follow({graph_->ground_of(from).head<2>(), begin, heading_of(from)},
                                                        {graph_->ground_of(to).head<2>(), end, heading_of(to)}, turn,
                                                        judge.pieces_of_curve(turn, heading_of(from)));
    std::vector<Stop> out;
    for (std::size_t k = 0; k + 1 < poses.size(); ++k)
        out.push_back({{poses[k].position.x(), poses[k].position.y(), poses[k].ground->height}, poses[k].yaw});
    return out;
}

ShortPath PathSearch::Impl::path(const End& start, const End& goal, bool shorten)
{
    const bool is_car = graph_->graph().options.drive == Drive::Car;
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

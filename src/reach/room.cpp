#include "base/parallel.h"
#include "reach/path_graph.h"

#include <spawnfield/error.h>
#include <spawnfield/room.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

namespace spawnfield {
namespace {

using Group = PathGraph::Group;

/// Finds the places around a group of states, for one thread. Source: Dijkstra, A note on two problems in connexion
/// with graphs, 1959.
class RoomSearch {
public:
    RoomSearch(const PathGraph& graph, const std::vector<std::uint32_t>& places)
        : graph_(graph), places_(places), costs_(graph.groups(), unknown)
    {
    }

    /// Returns the number of places to which a path of at most this cost leads.
    std::size_t places_within(Group start, PathCost most)
    {
        reached_.clear();
        queue_ = {};
        add(start, 0);
        while (!queue_.empty()) {
            const auto [cost, group] = queue_.top();
            queue_.pop();
            if (cost > costs_[group]) continue;  // it was reached on a shorter path
            graph_.for_each_leg(group, [&, c = cost](Group next, PathCost leg) {
                if (c + leg <= most && c + leg < costs_[next]) add(next, c + leg);
            });
        }
        found_.clear();
        for (const Group group : reached_) {
            costs_[group] = unknown;
            found_.push_back(places_[group]);
        }
        std::sort(found_.begin(), found_.end());
        return std::size_t(std::unique(found_.begin(), found_.end()) - found_.begin());
    }

private:
    static constexpr PathCost unknown = std::numeric_limits<PathCost>::max();
    using Entry = std::pair<PathCost, Group>;

    void add(Group group, PathCost cost)
    {
        if (costs_[group] == unknown) reached_.push_back(group);
        costs_[group] = cost;
        queue_.push({cost, group});
    }

    const PathGraph& graph_;
    const std::vector<std::uint32_t>& places_;
    std::vector<PathCost> costs_;  ///< of each group
    std::vector<Group> reached_;
    std::vector<std::uint32_t> found_;  ///< their places
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

/// Returns the place of each group.
std::vector<std::uint32_t> places_of_groups(const PathGraph& graph)
{
    std::vector<std::uint32_t> out(graph.groups());
    const std::vector<HeadingSet>& valid = graph.graph().valid;
    for (std::size_t place = 0; place < valid.size(); ++place)
        for (int heading = 0; heading < lattice_headings; ++heading)
            if (has_heading(valid[place], heading))
                out[graph.group_of(PathGraph::StateId(place) * lattice_headings + PathGraph::StateId(heading))] =
                    std::uint32_t(place);
    return out;
}

/// The rooms of groups that were asked for.
class Rooms {
public:
    Rooms(const ReachGraph& graph, double range)
        : graph_(graph.impl()), most_(path_cost(range, 0)), places_(places_of_groups(graph_)), numbers_(graph_.groups())
    {
    }

    double at(const Pose& pose) const
    {
        const SettledPose settled = graph_.graph().judge.settle(std::span(&pose, 1), {.threads = 1}).front();
        const auto state = graph_.graph().state_of(settled);
        if (!state) return 0;
        const Group group = graph_.group_of(PathGraph::StateId(state->place) * lattice_headings +
                                            PathGraph::StateId(state->heading));
        std::uint64_t number = numbers_[group].load(std::memory_order_relaxed);
        if (number == 0) {
            number = searches_.local().places_within(group, most_);
            numbers_[group].store(number, std::memory_order_relaxed);
        }
        return double(number) * graph_.graph().grid.step * graph_.graph().grid.step;
    }

private:
    const PathGraph graph_;
    const PathCost most_;
    const std::vector<std::uint32_t> places_;
    mutable std::vector<std::atomic<std::uint64_t>> numbers_;  ///< of places around each group; 0: not known yet
    mutable PerThread<RoomSearch> searches_{[this] { return RoomSearch(graph_, places_); }};
};

}  // namespace

RoomMeter room_on(const ReachGraph& graph, double range)
{
    if (!(range > 0 && range <= PlaceMeasures::most_room_range))
        throw ArgumentError("room_on", "range", range,
                            "> 0 and at most " + std::to_string(int(PlaceMeasures::most_room_range)) + " m");
    return [rooms = std::make_shared<const Rooms>(graph, range)](const Pose& pose) { return rooms->at(pose); };
}

}  // namespace spawnfield

#pragma once

#include "reach/path_graph.h"
#include "reach/shorten.h"

#include <spawnfield/path.h>

#include <functional>
#include <queue>

namespace spawnfield {

/// A path in the open, shortened, has at least the length of a path of the graph divided by this.
inline constexpr double longest_graph_path = 1.03;

/// Finds shortest paths with A*. Source: Hart, Nilsson, Raphael, A formal basis for the heuristic determination of
/// minimum cost paths, 1968.
class PathSearch::Impl {
public:
    using StateId = PathGraph::StateId;

    explicit Impl(std::shared_ptr<const PathGraph> graph);

    /// Returns the length of the shortest path between two states if it is not longer than `longest`, both in m.
    std::optional<double> find(StateId start, StateId goal, double longest);
    /// Returns the states of the shortest path that the last call of find() found, from its start to its goal; of
    /// several ones, one with the fewest turns on the spot.
    std::vector<StateId> states();

    /// How a settled pose is joined with the graph.
    struct End {
        StateId state;
        std::size_t island;
        Stop stop;      ///< where the pose is
        double length;  ///< from the ground below the pose to that of the state, m
    };
    /// Returns nothing for a pose that is not valid or on no island.
    std::optional<End> end_of(const SettledPose& pose) const;

    /// Returns the length of the shortest path of the graph between two poses.
    std::optional<double> find(const End& start, const End& goal, double longest);
    /// Returns the path that the last call of find() found between these ends; if wanted, it is shortened().
    ShortPath path(const End& start, const End& goal, bool shorten);
    /// Returns the settled poses of a path, between a start and a goal.
    std::vector<SettledPose> poses(const ShortPath& path, const SettledPose& start, const SettledPose& goal) const;

    const PathGraph& graph() const { return *graph_; }

private:
    using Group = PathGraph::Group;
    struct Label {
        PathCost cost;
        std::uint32_t search;  ///< number of the search that wrote this label
    };
    struct Entry {
        PathCost estimate, cost;
        Group group;
        /// Among entries with the same estimate, the one nearest to the goal comes first.
        bool operator>(const Entry& other) const
        {
            if (estimate != other.estimate) return estimate > other.estimate;
            return cost != other.cost ? cost < other.cost : group > other.group;
        }
    };

    bool is_reached(Group group) const { return labels_[group].search == search_; }
    bool is_on_way(Group from, Group to, PathCost cost) const
    {
        return is_reached(from) && labels_[from].cost + cost == labels_[to].cost;
    }
    PathCost cost_between(StateId from, StateId to) const;
    std::vector<Stop> stops_on_curve(StateId from, StateId to) const;
    bool expand(PathCost most, Group until);
    std::vector<Group> groups_on_shortest_paths();

    std::shared_ptr<const PathGraph> graph_;
    std::vector<Label> labels_;  ///< of each group
    std::uint32_t search_ = 0;   ///< number of the last search
    StateId start_ = 0, goal_ = 0;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace spawnfield

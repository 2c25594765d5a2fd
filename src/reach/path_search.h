#pragma once

#include "reach/path_graph.h"
#include "reach/shorten.h"

#include <spawnfield/path.h>

#include <functional>
#include <limits>
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
    static constexpr std::uint32_t unnumbered = std::numeric_limits<std::uint32_t>::max();
    struct Label {
        PathCost cost;
        std::uint32_t search;  ///< number of the search that wrote this label
        std::uint32_t number;  ///< in path_groups_, or unnumbered
    };
    struct Entry {
        PathCost estimate, cost;
        Group group;
        std::uint8_t leg;  ///< with which it was reached, or unknown_leg
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
    void start_search();
    std::optional<Entry> pop(PathCost most);
    void put(Group group, PathCost cost, std::uint8_t leg);
    PathCost cost_between(StateId from, StateId to) const;
    std::vector<Stop> stops_on_curve(StateId from, StateId to) const;
    bool expand(PathCost most, Group until);
    void find_path_groups();
    std::optional<ShortPath> straight_path(const End& start, const End& goal) const;

    std::shared_ptr<const PathGraph> graph_;
    std::vector<Label> labels_;  ///< of each group
    std::uint32_t search_ = 0;   ///< number of the last search
    StateId start_ = 0, goal_ = 0;
    Group goal_group_ = 0;
    PathCost cost_ = 0;          ///< of the path that was found last
    double length_ = 0;          ///< of the path between two poses that was found last, m
    bool has_searched_ = false;  ///< whether labels_ are those of a search from start_ to goal_
    /// A group on a shortest path from the start to the goal, and the directions from there to those before it.
    struct PathGroup {
        Group group;
        PathGraph::Directions back = 0;
    };
    std::vector<PathGroup> path_groups_;
    /// How a state is reached from the goal on a shortest path with the fewest turns.
    struct Reached {
        int turns = std::numeric_limits<int>::max();
        StateId next = 0;  ///< towards the goal
    };
    std::vector<Reached> reached_;  ///< by number of the group and heading
    /// Entries that come before queue_: their estimates are at most least_, that of the last entry from there. On open
    /// ground, most entries are of this kind.
    std::vector<Entry> ready_;
    PathCost least_ = 0;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace spawnfield

#pragma once

#include "reach/reach_graph.h"

#include <spawnfield/path.h>

#include <queue>

namespace spawnfield {

/// The length of a way or of a path in nanometres, multiplied by cost_per_nanometre, and the number of its turns on the
/// spot. So turns only decide between paths of the same length. Whole numbers have the same sum in any order.
using PathCost = std::int64_t;
inline constexpr PathCost turn_cost = 1, cost_per_nanometre = 1 << 16;

/// Returns the length of a way that begins at a heading, seen from above, in steps of the grid.
double way_length(Way way, int heading);

/// Returns the cost of a way with this length seen from above over ground that rises, both in m. Rounds the length up.
PathCost path_cost(double length, double rise);

/// Finds shortest paths with A*. Source: Hart, Nilsson, Raphael, A formal basis for the heuristic determination of
/// minimum cost paths, 1968.
class PathSearch::Impl {
public:
    using StateId = std::uint64_t;  ///< 16 * place + heading

    explicit Impl(std::shared_ptr<const ReachGraph::Impl> graph);

    struct Found {
        PathCost cost;
        std::vector<StateId> states;  ///< from the start to the goal
        double length;                ///< m
    };
    /// Returns the shortest path between two states that is not longer than `longest` (m).
    std::optional<Found> find(StateId start, StateId goal, double longest);

    /// How a settled pose is joined with the graph.
    struct End {
        StateId state;
        std::size_t island;
        Vec3 ground;    ///< below the pose, m
        double length;  ///< from the ground below the pose to that of the state, m
    };
    /// Returns nothing for a pose that is not valid or on no island.
    std::optional<End> end_of(const SettledPose& pose) const;

    /// Returns the same between two poses; its cost is that between their states.
    std::optional<Found> find(const End& start, const End& goal, double longest);
    /// Returns the path with its poses.
    Path path_of(const Found& found, const SettledPose& start, const SettledPose& goal) const;

    const ReachGraph::Impl& graph() const { return *graph_; }
    Vec3 ground_of(std::size_t place) const;

private:
    static constexpr std::uint32_t none = ~std::uint32_t(0);
    struct Label {
        PathCost cost;
        StateId parent;
    };
    struct Entry {
        PathCost estimate, cost;
        StateId state;
        bool operator>(const Entry& other) const
        {
            return estimate != other.estimate ? estimate > other.estimate : state > other.state;
        }
    };
    using Labels = std::array<Label, lattice_headings>;

    Label& label(StateId state);
    template <class Visit>
    void for_each_neighbour(StateId state, const Visit& visit) const;
    template <class Visit>
    void for_each_moving_neighbour(StateId state, Way way, const Visit& visit) const;
    PathCost at_least(StateId state, const Vec3& goal) const;
    Found trace(StateId start, StateId goal);

    std::shared_ptr<const ReachGraph::Impl> graph_;
    std::vector<std::uint32_t> column_of_place_;
    std::vector<std::uint32_t> labels_of_place_;
    std::vector<std::size_t> reached_;  ///< places that have labels
    std::vector<Labels> labels_;
    std::array<std::array<double, lattice_headings>, way_count> lengths_;  ///< of ways seen from above, m
};

}  // namespace spawnfield

#pragma once

#include "reach/reach_graph.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace spawnfield {

/// The length of a way or of a path in nanometres. Whole numbers have the same sum in any order.
using PathCost = std::int64_t;
inline constexpr double nanometre = 1e-9;  ///< m

/// Returns the length of the shortest path in the open to another column, seen from above, in steps of the grid: at
/// least the straight line, and at most 2 % longer. No path of a robot that turns on the spot is shorter.
double open_length(int cols, int rows);

/// Returns the cost of a way with this length seen from above over ground that rises, both in m. Rounds the length up.
PathCost path_cost(double length, double rise);

/// A drivable graph as shortest paths see it. A turn on the spot has no length, so its nodes are groups: states of one
/// place between which the robot can turn on the spot. 2 bytes for each place, 20 for each group, and 5 for each leg,
/// of which a group has at most 32 if each column has one layer.
class PathGraph {
public:
    using Group = std::uint32_t;
    using StateId = std::uint64_t;  ///< 16 * place + heading

    /// Throws ArgumentError if the graph does not keep its ways, or is too large for paths.
    explicit PathGraph(std::shared_ptr<const ReachGraph::Impl> graph);

    const ReachGraph::Impl& graph() const { return *graph_; }
    std::size_t groups() const { return spots_.size(); }
    Group group_of(StateId state) const;

    Vec3 ground_of(StateId state) const;  ///< m

    /// Calls visit(group, cost) for all groups to which a way leads from this one. The robot can also go back.
    template <class Visit>
    void for_each_leg(Group from, const Visit& visit) const
    {
        for (std::uint64_t leg = first_leg_[from]; leg < first_leg_[from + 1]; ++leg)
            visit(leg_ends_[leg], leg_cost(spots_[from], spots_[leg_ends_[leg]], leg_shapes_[leg]));
    }

    /// Returns a cost that no path between two groups falls short of: that over open ground which rises evenly, of a
    /// car in a straight line; without rounding errors.
    PathCost at_least(Group from, Group to) const;

    struct Neighbour {
        StateId state;
        PathCost cost;  ///< 0: it is reached by a turn on the spot
    };
    /// Returns the states to which a turn on the spot or another way leads from a state, and those from which one leads
    /// to it.
    std::vector<Neighbour> neighbours(StateId state) const;

private:
    /// Where a group is.
    struct Spot {
        std::int32_t col, row;
        double ground;  ///< m
    };
    static constexpr std::size_t shapes = 5;  ///< of legs, seen from above, apart from reflections and quarter turns

    /// Legs of the groups of a row.
    struct RowOfLegs {
        std::vector<std::uint32_t> counts;  ///< of each group
        std::vector<Group> ends;
        std::vector<std::uint8_t> shapes;
    };

    PathCost leg_cost(const Spot& from, const Spot& to, std::uint8_t shape) const
    {
        const double rise = to.ground - from.ground;
        return rise == 0 ? level_costs_[shape] : path_cost(lengths_[shape], rise);
    }
    const Spot& spot_of(StateId state) const { return spots_[first_group_[state / lattice_headings]]; }
    void find_groups();
    RowOfLegs legs_of_row(int row) const;
    template <class Visit>
    void for_each_moving_neighbour(StateId state, Way way, const Visit& visit) const;

    std::shared_ptr<const ReachGraph::Impl> graph_;
    std::vector<std::uint32_t> first_group_;  ///< of each place, then their number
    std::vector<HeadingSet> starts_;        ///< of each place: headings to which no turn leads from the heading before
    std::vector<Spot> spots_;               ///< of each group
    std::vector<std::uint64_t> first_leg_;  ///< of each group, then their number
    std::vector<Group> leg_ends_;
    std::vector<std::uint8_t> leg_shapes_;
    std::array<double, shapes> lengths_{};        ///< seen from above, m
    std::array<PathCost, shapes> level_costs_{};  ///< on level ground
};

}  // namespace spawnfield

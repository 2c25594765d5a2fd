#pragma once

#include "reach/reach_graph.h"

#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
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

/// Returns the shape of a way, seen from above: 0, 1, 2 are straight ways at the headings 0, 1 and 2, 3 and 4 curves
/// between them. All other ways are reflections or quarter turns of these; those of cars are longer.
constexpr std::uint8_t shape_of(Way way, int heading)
{
    if (is_curve(way)) {
        const int between = way == Way::Left ? heading : lattice_heading(heading, -1);  // this heading and the next one
        return between % 4 == 0 || between % 4 == 3 ? 3 : 4;
    }
    return std::uint8_t(heading % 4 == 3 ? 1 : heading % 4);
}

/// A drivable graph as shortest paths see it. A turn on the spot has no length, so its nodes are groups: states of one
/// place between which the robot can turn on the spot. 6 bytes for each place, 25 for each group, and 5 for each leg,
/// of which a group has at most 32 if each column has one layer. Legs of groups in the middle of level ground are the
/// same for all of them, and not stored.
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
        for_each_useful_leg(from, unknown_leg, [&](Group to, PathCost cost, std::uint8_t) { visit(to, cost); });
    }

    static constexpr std::uint8_t unknown_leg = 32;
    /// Calls visit(group, cost, leg) for some of these groups: without those to which no shorter path leads over this
    /// group than over other ones. `before`: what visit() got as `leg` when this group was reached, or unknown_leg.
    ///
    /// Let a be the group before, b this one and c the next one. If a and c are level, there are paths from a to c over
    /// all groups that one leg joins with both. So b is not needed if one of these paths is shorter, or as long, with a
    /// last leg of a higher number: of all shortest paths to c, one whose last leg has the highest number remains.
    template <class Visit>
    void for_each_useful_leg(Group from, std::uint8_t before, const Visit& visit) const
    {
        if (levels_[from] != Level::None) {
            const std::size_t column = graph_->column_of(spots_[from].col, spots_[from].row);
            const Directions useful = useful_legs_[before];
            const auto visit_leg = [&](int k, Directions legs) {
                const LevelLeg& leg = level_legs_[std::size_t(k)];
                const Group to = group_in(column + std::size_t(leg.column_offset));
                if ((legs >> k & 1) != 0 || levels_[to] == Level::None)
                    visit(to, level_costs_[leg.shape], std::uint8_t(k));
            };
            if (levels_[from] == Level::Inner)
                for (Directions left = useful; left != 0; left &= left - 1) visit_leg(std::countr_zero(left), useful);
            else
                for (int k = 0; k < int(level_legs_.size()); ++k) visit_leg(k, useful);
            return;
        }
        for (std::uint64_t leg = first_leg_[from]; leg < first_leg_[from + 1]; ++leg)
            visit(leg_ends_[leg], leg_cost(spots_[from], spots_[leg_ends_[leg]], leg_shapes_[leg]), unknown_leg);
    }

    /// Returns a cost that no path between two groups falls short of: that over open ground which rises evenly, of a
    /// car in a straight line. On level ground, it is exactly the cost of the shortest path in the open.
    PathCost at_least(Group from, Group to) const;
    /// Returns the cost of the shortest path between two groups, if there is one along the straight line over open,
    /// level ground. No graph has a shorter one.
    std::optional<PathCost> cost_in_the_open(Group from, Group to) const;

    /// Some of the displacements that legs can have, as seen from above: bit k is the straight way at heading k, and
    /// bit 16 + k the curve from heading k to the next one.
    using Directions = std::uint32_t;
    static constexpr Directions all_directions = ~Directions(0);
    /// Returns the direction of a leg. The legs of cars have more displacements, so that of a car can be any.
    Directions direction_of_leg(Group from, Group to) const;

    /// Calls visit(state, cost) for the states to which a turn on the spot or another way leads from a state, and those
    /// from which one leads to it. The cost of a turn is 0. Ways, but not turns, are left out if they do not lead in
    /// one of these directions.
    template <class Visit>
    void for_each_neighbour(StateId state, Directions directions, const Visit& visit) const;

private:
    /// Where a group is.
    struct Spot {
        std::int32_t col, row;
        double ground;  ///< m
    };
    /// Whether a group has all legs that there are, to groups at the same height, which are the only ones in their
    /// columns. Inner: so have all these groups.
    enum class Level : std::uint8_t { None, Some, Inner };
    /// A leg of a level group to another column. Its number is that of its bit in Directions.
    struct LevelLeg {
        std::ptrdiff_t column_offset;
        LatticeMove move;
        std::uint8_t shape;
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
    Group group_in(std::size_t column) const { return first_group_[graph_->first[column]]; }  ///< the first one
    PathCost level_cost(int cols, int rows) const;
    void find_groups();
    void set_level_legs();
    void find_level_groups();
    void find_inner_groups();
    bool has_all_level_ways(std::size_t place) const;
    RowOfLegs legs_of_row(int row) const;
    template <class Visit>
    void for_each_moving_neighbour(StateId state, Way way, Directions directions, const Visit& visit) const;

    std::shared_ptr<const ReachGraph::Impl> graph_;
    std::vector<std::uint32_t> first_group_;  ///< of each place, then their number
    std::vector<HeadingSet> starts_;  ///< of each place: headings to which no turn leads from the heading before
    std::vector<Spot> spots_;         ///< of each group
    std::vector<Level> levels_;       ///< of each group
    std::vector<LevelLeg> level_legs_;
    std::array<Directions, unknown_leg + 1> useful_legs_{};  ///< after each leg between level groups
    std::vector<std::uint64_t> first_leg_;                   ///< of each group, then their number; none if it is level
    std::vector<Group> leg_ends_;
    std::vector<std::uint8_t> leg_shapes_;
    std::array<double, shapes> lengths_{};        ///< seen from above, m
    std::array<PathCost, shapes> level_costs_{};  ///< on level ground
};

/// Returns the direction of a way from a state.
inline PathGraph::Directions direction_of(Way way, int heading)
{
    const int first = way == Way::Aside   ? to_the_left(heading)
                      : way == Way::Right ? lattice_heading(heading, -1)
                                          : heading;
    return PathGraph::Directions(1) << (first + (is_curve(way) ? lattice_headings : 0));
}
/// Returns the opposite direction.
inline PathGraph::Directions opposite_of(PathGraph::Directions direction)
{
    constexpr PathGraph::Directions first_half = 0x00ff00ff;
    constexpr int half = lattice_headings / 2;
    return (direction & first_half) << half | (direction >> half & first_half);
}

/// Calls visit(state, shape) for the state to which a way leads from a state, and for those from which it leads to it.
template <class Visit>
void PathGraph::for_each_moving_neighbour(StateId state, Way way, Directions directions, const Visit& visit) const
{
    const RasterGrid& grid = graph_->grid;
    const std::vector<ReachGraph::Impl::Ways>& ways = graph_->ways[std::size_t(way)];
    if (ways.empty()) return;
    const std::size_t place = state / lattice_headings;
    const Spot& spot = spot_of(state);
    const int heading = int(state % lattice_headings);
    if ((direction_of(way, heading) & directions) != 0)
        if (const std::uint8_t index = ways[place][std::size_t(heading)]; index != ReachGraph::Impl::nowhere) {
            const WayEnd end = graph_->lattice.end(way, heading);
            const std::size_t column = graph_->column_of(spot.col + end.move.cols, spot.row + end.move.rows);
            visit(StateId(graph_->first[column] + index) * lattice_headings + StateId(end.heading),
                  shape_of(way, heading));
        }
    // Back: a curve to the left that ends at this heading began at the one before.
    const int begin = lattice_heading(heading, way == Way::Left ? -1 : way == Way::Right ? 1 : 0);
    if ((opposite_of(direction_of(way, begin)) & directions) == 0) return;
    const LatticeMove move = graph_->lattice.end(way, begin).move;
    const int from_col = spot.col - move.cols, from_row = spot.row - move.rows;
    if (from_col < 0 || from_row < 0 || from_col >= grid.cols || from_row >= grid.rows) return;
    const std::size_t here = place - graph_->first[graph_->column_of(spot.col, spot.row)],
                      column = graph_->column_of(from_col, from_row);
    for (std::size_t other = graph_->first[column]; other < graph_->first[column + 1]; ++other)
        if (ways[other][std::size_t(begin)] == here)
            visit(StateId(other) * lattice_headings + StateId(begin), shape_of(way, begin));
}

template <class Visit>
void PathGraph::for_each_neighbour(StateId state, Directions directions, const Visit& visit) const
{
    const std::size_t place = state / lattice_headings;
    const int heading = int(state % lattice_headings), before = lattice_heading(heading, -1);
    const ReachGraph::Impl::Ways& turns = graph_->ways[std::size_t(Way::Turn)][place];
    const StateId first = StateId(place) * lattice_headings;
    if (turns[std::size_t(heading)] != ReachGraph::Impl::nowhere)
        visit(first + StateId(lattice_heading(heading, 1)), PathCost(0));
    if (turns[std::size_t(before)] != ReachGraph::Impl::nowhere) visit(first + StateId(before), PathCost(0));
    for (const Way way : ReachGraph::Impl::moving_ways)
        for_each_moving_neighbour(state, way, directions, [&](StateId other, std::uint8_t shape) {
            visit(other, leg_cost(spot_of(state), spot_of(other), shape));
        });
}

}  // namespace spawnfield

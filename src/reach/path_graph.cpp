#include "reach/path_graph.h"

#include "base/parallel.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

Vec2 vector_of(const LatticeMove& move) { return {double(move.cols), double(move.rows)}; }

/// Returns a way of each shape.
std::pair<Way, int> shape_way(int shape)
{
    return shape < 3 ? std::pair(Way::Ahead, shape) : std::pair(Way::Left, shape - 3);
}

/// In the open, the unit circle of path lengths seen from above is a polygon. Its corners are the ends of straight ways
/// and curves, scaled to length 1. Shortest paths consist of the two ways at the corners of a side, with turns on the
/// spot between them. Returns, for each side between the headings 0 and 2, the vector whose scalar product with the end
/// of a path on that side is its length.
std::array<Vec2, 4> sides_of_unit_circle()
{
    const Lattice lattice;
    const auto corner = [&](int k) {  // straight ahead, curve, straight ahead, ...; counterclockwise
        const Way way = k % 2 == 0 ? Way::Ahead : Way::Left;
        return std::pair(vector_of(lattice.end(way, k / 2).move), lattice.length(way, k / 2));
    };
    std::array<Vec2, 4> out;
    for (int k = 0; k < 4; ++k) {
        const auto [along, length] = corner(k);
        const auto [next_along, next_length] = corner(k + 1);
        Eigen::Matrix2d ends;
        ends << along.transpose(), next_along.transpose();
        out[std::size_t(k)] = ends.inverse() * Vec2(length, next_length);
    }
    return out;
}

}  // namespace

double open_length(int cols, int rows)
{
    static const std::array<Vec2, 4> sides = sides_of_unit_circle();
    const int along = std::abs(cols), across = std::abs(rows);  // the circle is the same in each eighth
    const Vec2 end(std::max(along, across), std::min(along, across));
    double out = 0;
    for (const Vec2& side : sides) out = std::max(out, side.dot(end));  // the polygon is convex
    return out;
}

namespace {

/// Some equal legs of a path.
struct EqualLegs {
    std::size_t shape;
    std::int64_t count;
    LatticeMove move;  ///< of each of them
};

/// Returns the two kinds of legs of a shortest path in the open to another column. The lengths of all shapes form a
/// convex polygon, so no path with other legs is shorter. Each column between the directions of two neighbouring shapes
/// can be reached, because the determinant of their displacements is 1. Lengths that are rounded up to nanometres also
/// form such a polygon, if the step is above 1e-6 m.
std::array<EqualLegs, 2> level_legs(int cols, int rows)
{
    const std::int64_t along = std::abs(cols), across = std::abs(rows), a = std::max(along, across),
                       b = std::min(along, across);
    std::array<EqualLegs, 2> out{EqualLegs{4, a - b, {3, 2}}, EqualLegs{2, 3 * b - 2 * a, {1, 1}}};
    if (3 * b <= a)
        out = {EqualLegs{0, a - 3 * b, {1, 0}}, EqualLegs{3, b, {3, 1}}};
    else if (2 * b <= a)
        out = {EqualLegs{3, a - 2 * b, {3, 1}}, EqualLegs{1, 3 * b - a, {2, 1}}};
    else if (3 * b <= 2 * a)
        out = {EqualLegs{1, 2 * a - 3 * b, {2, 1}}, EqualLegs{4, 2 * b - a, {3, 2}}};
    for (EqualLegs& legs : out) {
        if (across > along) std::swap(legs.move.cols, legs.move.rows);
        if (cols < 0) legs.move.cols = -legs.move.cols;
        if (rows < 0) legs.move.rows = -legs.move.rows;
    }
    return out;
}

}  // namespace

PathCost path_cost(double length, double rise) { return PathCost(std::ceil(std::hypot(length, rise) / nanometre)); }

PathGraph::PathGraph(std::shared_ptr<const ReachGraph::Impl> graph) : graph_(std::move(graph))
{
    if (graph_->keep != ReachGraph::Impl::Keep::Ways)
        throw ArgumentError("PathSearch", "the graph does not keep its ways; build it with ReachOptions::keep_ways");
    for (std::size_t shape = 0; shape < shapes; ++shape) {
        const auto [way, heading] = shape_way(int(shape));
        lengths_[shape] = graph_->grid.step * graph_->lattice.length(way, heading);
        level_costs_[shape] = path_cost(lengths_[shape], 0);
    }
    find_groups();
    levels_.assign(groups(), Level::None);
    if (graph_->options.drive != Drive::Car) {
        set_level_legs();
        find_level_groups();
        find_inner_groups();
    }
    std::vector<RowOfLegs> rows(std::size_t(graph_->grid.rows));
    parallel_for(rows.size(), graph_->options.threads, {}, [&](std::size_t row) { rows[row] = legs_of_row(int(row)); });
    first_leg_.reserve(groups() + 1);
    first_leg_.push_back(0);
    std::size_t legs = 0;
    for (const RowOfLegs& row : rows) legs += row.ends.size();
    leg_ends_.reserve(legs);
    leg_shapes_.reserve(legs);
    for (RowOfLegs& row : rows) {
        for (const std::uint32_t count : row.counts) first_leg_.push_back(first_leg_.back() + count);
        leg_ends_.insert(leg_ends_.end(), row.ends.begin(), row.ends.end());
        leg_shapes_.insert(leg_shapes_.end(), row.shapes.begin(), row.shapes.end());
        row = {};
    }
}

void PathGraph::find_groups()
{
    const std::size_t places = graph_->ground.size();
    const std::vector<ReachGraph::Impl::Ways>& turns = graph_->ways[std::size_t(Way::Turn)];
    first_group_.reserve(places + 1);
    starts_.reserve(places);
    spots_.reserve(places);
    for (std::size_t column = 0; column + 1 < graph_->first.size(); ++column)
        for (std::size_t place = graph_->first[column]; place < graph_->first[column + 1]; ++place) {
            HeadingSet starts = 0;
            for (int heading = 0; heading < lattice_headings; ++heading)
                if (has_heading(graph_->valid[place], heading) &&
                    turns[place][std::size_t(lattice_heading(heading, -1))] == ReachGraph::Impl::nowhere)
                    starts = HeadingSet(starts | 1u << heading);
            first_group_.push_back(Group(spots_.size()));
            starts_.push_back(starts);
            const int cols = graph_->grid.cols;
            const Spot spot{int(column) % cols, int(column) / cols, graph_->ground[place]};
            if (spots_.size() + lattice_headings > std::numeric_limits<Group>::max())
                throw ArgumentError("PathSearch",
                                    "the graph is too large for paths; choose a larger ReachOptions::step");
            spots_.resize(spots_.size() + std::size_t(std::max(1, std::popcount(starts))), spot);
        }
    first_group_.push_back(Group(spots_.size()));
}

PathGraph::Group PathGraph::group_of(StateId state) const
{
    const std::size_t place = state / lattice_headings;
    const Group first = first_group_[place], last = first_group_[place + 1] - 1;
    if (first == last) return first;
    const unsigned up_to = 2u << (state % lattice_headings);
    const int before = std::popcount(HeadingSet(starts_[place] & (up_to - 1)));  // starts at this heading or before it
    return before > 0 ? first + Group(before) - 1 : last;                        // the last group goes on at heading 0
}

Vec3 PathGraph::ground_of(StateId state) const
{
    const Spot& spot = spot_of(state);
    return {graph_->grid.x_of(spot.col), graph_->grid.y_of(spot.row), spot.ground};
}

PathCost PathGraph::at_least(Group from, Group to) const
{
    constexpr double rounding = 1e-12;  // of the length
    const Spot &begin = spots_[from], &end = spots_[to];
    const int cols = end.col - begin.col, rows = end.row - begin.row;
    const double rise = end.ground - begin.ground;
    const bool turns = graph_->options.drive != Drive::Car;
    const PathCost level = turns ? level_cost(cols, rows) : 0;
    if (turns && rise == 0) return level;
    const double length = (turns ? open_length(cols, rows) : std::hypot(cols, rows)) * graph_->grid.step;
    return std::max(level, PathCost(std::hypot(length, rise) * (1 - rounding) / nanometre));
}

/// Returns the cost of the shortest path in the open to another column of level ground. It consists of two shapes.
PathCost PathGraph::level_cost(int cols, int rows) const
{
    const auto [some, others] = level_legs(cols, rows);
    return some.count * level_costs_[some.shape] + others.count * level_costs_[others.shape];
}

PathGraph::Directions PathGraph::direction_of_leg(Group from, Group to) const
{
    if (graph_->options.drive == Drive::Car) return all_directions;
    static const auto directions = [] {
        std::array<std::array<Directions, 7>, 7> out{};  // by displacement + 3
        const Lattice lattice;
        for (const Way way : {Way::Ahead, Way::Left})
            for (int heading = 0; heading < lattice_headings; ++heading) {
                const LatticeMove move = lattice.end(way, heading).move;
                out[std::size_t(move.cols + 3)][std::size_t(move.rows + 3)] = direction_of(way, heading);
            }
        return out;
    }();
    const Spot &begin = spots_[from], &end = spots_[to];
    return directions[std::size_t(end.col - begin.col + 3)][std::size_t(end.row - begin.row + 3)];
}

std::optional<PathCost> PathGraph::cost_in_the_open(Group from, Group to) const
{
    const Spot &begin = spots_[from], &end = spots_[to];
    if (begin.ground != end.ground || graph_->options.drive == Drive::Car) return std::nullopt;
    const auto legs = level_legs(end.col - begin.col, end.row - begin.row);
    const std::int64_t count = legs[0].count + legs[1].count;
    Group at = from;
    LatticeMove done{0, 0};
    for (std::int64_t k = 1, firsts = 0; k <= count; ++k) {  // the shapes take turns, so the path is near the line
        const bool is_first = k * legs[0].count / count > firsts;
        firsts += is_first ? 1 : 0;
        done = done + legs[is_first ? 0 : 1].move;
        const std::size_t column = graph_->column_of(begin.col + done.cols, begin.row + done.rows);
        if (graph_->first[column + 1] == graph_->first[column]) return std::nullopt;
        const Group next = k == count ? to : group_in(column);
        if (levels_[at] == Level::None && levels_[next] == Level::None) return std::nullopt;
        at = next;
    }
    return at == to ? std::optional(level_cost(end.col - begin.col, end.row - begin.row)) : std::nullopt;
}

/// Returns whether a place has one group, and ways in all directions to the first place of the column there.
bool PathGraph::has_all_level_ways(std::size_t place) const
{
    constexpr ReachGraph::Impl::Ways to_the_first{};
    return graph_->valid[place] == HeadingSet(~0u) && starts_[place] == 0 &&
           graph_->ways[std::size_t(Way::Ahead)][place] == to_the_first &&
           graph_->ways[std::size_t(Way::Left)][place] == to_the_first &&
           graph_->ways[std::size_t(Way::Right)][place] == to_the_first;
}

/// Finds the groups around which all columns in a square have a single group at the same height. No leg of a group
/// leads out of its square.
void PathGraph::find_level_groups()
{
    constexpr int reach = 3, side = 2 * reach + 1;  // columns
    const RasterGrid& grid = graph_->grid;
    const auto is_single = [&](std::size_t column) {
        const std::size_t place = graph_->first[column];
        return graph_->first[column + 1] == place + 1 && first_group_[place + 1] == first_group_[place] + 1;
    };
    const auto ground = [&](std::size_t column) { return graph_->ground[graph_->first[column]]; };
    // How many columns in a row, up to this one, have a single group each, at the same height; at most `side`.
    std::vector<std::uint8_t> runs(graph_->first.size() - 1, 0);
    parallel_for(std::size_t(grid.rows), graph_->options.threads, {}, [&](std::size_t row) {
        for (int col = 0; col < grid.cols; ++col) {
            const std::size_t column = graph_->column_of(col, int(row));
            if (!is_single(column)) continue;
            const bool goes_on = col > 0 && runs[column - 1] > 0 && ground(column - 1) == ground(column);
            runs[column] = std::uint8_t(goes_on ? std::min(runs[column - 1] + 1, side) : 1);
        }
    });
    parallel_for(std::size_t(grid.rows), graph_->options.threads, {}, [&](std::size_t i) {
        const int row = int(i);
        if (row < reach || row >= grid.rows - reach) return;
        for (int col = reach; col < grid.cols - reach; ++col) {
            const std::size_t column = graph_->column_of(col, row);
            bool is_level = runs[column + reach] == side;
            for (int k = -reach; k <= reach && is_level; ++k) {
                const std::size_t other = graph_->column_of(col, row + k);
                is_level = runs[other + reach] == side && ground(other) == ground(column);
            }
            if (is_level && has_all_level_ways(graph_->first[column])) levels_[group_in(column)] = Level::Some;
        }
    });
}

/// Finds the level groups all of whose legs lead to level groups.
void PathGraph::find_inner_groups()
{
    std::vector<std::uint8_t> is_inner(groups(), 0);  // not bool: threads write to neighbours
    constexpr std::size_t block = 4096;
    parallel_for((groups() + block - 1) / block, graph_->options.threads, {}, [&](std::size_t k) {
        for (std::size_t group = k * block; group < std::min(groups(), (k + 1) * block); ++group) {
            if (levels_[group] == Level::None) continue;
            const std::size_t column = graph_->column_of(spots_[group].col, spots_[group].row);
            is_inner[group] = std::all_of(level_legs_.begin(), level_legs_.end(), [&](const LevelLeg& leg) {
                return levels_[group_in(column + std::size_t(leg.column_offset))] != Level::None;
            });
        }
    });
    for (std::size_t group = 0; group < groups(); ++group)
        if (is_inner[group] != 0) levels_[group] = Level::Inner;
}

/// Lists the legs of level groups, and which of them are useful after each other.
void PathGraph::set_level_legs()
{
    for (const Way way : {Way::Ahead, Way::Left})
        for (int heading = 0; heading < lattice_headings; ++heading) {
            const LatticeMove move = graph_->lattice.end(way, heading).move;
            level_legs_.push_back(
                {std::ptrdiff_t(move.rows) * graph_->grid.cols + move.cols, move, shape_of(way, heading)});
        }
    // The cheapest of all pairs of legs, and of them those with the last second leg.
    const auto cost_of = [&](std::size_t leg) { return level_costs_[level_legs_[leg].shape]; };
    const auto sum = [&](std::size_t leg, std::size_t next) { return level_legs_[leg].move + level_legs_[next].move; };
    useful_legs_.fill(all_directions);
    for (std::size_t a = 0; a < level_legs_.size(); ++a)
        for (std::size_t b = 0; b < level_legs_.size(); ++b) {
            const LatticeMove there = sum(a, b);
            const PathCost cost = cost_of(a) + cost_of(b);
            bool is_useful = there != LatticeMove{0, 0};
            for (std::size_t c = 0; c < level_legs_.size() && is_useful; ++c) {
                is_useful = level_legs_[c].move != there || cost_of(c) >= cost;
                for (std::size_t d = 0; d < level_legs_.size() && is_useful; ++d)
                    is_useful = sum(c, d) != there || cost_of(c) + cost_of(d) > cost ||
                                (cost_of(c) + cost_of(d) == cost && d <= b);
            }
            if (!is_useful) useful_legs_[a] &= ~(Directions(1) << b);
        }
}

PathGraph::RowOfLegs PathGraph::legs_of_row(int row) const
{
    const std::size_t begin = graph_->first[graph_->column_of(0, row)],
                      end = graph_->first[graph_->column_of(0, row) + std::size_t(graph_->grid.cols)];
    RowOfLegs out;
    std::array<std::vector<std::pair<Group, std::uint8_t>>, lattice_headings> legs;  // of each group of a place
    for (std::size_t place = begin; place < end; ++place) {
        if (levels_[first_group_[place]] != Level::None) {
            out.counts.push_back(0);
            continue;
        }
        for (int heading = 0; heading < lattice_headings; ++heading) {
            if (!has_heading(graph_->valid[place], heading)) continue;
            const StateId state = StateId(place) * lattice_headings + StateId(heading);
            auto& of_group = legs[group_of(state) - first_group_[place]];
            for (const Way way : ReachGraph::Impl::moving_ways)
                for_each_moving_neighbour(state, way, all_directions, [&](StateId other, std::uint8_t shape) {
                    of_group.emplace_back(group_of(other), shape);
                });
        }
        for (std::size_t k = 0; k < first_group_[place + 1] - first_group_[place]; ++k) {
            std::sort(legs[k].begin(), legs[k].end());
            legs[k].erase(std::unique(legs[k].begin(), legs[k].end()), legs[k].end());
            out.counts.push_back(std::uint32_t(legs[k].size()));
            for (const auto& [to, shape] : legs[k]) {
                out.ends.push_back(to);
                out.shapes.push_back(shape);
            }
            legs[k].clear();
        }
    }
    return out;
}

}  // namespace spawnfield

#include "reach/path_graph.h"

#include "base/parallel.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

Vec2 vector_of(const LatticeMove& move) { return {double(move.cols), double(move.rows)}; }

/// The shapes of all ways are among those that begin at the headings 0 to 2. They are counted as in shape_way().
std::uint8_t shape_of(Way way, int heading)
{
    if (is_curve(way)) {
        const int between = way == Way::Left ? heading : lattice_heading(heading, -1);  // this heading and the next one
        return between % 4 == 0 || between % 4 == 3 ? 3 : 4;
    }
    return std::uint8_t(heading % 4 == 3 ? 1 : heading % 4);
}

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
    std::vector<RowOfLegs> rows(std::size_t(graph_->grid.rows));
    parallel_for(rows.size(), graph_->options.threads, {}, [&](std::size_t row) { rows[row] = legs_of_row(int(row)); });
    first_leg_.reserve(groups() + 1);
    first_leg_.push_back(0);
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
    const bool turns = graph_->options.drive != Drive::Car;
    const double length = (turns ? open_length(cols, rows) : std::hypot(cols, rows)) * graph_->grid.step,
                 rise = end.ground - begin.ground;
    return PathCost((rise == 0 ? length : std::hypot(length, rise)) * (1 - rounding) / nanometre);
}

/// Calls visit(state, shape) for the state to which a way leads from a state, and for those from which it leads to it.
template <class Visit>
void PathGraph::for_each_moving_neighbour(StateId state, Way way, const Visit& visit) const
{
    const RasterGrid& grid = graph_->grid;
    const std::vector<ReachGraph::Impl::Ways>& ways = graph_->ways[std::size_t(way)];
    if (ways.empty()) return;
    const std::size_t place = state / lattice_headings;
    const Spot& spot = spot_of(state);
    const int heading = int(state % lattice_headings);
    if (const std::uint8_t index = ways[place][std::size_t(heading)]; index != ReachGraph::Impl::nowhere) {
        const WayEnd end = graph_->lattice.end(way, heading);
        const std::size_t other = graph_->first[graph_->column_of(spot.col + end.move.cols, spot.row + end.move.rows)] +
                                  index;
        visit(StateId(other) * lattice_headings + StateId(end.heading), shape_of(way, heading));
    }
    // Back: a curve to the left that ends at this heading began at the one before.
    const int begin = lattice_heading(heading, way == Way::Left ? -1 : way == Way::Right ? 1 : 0);
    const LatticeMove move = graph_->lattice.end(way, begin).move;
    const int from_col = spot.col - move.cols, from_row = spot.row - move.rows;
    if (from_col < 0 || from_row < 0 || from_col >= grid.cols || from_row >= grid.rows) return;
    const std::size_t here = place - graph_->first[graph_->column_of(spot.col, spot.row)],
                      column = graph_->column_of(from_col, from_row);
    for (std::size_t other = graph_->first[column]; other < graph_->first[column + 1]; ++other)
        if (ways[other][std::size_t(begin)] == here)
            visit(StateId(other) * lattice_headings + StateId(begin), shape_of(way, begin));
}

std::vector<PathGraph::Neighbour> PathGraph::neighbours(StateId state) const
{
    const std::size_t place = state / lattice_headings;
    const int heading = int(state % lattice_headings), before = lattice_heading(heading, -1);
    const std::vector<ReachGraph::Impl::Ways>& turns = graph_->ways[std::size_t(Way::Turn)];
    const StateId first = StateId(place) * lattice_headings;
    std::vector<Neighbour> out;
    if (turns[place][std::size_t(heading)] != ReachGraph::Impl::nowhere)
        out.push_back({first + StateId(lattice_heading(heading, 1)), 0});
    if (turns[place][std::size_t(before)] != ReachGraph::Impl::nowhere) out.push_back({first + StateId(before), 0});
    for (const Way way : ReachGraph::Impl::moving_ways)
        for_each_moving_neighbour(state, way, [&](StateId other, std::uint8_t shape) {
            out.push_back({other, leg_cost(spot_of(state), spot_of(other), shape)});
        });
    return out;
}

PathGraph::RowOfLegs PathGraph::legs_of_row(int row) const
{
    const std::size_t begin = graph_->first[graph_->column_of(0, row)],
                      end = graph_->first[graph_->column_of(0, row) + std::size_t(graph_->grid.cols)];
    RowOfLegs out;
    std::array<std::vector<std::pair<Group, std::uint8_t>>, lattice_headings> legs;  // of each group of a place
    for (std::size_t place = begin; place < end; ++place) {
        for (int heading = 0; heading < lattice_headings; ++heading) {
            if (!has_heading(graph_->valid[place], heading)) continue;
            const StateId state = StateId(place) * lattice_headings + StateId(heading);
            auto& of_group = legs[group_of(state) - first_group_[place]];
            for (const Way way : ReachGraph::Impl::moving_ways)
                for_each_moving_neighbour(state, way, [&](StateId other, std::uint8_t shape) {
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

#include "reach/graph_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace spawnfield {
namespace {

constexpr int block = 16;  // columns of a block along a row

}  // namespace

void GraphBuilder::StateRow::clear()
{
    first.clear();
    places.clear();
    left.clear();
}

GraphBuilder::GraphBuilder(ReachGraph::Impl& graph)
    : graph_(graph), keeps_ways_(graph.keep == ReachGraph::Impl::Keep::Ways),
      is_car_(graph.options.drive == Drive::Car), rows_(std::size_t(graph.grid.rows))
{
    for (const bool is_open : {true, false})
        for (const Way way : {Way::Ahead, Way::Turn, Way::Left, Way::Right, Way::Aside})
            if ((way != Way::Turn || !is_car_) && (way != Way::Aside || goes_aside(*graph.options.drive)))
                passes_.push_back({way, is_open});
}

DisjointSets GraphBuilder::run()
{
    const int threads = graph_.options.threads, rows = graph_.grid.rows, longest = graph_.lattice.longest_rows();
    const int band = std::max(block, 2 * longest);  // rows whose states are found before the ways between them
    // Most worlds have about one place per column. Memory that is only reserved costs nothing.
    const std::size_t columns = graph_.column_of(0, rows);
    graph_.first.reserve(columns + 1);
    graph_.ground.reserve(columns);
    graph_.valid.reserve(columns);
    graph_.first_node.reserve(columns + 1);
    nodes_.reserve(columns);
    graph_.first.assign(1, 0);
    graph_.first_node.assign(1, 0);
    int done = 0;  // rows whose ways are known
    for (int begin = 0; begin < rows; begin += band) {
        const int end = std::min(rows, begin + band), ready = end < rows ? end - longest : end;
        const auto report = [&](double share) {
            if (graph_.options.progress) graph_.options.progress((begin + share * (end - begin)) / rows);
        };
        find_blocks(begin, end, report);
        reuse_rows(begin, end);
        parallel_for(std::size_t(end - begin), threads, {},
                     [&](std::size_t k) { collect_states(begin + int(k), int(k)); });
        append_rows(begin, end);
        const auto for_rows = [&](int from, int to, auto&& visit) {
            parallel_for(std::size_t(to - from), threads, {}, [&](std::size_t k) { visit(from + int(k)); });
        };
        if (!is_car_ && !keeps_ways_) {
            for_rows(begin, end, [&](int row) { find_open_nodes(row); });
            for_rows(begin, end, [&](int row) { join_open(row); });
            for_rows(begin, end, [&](int row) { find_open_sets(row); });
        }
        for_rows(done, ready, [&](int row) { find_columns_left(row); });
        for (const Pass& pass : passes_) for_rows(done, ready, [&](int row) { join_row(row, pass); });
        done = ready;
        for (int row = std::max(0, begin - band - longest); row < done - longest; ++row)
            if (StateRow& old = rows_[std::size_t(row)]; !old.first.empty()) spare_.push_back(std::exchange(old, {}));
    }
    return std::move(nodes_);
}

std::span<const PlaceStates> GraphBuilder::places_at(int col, int row) const
{
    if (col < 0 || row < 0 || col >= graph_.grid.cols || row >= graph_.grid.rows) return {};
    const StateRow& states = rows_[std::size_t(row)];
    const std::uint32_t begin = states.first[std::size_t(col)];
    return std::span(states.places).subspan(begin, states.first[std::size_t(col) + 1] - begin);
}

std::size_t GraphBuilder::number_of(const PlaceAt& at) const
{
    return graph_.first[graph_.column_of(at.col, at.row)] + at.index;
}

/// Finds the places of some rows, in blocks of columns. So threads share the work evenly, also where one row has most
/// of it.
void GraphBuilder::find_blocks(int begin, int end, const Progress& report)
{
    std::swap(blocks_, blocks_before_);
    blocks_.resize(std::size_t((graph_.grid.cols + block - 1) / block));
    parallel_for(blocks_.size(), graph_.options.threads, report, [&](std::size_t b) {
        const int first = int(b) * block;
        blocks_[b] = block_at(first, std::min(first + block, graph_.grid.cols), begin, end);
    });
}

/// Returns the places of a rectangle of columns. Most of a wide level place needs only a look at all of it.
GraphBuilder::Block GraphBuilder::block_at(int first_col, int end_col, int begin, int end)
{
    WayJudge& judge = graph_.way_judges.local();
    Block out;
    out.same = judge.place_of_all(position(first_col, begin), position(end_col - 1, end - 1));
    for (int row = begin; row < end && !out.same; ++row) {
        out.first.push_back(out.places.size());
        for (int col = first_col; col < end_col; ++col) {
            const std::size_t before = out.places.size();
            judge.find_places(position(col, row), out.places, out.details);
            out.counts.push_back(std::uint32_t(out.places.size() - before));
        }
    }
    return out;
}

/// Gives new rows the memory of rows that are not needed any more.
void GraphBuilder::reuse_rows(int begin, int end)
{
    for (int row = begin; row < end && !spare_.empty(); ++row) {
        StateRow& states = rows_[std::size_t(row)] = std::move(spare_.back());
        spare_.pop_back();
        states.clear();
    }
}

/// Sets the places of a row, which is the one with this index in the blocks.
void GraphBuilder::collect_states(int row, int index)
{
    StateRow& out = rows_[std::size_t(row)];
    out.first.push_back(0);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const Block& states = blocks_[b];
        const int cols = std::min(block, graph_.grid.cols - int(b) * block);
        std::size_t next = states.same ? 0 : states.first[std::size_t(index)];
        for (int col = 0; col < cols; ++col) {
            const std::size_t count = states.same ? 1 : states.counts[std::size_t(index * cols + col)];
            const PlaceStates* const places = states.same ? &*states.same : states.places.data() + next;
            out.places.insert(out.places.end(), places, places + count);
            out.first.push_back(std::uint32_t(out.places.size()));
            next += count;
        }
    }
    out.nodes = 0;
    for (const PlaceStates& place : out.places) out.nodes += node_count(place);
}

/// Returns how many nodes a place has: one for all headings if it is open, because robots but cars turn on the spot.
std::uint32_t GraphBuilder::node_count(const PlaceStates& place) const
{
    return place.is_open && !is_car_ ? 1 : std::uint32_t(std::popcount(place.valid));
}

/// Appends the places of some rows to the graph.
void GraphBuilder::append_rows(int begin, int end)
{
    struct Offset {
        std::size_t column, place, node;
    };
    std::vector<Offset> offsets{{graph_.column_of(0, begin), graph_.ground.size(), graph_.first_node.back()}};
    for (int row = begin; row < end; ++row) {
        const StateRow& states = rows_[std::size_t(row)];
        const Offset& last = offsets.back();
        offsets.push_back(
            {last.column + std::size_t(graph_.grid.cols), last.place + states.places.size(), last.node + states.nodes});
    }
    const Offset& all = offsets.back();
    parallel_for(5, graph_.options.threads, {},
                 [&](std::size_t k) {  // new memory takes longer than what is written there
                     switch (k) {
                     case 0: return graph_.first.resize(all.column + 1);
                     case 1: return graph_.ground.resize(all.place);
                     case 2: return graph_.valid.resize(all.place);
                     case 3: return graph_.first_node.resize(all.place + 1);
                     default: return nodes_.grow(all.node);
                     }
                 });
    parallel_for(std::size_t(end - begin), graph_.options.threads, {}, [&](std::size_t k) {
        append(rows_[std::size_t(begin) + k], offsets[k].column, offsets[k].place, offsets[k].node);
    });
    if (!keeps_ways_) return;
    ReachGraph::Impl::Ways no_ways;
    no_ways.fill(ReachGraph::Impl::nowhere);
    for (const Pass& pass : passes_) graph_.ways[std::size_t(pass.way)].resize(all.place, no_ways);
    graph_.ways[std::size_t(Way::Turn)].resize(all.place, no_ways);
}

/// Writes the places of a row into the graph, from a column, a place and a node on.
void GraphBuilder::append(const StateRow& row, std::size_t column, std::size_t place, std::size_t node)
{
    for (std::size_t col = 1; col < row.first.size(); ++col)
        graph_.first[column + col] = std::uint32_t(place + row.first[col]);
    for (const PlaceStates& states : row.places) {
        graph_.ground[place] = states.ground;
        graph_.valid[place] = states.valid;
        node += node_count(states);
        graph_.first_node[++place] = std::uint32_t(node);
    }
}

void GraphBuilder::find_open_nodes(int row)
{
    StateRow& states = rows_[std::size_t(row)];
    const auto cols = std::size_t(graph_.grid.cols);
    states.open_sets.resize(cols);
    for (std::size_t col = 0; col < cols; ++col) {
        const std::span<const PlaceStates> places = places_at(int(col), row);
        states.open_sets[col] = places.size() == 1 && places[0].is_open ? node_of({int(col), row, 0}, 0) : none;
    }
}

/// Joins the open places of a row with their neighbours before them in the row and in the column. So most of the ways
/// of a wide level place need not be examined.
void GraphBuilder::join_open(int row)
{
    const WayJudge& judge = graph_.way_judges.local();
    const StateRow& states = rows_[std::size_t(row)];
    const auto join = [&](int col, const StateRow& others, int other_col) {
        const std::uint32_t node = states.open_sets[std::size_t(col)], other = others.open_sets[std::size_t(other_col)];
        if (node != none && other != none &&
            judge.are_level(states.places[states.first[std::size_t(col)]],
                            others.places[others.first[std::size_t(other_col)]]))
            nodes_.join(node, other);
    };
    for (int col = 1; col < graph_.grid.cols; ++col) join(col, states, col - 1);
    for (int col = 0; col < graph_.grid.cols && row > 0; ++col) join(col, rows_[std::size_t(row) - 1], col);
}

void GraphBuilder::find_open_sets(int row)
{
    StateRow& states = rows_[std::size_t(row)];
    std::vector<std::uint32_t>& sets = states.open_sets;
    states.run.resize(sets.size());
    for (std::size_t col = 0; col < sets.size(); ++col) {
        if (sets[col] != none) sets[col] = nodes_.find(sets[col]);
        states.run[col] = sets[col] == none ? 0 : col > 0 && sets[col - 1] == sets[col] ? states.run[col - 1] + 1 : 1;
    }
}

/// Finds the columns from which a way may lead to a node that is not joined: those with places, but not in the middle
/// of a square of open places that are joined. No way leads out of this square. Sets only grow, so two places that had
/// the same set at different times are joined.
void GraphBuilder::find_columns_left(int row)
{
    const int side = graph_.lattice.longest_rows(), cols = graph_.grid.cols;
    StateRow& states = rows_[std::size_t(row)];
    const bool has_sets = !is_car_ && !keeps_ways_ && row >= side && row + side < graph_.grid.rows;
    const auto is_joined = [&](int col) {
        if (!has_sets || col < side || col + side >= cols) return false;
        const auto last = std::size_t(col + side);
        const std::uint32_t set = states.open_sets[last];
        bool all_equal = set != none;
        for (int r = row - side; r <= row + side && all_equal; ++r) {
            const StateRow& other = rows_[std::size_t(r)];
            all_equal = other.open_sets[last] == set && other.run[last] > std::uint32_t(2 * side);
        }
        return all_equal;
    };
    for (int col = 0; col < cols; ++col)
        if (!places_at(col, row).empty() && !is_joined(col)) states.left.push_back(col);
}

void GraphBuilder::join_row(int row, const Pass& pass)
{
    WayJudge& judge = graph_.way_judges.local();
    for (const int col : rows_[std::size_t(row)].left)
        for (std::size_t k = 0; k < places_at(col, row).size(); ++k)
            for (int heading = 0; heading < lattice_headings; ++heading)
                if (const PlaceAt from{col, row, k}; has_heading(place(from).valid, heading))
                    examine(judge, from, heading, pass);
}

/// Joins a state and the one to which a way leads, if there is one.
void GraphBuilder::examine(WayJudge& judge, const PlaceAt& from, int heading, const Pass& pass)
{
    if (!keeps_ways_ && !may_join(judge, from, heading, pass.way)) return;
    const auto to = is_car_ && is_curve(pass.way) ? end_of_car_curve(judge, from, heading, pass)
                                                  : end_of_way(judge, from, heading, pass);
    if (!to || to->index >= ReachGraph::Impl::nowhere) return;
    nodes_.join(node_of(from, heading), node_of(*to, graph_.lattice.end(pass.way, heading).heading));
    if (keeps_ways_)
        graph_.ways[std::size_t(pass.way)][number_of(from)][std::size_t(heading)] = std::uint8_t(to->index);
}

/// Returns the place to which the robot can go on a way, if this pass is for it.
std::optional<GraphBuilder::PlaceAt> GraphBuilder::end_of_way(WayJudge& judge, const PlaceAt& from, int heading,
                                                              const Pass& pass) const
{
    const auto to = end_of_ground(judge, from, heading, pass.way);
    if (!to) return std::nullopt;
    const StateAt start = state_at(from, heading), goal = state_at(*to, graph_.lattice.end(pass.way, heading).heading);
    const bool is_open = judge.is_open(start, goal);
    return is_open == pass.is_open && (is_open || judge.can_go(start, goal, pass.way)) ? to : std::nullopt;
}

/// The same for a curve of a car.
std::optional<GraphBuilder::PlaceAt> GraphBuilder::end_of_car_curve(WayJudge& judge, const PlaceAt& from, int heading,
                                                                    const Pass& pass) const
{
    const WayEnd& end = graph_.lattice.end(pass.way, heading);
    const int col = from.col + end.move.cols, row = from.row + end.move.rows;
    const std::span<const PlaceStates> others = places_at(col, row);
    if (others.empty()) return std::nullopt;
    const StateAt start = state_at(from, heading);
    if (others.size() == 1 && judge.is_open(start, state_at({col, row, 0}, end.heading)))
        return pass.is_open && has_heading(others[0].valid, end.heading) ? std::optional(PlaceAt{col, row, 0})
                                                                         : std::nullopt;
    if (pass.is_open) return std::nullopt;
    const std::vector<RobotAtRest> stops = judge.follow(start, state_at({col, row, 0}, end.heading), pass.way,
                                                        judge.pieces_of_curve(pass.way, heading));
    for (std::size_t k = 0; k < others.size() && !stops.empty(); ++k)
        if (others[k].ground == stops.back().ground.z()) return PlaceAt{col, row, k};
    return std::nullopt;
}

/// Returns whether a way may lead to a state that is not joined with this one.
bool GraphBuilder::may_join(const WayJudge& judge, const PlaceAt& from, int heading, Way way)
{
    const WayEnd& end = graph_.lattice.end(way, heading);
    const std::uint32_t node = node_of(from, heading);
    const auto is_new = [&](const PlaceAt& to) {
        return has_heading(place(to).valid, end.heading) && !nodes_.are_joined(node, node_of(to, end.heading));
    };
    if (way == Way::Turn) return is_new(from);
    const int col = from.col + end.move.cols, row = from.row + end.move.rows;
    const double largest_rise = judge.largest_rise(way, heading);
    for (std::size_t k = 0; k < places_at(col, row).size(); ++k)
        if (const PlaceAt to{col, row, k};
            std::abs(place(to).ground - place(from).ground) <= largest_rise && is_new(to))
            return true;
    return false;
}

/// Returns the place to which the ground leads on a way, at whose end the robot stands there. In a curve, the robot
/// must also stand where the straight ways of both headings meet.
std::optional<GraphBuilder::PlaceAt> GraphBuilder::end_of_ground(WayJudge& judge, const PlaceAt& from, int heading,
                                                                 Way way) const
{
    const WayEnd& end = graph_.lattice.end(way, heading);
    if (way == Way::Turn) return has_heading(place(from).valid, end.heading) ? std::optional(from) : std::nullopt;
    const auto next = [&](const PlaceAt& start, int direction, int at_heading) -> std::optional<PlaceAt> {
        const LatticeMove move = lattice_move(direction);
        const int col = start.col + move.cols, row = start.row + move.rows;
        const std::span<const PlaceStates> others = places_at(col, row);
        if (others.empty()) return std::nullopt;
        const auto k = judge.place_ahead(position(start.col, start.row), place(start), position(col, row), others,
                                         direction, at_heading);
        return k ? std::optional(PlaceAt{col, row, *k}) : std::nullopt;
    };
    if (heading == end.heading) return next(from, way == Way::Aside ? to_the_left(heading) : heading, heading);
    if (places_at(from.col + end.move.cols, from.row + end.move.rows).empty()) return std::nullopt;
    for (const int at_middle : {heading, end.heading})
        if (const auto middle = next(from, heading, at_middle))
            if (const auto out = next(*middle, end.heading, end.heading)) return out;
    return std::nullopt;
}

}  // namespace spawnfield

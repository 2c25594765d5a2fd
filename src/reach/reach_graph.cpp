#include "reach/reach_graph.h"

#include "base/parallel.h"
#include "base/polygon2.h"
#include "reach/way_judge.h"
#include "settle/convex.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace spawnfield {
namespace {

constexpr int band = 16;  // rows whose states are found before the edges between them
constexpr int quarter_turn = lattice_headings / 4;

/// Returns the length of the longest way, in steps of the grid.
double longest_way()
{
    double out = 0;
    for (int heading = 0; heading < lattice_headings; ++heading)
        out = std::max(out, way_end(Way::Left, heading).move.length());
    return out;
}

/// Finds the states and edges of a graph, some rows at a time. Only these rows have their poses in memory.
class GraphBuilder {
public:
    explicit GraphBuilder(ReachGraph::Impl& graph)
        : graph_(graph), grid_(graph.grid), states_(std::size_t(grid_.rows)), edges_(std::size_t(grid_.rows))
    {
    }

    void run()
    {
        const ReachOptions& options = graph_.options;
        graph_.first.assign(1, 0);
        int done = 0;  // rows with edges
        for (int begin = 0; begin < grid_.rows; begin += band) {
            const int end = std::min(grid_.rows, begin + band), ready = end < grid_.rows ? end - longest_way_rows : end;
            const auto report = [&](double share) {
                if (options.progress) options.progress((begin + share * (end - begin)) / grid_.rows);
            };
            parallel_for(std::size_t(end - begin), options.threads, report,
                         [&](std::size_t k) { find_states(begin + int(k)); });
            parallel_for(std::size_t(ready - done), options.threads, {},
                         [&](std::size_t k) { find_edges(done + int(k)); });
            for (; done < ready; ++done) append(done);
            for (int row = std::max(0, begin - band - longest_way_rows); row < done - longest_way_rows; ++row)
                states_[std::size_t(row)] = {};
        }
    }

private:
    struct StateRow {
        std::vector<std::uint32_t> first;  ///< first place of each column; then their number
        std::vector<PlaceStates> places;

        std::span<const PlaceStates> at(int col) const
        {
            const std::uint32_t begin = first[std::size_t(col)];
            return std::span(places).subspan(begin, first[std::size_t(col) + 1] - begin);
        }
    };
    /// The edges that begin at the places of a row.
    struct EdgeRow {
        std::vector<HeadingSet> turns;
        std::array<std::vector<ReachGraph::Impl::Ways>, way_count> ways;
    };

    Vec2 at(int col, int row) const { return {grid_.x_of(col), grid_.y_of(row)}; }

    void find_states(int row)
    {
        StateRow& out = states_[std::size_t(row)];
        for (int col = 0; col < grid_.cols; ++col) {
            out.first.push_back(std::uint32_t(out.places.size()));
            graph_.way_judges.local().find_places(at(col, row), out.places);
        }
        out.first.push_back(std::uint32_t(out.places.size()));
    }

    void find_edges(int row)
    {
        WayJudge& judge = graph_.way_judges.local();
        EdgeRow& out = edges_[std::size_t(row)];
        for (int col = 0; col < grid_.cols; ++col) {
            const std::span<const PlaceStates> places = states_[std::size_t(row)].at(col);
            const auto is_open = [](const PlaceStates& place) { return place.is_open; };
            if (!std::all_of(places.begin(), places.end(), is_open)) judge.set_start(at(col, row));
            for (const PlaceStates& place : places) {
                out.turns.push_back(turns_at(judge, place, at(col, row)));
                for (const Way way : ReachGraph::Impl::moving_ways)
                    if (way != Way::Aside || graph_.options.drive == Drive::Omni)
                        out.ways[std::size_t(way)].push_back(ways_from(judge, place, col, row, way));
            }
        }
    }

    /// Returns from which headings the robot can turn to the next one.
    static HeadingSet turns_at(WayJudge& judge, const PlaceStates& place, const Vec2& at)
    {
        HeadingSet out = 0;
        for (int heading = 0; heading < lattice_headings; ++heading) {
            const int next = way_end(Way::Turn, heading).heading;
            if (has_heading(place.valid, heading) && has_heading(place.valid, next) &&
                judge.can_go({at, place, heading}, {at, place, next}, Way::Turn))
                out |= HeadingSet(1u << heading);
        }
        return out;
    }

    /// Returns the ways from the headings of a place.
    ReachGraph::Impl::Ways ways_from(WayJudge& judge, const PlaceStates& place, int col, int row, Way way) const
    {
        ReachGraph::Impl::Ways out;
        out.fill(ReachGraph::Impl::nowhere);
        for (int heading = 0; heading < lattice_headings; ++heading) {
            const WayEnd end = way_end(way, heading);
            const int to_col = col + end.move.cols, to_row = row + end.move.rows;
            if (!has_heading(place.valid, heading) || to_col < 0 || to_col >= grid_.cols || to_row < 0 ||
                to_row >= grid_.rows)
                continue;
            const auto target = target_of(judge, place, col, row, way, heading);
            if (target && *target < ReachGraph::Impl::nowhere &&
                judge.can_go({at(col, row), place, heading},
                             {at(to_col, to_row), states_[std::size_t(to_row)].at(to_col)[*target], end.heading}, way))
                out[std::size_t(heading)] = std::uint8_t(*target);
        }
        return out;
    }

    /// Returns the index of the place in the column at the end of a way to which the ground leads. In a curve, the
    /// robot must also stand where the straight ways of both headings meet.
    std::optional<std::size_t> target_of(WayJudge& judge, const PlaceStates& place, int col, int row, Way way,
                                         int heading) const
    {
        const WayEnd end = way_end(way, heading);
        const int to_col = col + end.move.cols, to_row = row + end.move.rows;
        const std::span<const PlaceStates> others = states_[std::size_t(to_row)].at(to_col);
        if (others.empty()) return std::nullopt;
        if (heading == end.heading) return judge.place_after(at(col, row), place, at(to_col, to_row), others, heading);
        const LatticeMove half = lattice_move(heading);
        const int mid_col = col + half.cols, mid_row = row + half.rows;
        const std::span<const PlaceStates> middle = states_[std::size_t(mid_row)].at(mid_col);
        for (const int at_middle : {heading, end.heading})
            if (const auto k = judge.place_after(at(col, row), place, at(mid_col, mid_row), middle, at_middle))
                if (const auto out = judge.place_after(at(mid_col, mid_row), middle[*k], at(to_col, to_row), others,
                                                       end.heading))
                    return out;
        return std::nullopt;
    }

    void append(int row)
    {
        const StateRow& states = states_[std::size_t(row)];
        EdgeRow& edges = edges_[std::size_t(row)];
        const std::uint32_t before = std::uint32_t(graph_.ground.size());
        for (int col = 0; col < grid_.cols; ++col) graph_.first.push_back(before + states.first[std::size_t(col) + 1]);
        for (const PlaceStates& place : states.places) {
            graph_.ground.push_back(place.ground);
            graph_.valid.push_back(place.valid);
        }
        graph_.turns.insert(graph_.turns.end(), edges.turns.begin(), edges.turns.end());
        for (std::size_t way = 0; way < way_count; ++way)
            graph_.ways[way].insert(graph_.ways[way].end(), edges.ways[way].begin(), edges.ways[way].end());
        edges = {};
    }

    ReachGraph::Impl& graph_;
    const RasterGrid& grid_;
    std::vector<StateRow> states_;
    std::vector<EdgeRow> edges_;
};

}  // namespace

double auto_reach_step(const Robot& robot)
{
    Polygon2 outline;
    for (const RobotPart& part : robot.parts) {
        const Convex body = convex_of(part);
        constexpr int directions = 64;  // around round parts
        for (int k = 0; k < directions; ++k) {
            const double angle = 2 * std::numbers::pi * k / directions;
            outline.push_back(body.support({std::cos(angle), std::sin(angle), 0}).head<2>());
        }
    }
    return width(convex_hull(std::move(outline))) / 4;
}

ReachGraph::Impl::Impl(const Judge& judge_, const ReachOptions& options_)
    : judge(judge_), options(options_),
      way_judges([this] { return WayJudge(judge.impl(), options.max_step, longest_way() * grid.step); })
{
    judge.impl().settler();  // throws if the obstacles are voxels
    if (!options.step) options.step = auto_reach_step(judge.robot());
    if (!(*options.step > 0) || !std::isfinite(*options.step))
        throw ArgumentError("ReachGraph", "step", *options.step, "> 0 m");
    if (!(options.max_step >= 0) || !std::isfinite(options.max_step))
        throw ArgumentError("ReachGraph", "max_step", options.max_step, ">= 0 m");
    grid = raster_grid(judge.map().bounds, {.step = *options.step});
    GraphBuilder(*this).run();
    find_islands();
}

ReachGraph::ReachGraph(const Judge& judge, const ReachOptions& options)
    : impl_(std::make_shared<const Impl>(judge, options))
{
}

const ReachOptions& ReachGraph::options() const { return impl_->options; }

std::span<const Island> ReachGraph::islands() const { return impl_->islands; }

std::vector<ReachPlace> ReachGraph::places() const
{
    std::vector<ReachPlace> out;
    out.reserve(impl_->ground.size());
    impl_->for_each_place([&](std::size_t p, double x, double y) {
        const auto runs =
            std::span(impl_->run_islands).subspan(impl_->first_run[p], impl_->first_run[p + 1] - impl_->first_run[p]);
        out.push_back({x, y, impl_->ground[p], *std::min_element(runs.begin(), runs.end())});
    });
    return out;
}

std::optional<std::size_t> ReachGraph::island_of(const SettledPose& pose) const { return impl_->island_of(pose); }

}  // namespace spawnfield

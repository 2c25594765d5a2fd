#pragma once

#include "query/raster_grid.h"
#include "reach/disjoint_sets.h"
#include "reach/lattice.h"
#include "reach/way_judge.h"

#include <spawnfield/reach.h>

#include <array>
#include <vector>

namespace spawnfield {

/// The states and edges of a drivable graph. A place is a layer of a column at which the robot stands at one heading or
/// more.
struct ReachGraph::Impl {
    static constexpr std::uint8_t nowhere = 255;
    /// The ways between different columns.
    static constexpr std::array moving_ways{Way::Ahead, Way::Left, Way::Right, Way::Aside};
    /// For each heading, the index of the place in its column to which a way leads, from the top; `nowhere`: there is
    /// no way.
    using Ways = std::array<std::uint8_t, lattice_headings>;

    Judge judge;
    ReachOptions options;  ///< with all values
    RasterGrid grid;
    std::vector<std::uint32_t> first;  ///< first place of each column, row by row; then their number
    std::vector<double> ground;        ///< height of each place, m
    std::vector<HeadingSet> valid;     ///< at which the robot stands
    std::vector<HeadingSet> turns;     ///< from which it can turn to the next one
    /// The ways of each place by Way; empty for those that the drive does not have. Not for Way::Turn.
    std::array<std::vector<Ways>, way_count> ways;
    std::vector<std::uint32_t> first_run;    ///< of each place, then their number
    std::vector<std::uint32_t> run_islands;  ///< the island of each run: headings of a place that turns connect
    std::vector<Island> islands;

    Impl(const Judge& judge_, const ReachOptions& options_);

    std::size_t column_of(int col, int row) const
    {
        return std::size_t(row) * std::size_t(grid.cols) + std::size_t(col);
    }
    std::optional<std::size_t> island_of(const SettledPose& pose) const;
    /// Returns the number of the run that contains a valid heading of a place.
    std::size_t run_of(std::size_t place, int heading) const;

    /// Calls visit(place, x, y) for each place, in their order.
    template <class Visit>
    void for_each_place(const Visit& visit) const
    {
        std::size_t p = 0;
        for (int row = 0; row < grid.rows; ++row)
            for (int col = 0; col < grid.cols; ++col)
                for (; p < first[column_of(col, row) + 1]; ++p) visit(p, grid.x_of(col), grid.y_of(row));
    }

    mutable PerThread<WayJudge> way_judges;  ///< for poses that are not states

private:
    std::optional<std::size_t> island_at(const SettledPose& pose, int col, int row, int heading) const;
    DisjointSets joined_runs() const;
    void find_islands();
    void set_places();
};

/// Returns how many runs a place has with these valid headings and turns.
int count_runs(HeadingSet valid, HeadingSet turns);

}  // namespace spawnfield

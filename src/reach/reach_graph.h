#pragma once

#include "query/raster_grid.h"
#include "reach/disjoint_sets.h"
#include "reach/lattice.h"
#include "reach/way_judge.h"

#include <spawnfield/reach.h>

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// Returns whether a robot has ways straight to the side.
bool goes_aside(Drive drive);

/// The states of a drivable graph and its islands, and its ways if they are wanted. A place is a layer of a column at
/// which the robot stands at one heading or more. A node is a state, or all 16 states of an open place.
struct ReachGraph::Impl {
    static constexpr std::uint8_t nowhere = 255;
    /// The ways between different columns.
    static constexpr std::array moving_ways{Way::Ahead, Way::Left, Way::Right, Way::Aside};
    /// For each heading, the index of the place in its column to which a way leads, from the top; `nowhere`: there is
    /// no way. Way::Turn leads to the place itself.
    using Ways = std::array<std::uint8_t, lattice_headings>;
    /// What is kept. Islands need only a small part of all ways: those that join two parts of an island first.
    enum class Keep { Islands, Ways };

    Judge judge;
    ReachOptions options;  ///< with all values
    Lattice lattice;
    const Keep keep;
    RasterGrid grid;
    std::vector<std::uint32_t> first;       ///< first place of each column, row by row; then their number
    std::vector<double> ground;             ///< height of each place, m
    std::vector<HeadingSet> valid;          ///< at which the robot stands
    std::vector<std::uint32_t> first_node;  ///< of each place, then their number
    std::vector<std::uint32_t> node_islands;
    std::vector<Island> islands;
    std::array<std::vector<Ways>, way_count> ways;  ///< by Way, of each place; empty unless they are kept

    Impl(const Judge& judge_, const ReachOptions& options_, Keep keep_ = Keep::Islands);
    /// Takes everything from bytes() of a graph that keeps the same. Throws std::exception if the values do not fit the
    /// grid, or each other.
    Impl(const Judge& judge_, const ReachOptions& options_, Keep keep_, std::string_view bytes);

    /// Returns the places, nodes and islands as bytes, and the ways if they are kept.
    std::string bytes() const;

    std::size_t column_of(int col, int row) const
    {
        return std::size_t(row) * std::size_t(grid.cols) + std::size_t(col);
    }
    std::optional<std::size_t> island_of(const SettledPose& pose) const;
    struct State {
        std::size_t place;
        int heading;
    };
    /// Returns the state with which a valid settled pose is joined; see ReachGraph::island_of.
    std::optional<State> state_of(const SettledPose& pose) const;
    /// Returns the number of a state's node; its place is valid at this heading.
    std::uint32_t node_of(std::size_t place, int heading) const
    {
        const std::uint32_t node = first_node[place];
        if (first_node[place + 1] == node + 1) return node;
        return node + std::uint32_t(std::popcount(HeadingSet(valid[place] & ((1u << heading) - 1))));
    }

    /// Returns whether there is nothing but level ground around a place, as far as any way leads: only then, 16 states
    /// are one node.
    bool is_open(std::size_t place) const
    {
        constexpr auto all = HeadingSet(~0u);
        return valid[place] == all && first_node[place + 1] == first_node[place] + 1;
    }

    /// Calls visit(place, col, row) for each place, in their order.
    template <class Visit>
    void for_each_place(const Visit& visit) const
    {
        for_each_place(0, grid.rows, visit);
    }
    /// The same for the rows begin .. end - 1.
    template <class Visit>
    void for_each_place(int begin, int end, const Visit& visit) const
    {
        std::size_t p = first[column_of(0, begin)];
        for (int row = begin; row < end; ++row)
            for (int col = 0; col < grid.cols; ++col)
                for (; p < first[column_of(col, row) + 1]; ++p) visit(p, col, row);
    }

    /// Calls visit(island) once for each island on which the robot stands at a place at one heading or more.
    template <class Visit>
    void for_each_island(std::size_t place, const Visit& visit) const
    {
        const auto begin = node_islands.begin() + first_node[place], end = node_islands.begin() + first_node[place + 1];
        for (auto node = begin; node != end; ++node)
            if (std::find(begin, node, *node) == node) visit(*node);
    }

    mutable PerThread<WayJudge> way_judges;  ///< for poses that are not states

private:
    struct Empty {};
    Impl(const Judge& judge_, const ReachOptions& options_, Keep keep_, Empty);  ///< makes a graph without places
    std::optional<std::size_t> place_near(const SettledPose& pose, int col, int row, int heading) const;
    void find_islands(DisjointSets& nodes);
    std::vector<std::uint32_t> find_roots(DisjointSets& nodes);
    std::vector<std::uint32_t> number_sets(const std::vector<std::uint32_t>& roots);
    template <class OfThreads, class Visit>
    void visit_islands(OfThreads& of_threads, const Visit& visit) const;
    std::vector<Vec2> set_heights();
    void set_places(std::span<const Vec2> middles);
    bool is_consistent() const;
    bool are_ways_inside() const;
    bool are_ways_inside(int col, int row) const;
};

}  // namespace spawnfield

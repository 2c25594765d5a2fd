#pragma once

#include "reach/disjoint_sets.h"
#include "reach/reach_graph.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace spawnfield {

/// Finds the states of a graph, and joins those between which there is a way, some rows at a time. Only these rows have
/// their poses in memory.
///
/// The islands are the same in whatever order ways are examined. So those that need no work come first, and a way
/// between states that are already joined is not examined, unless all ways are kept.
class GraphBuilder {
public:
    /// `graph` must have its grid and its options.
    explicit GraphBuilder(ReachGraph::Impl& graph);

    /// Sets all of the graph except its islands, and returns which nodes are joined.
    DisjointSets run();

private:
    /// The places of some columns next to each other, of the rows that are examined together.
    struct Block {
        std::optional<PlaceStates> same;  ///< the only place of each column, if all have the same open one
        /// Otherwise: how many places each column has, row by row, these places, the first one of each row, and
        /// details.
        std::vector<std::uint32_t> counts;
        std::vector<PlaceStates> places;
        std::vector<std::size_t> first;
        DetailsStore details;
    };
    /// The places of a row.
    struct StateRow {
        std::vector<std::uint32_t> first;  ///< first place of each column; then their number
        std::vector<PlaceStates> places;
        std::size_t nodes = 0;  ///< of the places
        /// For each column whose only place is open, its node, later a number of the set of this node; else `none`.
        std::vector<std::uint32_t> open_sets;
        std::vector<std::uint32_t> run;  ///< how many columns up to this one have the same open set
        std::vector<int> left;  ///< columns with a place from which a way may lead to a node that is not joined

        void clear();
    };
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    /// A column, and one of its places.
    struct PlaceAt {
        int col, row;
        std::size_t index;  ///< in the column
    };
    /// Which ways are examined together.
    struct Pass {
        Way way;
        bool is_open;  ///< only those for which can_go() needs no work
    };

    std::span<const PlaceStates> places_at(int col, int row) const;
    const PlaceStates& place(const PlaceAt& at) const { return places_at(at.col, at.row)[at.index]; }
    /// Returns the number of a place in the graph.
    std::size_t number_of(const PlaceAt& at) const;
    std::uint32_t node_of(const PlaceAt& at, int heading) const { return graph_.node_of(number_of(at), heading); }
    Vec2 position(int col, int row) const { return {graph_.grid.x_of(col), graph_.grid.y_of(row)}; }

    void find_blocks(int begin, int end, const Progress& report);
    Block block_at(int first_col, int end_col, int begin, int end);
    void reuse_rows(int begin, int end);
    void collect_states(int row, int index);
    void append_rows(int begin, int end);
    void append(const StateRow& row, std::size_t column, std::size_t place, std::size_t node);
    std::uint32_t node_count(const PlaceStates& place) const;
    void find_open_nodes(int row);
    void join_open(int row);
    void find_open_sets(int row);
    void find_columns_left(int row);
    void join_row(int row, const Pass& pass);
    void examine(WayJudge& judge, const PlaceAt& from, int heading, const Pass& pass);
    bool may_join(const WayJudge& judge, const PlaceAt& from, int heading, Way way);
    StateAt state_at(const PlaceAt& at, int heading) const { return {position(at.col, at.row), place(at), heading}; }
    std::optional<PlaceAt> end_of_ground(WayJudge& judge, const PlaceAt& from, int heading, Way way) const;
    std::optional<PlaceAt> end_of_way(WayJudge& judge, const PlaceAt& from, int heading, const Pass& pass) const;
    std::optional<PlaceAt> end_of_car_curve(WayJudge& judge, const PlaceAt& from, int heading, const Pass& pass) const;

    ReachGraph::Impl& graph_;
    const bool keeps_ways_, is_car_;
    std::vector<Pass> passes_;
    std::vector<StateRow> rows_;
    std::vector<StateRow> spare_;       ///< rows that are not needed any more; others use their memory
    std::vector<Block> blocks_;         ///< of the rows that are examined
    std::vector<Block> blocks_before_;  ///< of the rows before them, which have their details there
    DisjointSets nodes_;
};

}  // namespace spawnfield

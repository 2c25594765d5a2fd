#pragma once

#include <spawnfield/reach.h>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace spawnfield {

/// A shortest path on a ReachGraph.
struct Path {
    /// The start, the states of the graph on the path, and the goal. All are valid settled poses, not raised. Between
    /// two neighbouring poses, the robot goes along one of the ways of ReachGraph.
    std::vector<SettledPose> poses;
    double length = 0;  ///< m
};

/// Finds shortest paths on a graph whose ways are kept (ReachOptions::keep_ways). For one thread: each thread needs its
/// own object. It uses about 200 bytes for each place of the graph.
///
/// The length of a way is measured on the ground: sqrt(d^2 + r^2), where d is the length of its course seen from above,
/// and r the difference between the heights of the ground at its ends. A turn on the spot has the length 0. A pose that
/// is not on the grid of the graph is joined with the state that ReachGraph::island_of() finds for it, by a straight
/// way whose length is the distance between both grounds. The lengths of ways are rounded up to nanometres. Of paths
/// with the same length, one with the fewest turns on the spot is found. Paths are at most 100 km long.
///
/// A path consists of ways of the graph, which has 16 headings. It is a shortest path of this graph, but a robot that
/// drives at any heading may have a shorter one: where nothing is in the way, straight lines are up to 2.8 % shorter.
class SPAWNFIELD_API PathSearch {
public:
    /// Throws ArgumentError if the graph does not keep its ways.
    explicit PathSearch(const ReachGraph& graph);
    PathSearch(PathSearch&&) noexcept;
    ~PathSearch();

    /// Returns the length of the shortest path between two settled poses, m. Returns nothing if one of them is not
    /// valid or on no island, if they are on different islands, or if the path is longer than `longest` (m).
    std::optional<double> length(const SettledPose& start, const SettledPose& goal,
                                 double longest = std::numeric_limits<double>::infinity());

    /// Returns the same path with its poses. Throws FileError for a damaged map.
    std::optional<Path> path(const SettledPose& start, const SettledPose& goal,
                             double longest = std::numeric_limits<double>::infinity());

    class Impl;

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace spawnfield

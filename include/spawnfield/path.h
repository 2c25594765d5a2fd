#pragma once

#include <spawnfield/reach.h>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace spawnfield {

/// A path that a robot can drive.
struct Path {
    /// The start, poses on the path, and the goal. All are valid settled poses, not raised. Between two neighbouring
    /// poses, the robot goes along one of the ways of ReachGraph, or it goes straight ahead or turns on the spot by the
    /// same rules.
    std::vector<SettledPose> poses;
    double length = 0;  ///< m
};

/// Finds short paths on a graph whose ways are kept (ReachOptions::keep_ways). For one thread: each thread needs its
/// own object. It uses about 200 bytes for each place of the graph.
///
/// First, a shortest path of the graph is found. The length of a way is measured on the ground: sqrt(d^2 + r^2), where
/// d is the length of its course seen from above, and r the difference between the heights of the ground at its ends. A
/// turn on the spot has the length 0. A pose that is not on the grid of the graph is joined with the state that
/// ReachGraph::island_of() finds for it, by a straight way whose length is the distance between both grounds. Of paths
/// with the same length, one with the fewest turns on the spot is found. Paths are at most 100 km long.
///
/// Paths of the graph have only 16 headings, so in the open they are up to 2 % too long. Therefore, the path is
/// shortened by straight ways at any heading, on which the robot turns on the spot first, and at the end. These ways
/// comply with the rules of the graph's ways in pieces of at most a reach step; the length of a piece is the distance
/// between the grounds at its ends. Corners are pulled tight. The result is a path that the robot can drive, in most
/// cases hardly longer than the shortest one; it is not proven that there is no shorter one. The path back may differ.
class SPAWNFIELD_API PathSearch {
public:
    /// Throws ArgumentError if the graph does not keep its ways.
    explicit PathSearch(const ReachGraph& graph);
    PathSearch(PathSearch&&) noexcept;
    ~PathSearch();

    /// Returns a path between two settled poses. Returns nothing if one of them is not valid or on no island, if they
    /// are on different islands, or if the path is longer than `longest` (m). Also if the shortest path of the graph is
    /// more than 3 % longer than `longest`. Throws FileError for a damaged map.
    std::optional<Path> path(const SettledPose& start, const SettledPose& goal,
                             double longest = std::numeric_limits<double>::infinity());

    class Impl;

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace spawnfield

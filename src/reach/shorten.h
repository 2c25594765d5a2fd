#pragma once

#include "reach/straight_ways.h"

#include <span>
#include <vector>

namespace spawnfield {

/// A path with its stops, at most a reach step apart.
struct ShortPath {
    std::vector<Stop> stops;
    double length = 0;  ///< m
};

/// Returns the length of straight ways between stops on the ground, m.
double length_between(std::span<const Stop> stops);

/// Shortens a path by straight ways. `lengths`: of the ways between the stops, m.
///
/// From the start on, the robot goes straight to a stop as far along the path as it can, then from there on, and so on:
/// after the next one, the stop twice as far away is tried until one cannot be reached or is not nearer on the straight
/// way; then, stops between the last two are tried by bisection. After that, corners between two straight ways are cut
/// by a third one, as deep as possible, three times.
ShortPath shortened(const ReachGraph::Impl& graph, const std::vector<Stop>& stops, const std::vector<double>& lengths);

}  // namespace spawnfield

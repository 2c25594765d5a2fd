#pragma once

#include <spawnfield/query.h>
#include <spawnfield/reach.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spawnfield {

/// A place from which a robot starts.
struct StartPlace {
    double x = 0, y = 0;  ///< m
    /// The robot is let down onto the ground at or below this height, m. No value: onto each layer at (x, y).
    std::optional<double> z = {};
};

/// Returns the place as in --island: "1.5,-2" or "1.5,-2,0.8".
SPAWNFIELD_API std::string to_string(const StartPlace& place);

/// Selects islands of a ReachGraph. An island must fulfil all conditions that are given; without any, all are selected.
struct IslandChoice {
    bool largest = false;                         ///< only the largest island
    std::optional<std::size_t> number = {};       ///< only this one: an index in ReachGraph::islands()
    std::optional<StartPlace> at = {};            ///< only those on which the robot stands at this place
    double min_area = 0;                          ///< only those of at least this area, m2, >= 0
    std::vector<StartPlace> reachable_from = {};  ///< only those on which it stands at one of these places or more

    bool selects_all() const { return !largest && !number && !at && !(min_area > 0) && reachable_from.empty(); }
};

/// Returns the numbers of the selected islands, ascending; there may be none.
///
/// At a place, the robot is let down at the 16 headings of the graph. The islands of all valid poses count; in a narrow
/// corridor, there may be two. The judge must be that of the graph.
///
/// Throws ArgumentError for a number of an island that does not exist, for an area that is not a number >= 0, and for a
/// place at which the robot can stand at none of the headings, or from which it can go nowhere. A place without z also
/// needs one layer only on which the robot can stand, or the same islands on all of them: otherwise, the error lists
/// the heights. Throws FileError for a damaged map.
SPAWNFIELD_API std::vector<std::size_t> chosen_islands(const ReachGraph& graph, const Judge& judge,
                                                       const IslandChoice& choice);

/// Returns a filter that accepts the poses whose ReachGraph::island_of() is one of these numbers. It shares the graph.
SPAWNFIELD_API ReachFilter on_islands(const ReachGraph& graph, std::span<const std::size_t> islands);

}  // namespace spawnfield

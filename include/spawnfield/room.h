#pragma once

#include <spawnfield/export.h>
#include <spawnfield/place_quantities.h>
#include <spawnfield/reach.h>

namespace spawnfield {

/// Returns a function that measures the room to manoeuvre: the area that the robot reaches on paths of the graph of at
/// most `range` (m), from the state with which the robot is joined (ReachGraph::island_of). The area, m2, is the number
/// of places that it reaches at some heading, its own included, multiplied by step * step. 0 for a robot on no island.
///
/// The lengths of paths are those of PathSearch: a turn on the spot has none. Paths are not shortened. The function
/// takes poses as they are written: it lets the robot down at each of them again. Several threads may call it at the
/// same time. It keeps what it finds: 8 bytes for each group of states between which the robot can turn on the spot. A
/// search takes O(reached places). Throws ArgumentError unless the graph keeps its ways (ReachOptions::keep_ways), and
/// for a range that is not > 0 or above PlaceMeasures::most_room_range.
SPAWNFIELD_API RoomMeter room_on(const ReachGraph& graph, double range);

}  // namespace spawnfield

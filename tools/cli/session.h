#pragma once

#include "query_args.h"
#include "summary.h"

#include <spawnfield/poses.h>

#include <memory>

namespace spawnfield::cli {

/// A map and a robot, ready for queries.
struct Session {
    Map map;
    Robot robot;
    std::unique_ptr<CollisionChecker> checker;  ///< nothing if the command was given no robot
};

/// Reads the map and the robot, and puts the map's hash into the summary. Without --robot, in commands that allow this,
/// reads only the map. The result stays at its address, because the checker refers into it.
std::unique_ptr<Session> open_session(const QueryArgs& args, Summary& summary);

/// Reads poses from a CSV file, or from standard input if it is `-`. Prints the file's notices.
PoseTable open_poses(const CommonArgs& args, const std::string& file);

/// Print a notice if the answer is known without a query: the region lies off the map, or no column has that layer.
void notice_if_off_map(const CommonArgs& args, const Map& map, const std::string& option, const Bounds& bounds);
void notice_if_no_layer(const CommonArgs& args, const Map& map, const LayerChoice& layers);

}  // namespace spawnfield::cli

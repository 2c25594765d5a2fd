#pragma once

#include <spawnfield/reach.h>

#include <filesystem>
#include <string>

namespace spawnfield {

/// A drivable graph that is kept in the folder of its map.
struct KeptGraph {
    ReachGraph graph;
    bool is_read = false;     ///< it was read from its file; false: it was built
    std::string notice = {};  ///< why the file could not be used or written, with what to do; empty: nothing is wrong
};

/// Returns ReachGraph(judge, options). If the folder of the judge's map has a file with this graph, it is read.
/// Otherwise, the graph is built, and then written to that file. A damaged file is replaced. Files are for one map, one
/// robot, and all limits and options on which the graph depends. If JudgeOptions::exhaustive or ReachOptions::keep_ways
/// is set, or if the map has no folder, graphs are not kept. Throws what the constructor of ReachGraph throws.
SPAWNFIELD_API KeptGraph kept_graph(const Judge& judge, const ReachOptions& options = {});

/// Returns the file in which kept_graph() keeps a graph, "reach-<hash of the map>-<hash of all else>.bin" in the folder
/// of the map. Empty if the graph is not kept.
SPAWNFIELD_API std::filesystem::path kept_graph_file(const Judge& judge, const ReachOptions& options = {});

}  // namespace spawnfield

#pragma once

#include "session.h"

#include <spawnfield/heatmap.h>
#include <spawnfield/types.h>

#include <memory>

namespace spawnfield::cli {

/// Options of `heatmap` on what it draws over the ground: files.
struct HeatmapMarkArgs {
    std::string spawns, fleet, pairs, paths;
    bool names = false;
};

/// Adds --spawns, --fleet, --pairs and --paths.
void add_heatmap_marks(CLI::App& command, HeatmapMarkArgs& args);
/// Adds --names.
void add_heatmap_names(CLI::App& command, HeatmapMarkArgs& args);

/// The robots of the kinds of a fleet, to which the options of a picture refer.
using KindRobots = std::vector<std::unique_ptr<const Robot>>;

/// Reads the files, and adds what they contain to the options of a picture. Throws ArgumentError for options that do
/// not go together, FileError for files.
KindRobots read_marks(const QueryArgs& query, const HeatmapMarkArgs& args, HeatmapOptions& picture);

/// Leaves only the spawns, starts and goals that stand on ground in a range of heights, and the parts of paths there.
/// Prints a notice about what it leaves out.
void keep_heights(const CommonArgs& common, const Map& map, const ZRange& z, HeatmapOptions& picture);

}  // namespace spawnfield::cli

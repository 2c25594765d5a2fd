#pragma once

#include "cli.h"

namespace spawnfield::cli {

/// Where poses are wanted: of `sample`, `search`, `raster`, `heatmap` and `experiment`.
struct AreaArgs {
    std::vector<std::string> regions, keep_outs;
};
void add_area(CLI::App& command, AreaArgs& args);

/// What --region has if it is there once, with a box; else nothing. Throws ArgumentError.
std::optional<Bounds> lone_box(const AreaArgs& args);

/// Reads the files and tells what is odd about them. Throws ArgumentError, FileError.
Area read_area(const CommonArgs& common, const AreaArgs& args);

/// A notice for each region that lies off the map, or is so small that it may be in degrees.
void tell_about_area(const CommonArgs& common, const Map& map, const Area& area);

}  // namespace spawnfield::cli

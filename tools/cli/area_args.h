#pragma once

#include "common_args.h"

#include <spawnfield/map.h>
#include <spawnfield/region.h>

#include <optional>
#include <string>
#include <vector>

namespace spawnfield::cli {

/// Options about the places where poses are wanted, for `sample`, `search`, `raster`, `heatmap` and `experiment`.
struct AreaArgs {
    std::vector<std::string> regions, keep_outs;
};
void add_area(CLI::App& command, AreaArgs& args);

/// Returns whether a region is given as numbers with commas between them.
bool is_box(const std::string& text);

/// Returns the box of --region if it was given once, with a box; otherwise nothing. Throws ArgumentError.
std::optional<Bounds> lone_box(const AreaArgs& args);

/// Reads the files and prints their notices. Throws ArgumentError, FileError.
Area read_area(const CommonArgs& common, const AreaArgs& args);

/// Prints a notice for each region that lies off the map, or is so small that it may be in degrees.
void notice_about_area(const CommonArgs& common, const Map& map, const Area& area);

}  // namespace spawnfield::cli

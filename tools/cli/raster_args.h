#pragma once

#include "area_args.h"
#include "ground_args.h"
#include "session.h"

namespace spawnfield::cli {

/// Options of rasters except steps and outputs, for `raster` and `experiment`.
struct RasterArgs : QueryArgs {
    int dims = 2;
    AreaArgs area;
    GroundArgs ground;
    std::string bounds, yaw = "0";
    bool no_height_check = false, snap = false;
};

/// Adds --dims.
CLI::Option* add_dims(CLI::App& command, RasterArgs& args);

/// Adds the groups of options on poses, ground, robots at rest, region, robot and run.
void add_raster_query(CLI::App& command, RasterArgs& args);

/// Returns the raster's options without the steps and what complete() adds. Prints notices about options without
/// effect. Throws ArgumentError for options that do not go together.
RasterOptions raster_options(const RasterArgs& args, const CLI::App& command);

/// Completes the options when the map and the robot are known, and puts the offset into the summary. Prints a notice if
/// an answer is known without a query. Throws ArgumentError for a floor that the map does not have and for an offset
/// above --max-height, NothingFits if the robot collides with all flat ground.
void complete(RasterOptions& options, const RasterArgs& args, const Session& session, Summary& summary);

/// Returns the step that gives about so many columns along the longer side of a raster, but not less than the map's
/// resolution.
double default_step(const Map& map, const RasterOptions& options, int columns);

/// Throws MemoryError if a 2D raster that is held in memory as a whole needs too much. `options` have their step,
/// which is the value of `step_option`. `rasters`: how many of them are held.
void require_raster_memory(const CommonArgs& args, const Map& map, const RasterOptions& options,
                           const std::string& step_option = "--step", int rasters = 1);

}  // namespace spawnfield::cli

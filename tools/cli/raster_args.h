#pragma once

#include "area_args.h"
#include "ground_args.h"

namespace spawnfield::cli {

/// Options of rasters beside steps and outputs, as `raster` and `experiment` take them.
struct RasterArgs : QueryArgs {
    int dims = 2;
    AreaArgs area;
    GroundArgs ground;
    std::string bounds, yaw = "0";
    bool no_height_check = false, snap = false;
};
void add_raster_query(CLI::App& command, RasterArgs& args);

/// Everything but the steps and what complete() adds. Tells of options without effect; throws ArgumentError for those
/// that do not go together.
RasterOptions raster_options(const RasterArgs& args, const CLI::App& command);

/// Completes the options once the map and the robot are known, and notes the offset in the summary. Prints notices
/// where an answer is plain before it is asked for. Throws ArgumentError for a floor that there is not, or an offset
/// above
/// --max-height, NothingFits where the robot collides with all flat ground.
void complete(RasterOptions& options, const RasterArgs& args, const Session& session, Summary& summary);

}  // namespace spawnfield::cli

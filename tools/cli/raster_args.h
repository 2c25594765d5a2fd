#pragma once

#include "area_args.h"

namespace spawnfield::cli {

/// Options of rasters beside steps and outputs, as `raster` and `experiment` take them.
struct RasterArgs : QueryArgs {
    int dims = 2;
    double offset = 0.1;
    AreaArgs area;
    std::string bounds, layers = "all", yaw = "0";
    bool no_height_check = false, snap = false;
};
void add_raster_query(CLI::App& command, RasterArgs& args);

/// Everything but the steps. Tells of options without effect; throws ArgumentError for those that do not go together.
RasterOptions raster_options(const RasterArgs& args, const CLI::App& command);

/// Notices that the map and the robot give rise to.
void tell_about(const RasterArgs& args, const Session& session, const RasterOptions& options);

}  // namespace spawnfield::cli

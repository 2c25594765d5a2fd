#pragma once

#include "drawing/shown_columns.h"

namespace spawnfield {

/// Returns the height, clearance or slope of each column; NaN where the shown pose is not valid at all headings. Row 0
/// is the largest y.
cv::Mat_<float> quantity_values(const ShownPoses& shown, const RasterResult& raster, const TerrainMap& terrain,
                                const HeatmapOptions& options);

}  // namespace spawnfield

#pragma once

#include <spawnfield/export.h>
#include <spawnfield/place_quantities.h>
#include <spawnfield/query.h>

#include <vector>

namespace spawnfield {

/// Returns a quantity of each pose of a raster: the number that sample() gives a spawn at this pose. NaN for poses that
/// are not valid. The judge must be that of the raster. `measures` has the settings of the quantity; its columns and
/// preferences are not used. Throws ArgumentError for measures beyond their limits, for quantities of settled robots if
/// the robots are level, and for a raster of settled poses without RasterResult::rests.
SPAWNFIELD_API std::vector<double> raster_quantity(const Judge& judge, const RasterResult& raster,
                                                   PlaceQuantity quantity, const PlaceMeasures& measures = {},
                                                   const RunOptions& options = {});

}  // namespace spawnfield

#pragma once

#include <spawnfield/query.h>

namespace spawnfield {

/// Returns the grid of poses that raster() checks within `bounds`. It has as many steps as fit, to 1e-9 of a step, and
/// no heights unless options.dims is 3. Throws ArgumentError if there are more than an int can count.
RasterGrid raster_grid(const Bounds& bounds, const RasterOptions& options);

}  // namespace spawnfield

#pragma once

#include <spawnfield/query.h>

namespace spawnfield {

/// Returns the columns, and with options.dims 3 also the heights, that raster() checks within `bounds`, which must not
/// be empty. options.bounds is not used. With dims 2, `heights` is 0. The grid has as many steps as fit; the last one
/// of an axis may lie beyond the bounds by 1e-9 of a step. Throws ArgumentError if there are more than 2147483647
/// columns, or as many steps along an axis.
RasterGrid raster_grid(const Bounds& bounds, const RasterOptions& options);

}  // namespace spawnfield

#pragma once

#include <spawnfield/export.h>
#include <spawnfield/query.h>

namespace spawnfield {

/// A 2D raster at several yaws, for robots that may have any heading.
struct HeadingRaster {
    /// Each pose is Valid if it is valid at one heading or more. Otherwise it has its most frequent verdict. Its yaw is
    /// 0.
    RasterResult raster;
    int headings = 16;
    std::vector<std::uint8_t> valid_headings;  ///< for each pose: the number of headings at which it is valid
};

/// Returns the raster at yaws 2 pi k / headings. options.yaw is not used. Columns are computed once for all yaws, so
/// this takes much less time than `headings` rasters, except for settled poses. These have no RasterResult::rests, and
/// z is RasterResult::offset above the layer. Throws ArgumentError unless headings is in 1 .. 255 and options.dims is
/// 2, and everything that raster() throws.
SPAWNFIELD_API HeadingRaster raster_at_headings(const Judge& judge, const RasterOptions& options, int headings = 16);

}  // namespace spawnfield

#pragma once

#include "review/pack.h"

#include <spawnfield/review.h>

namespace spawnfield {

/// Adds a raster to a pack, and returns the object that describes it. All poses are judged again, with the heights that
/// the pack has, except in updates. Throws ArgumentError unless the raster has two dimensions and one yaw.
Json add_layer(PackWriter& pack, const Judge& judge, const RasterResult& raster, const ReviewContents& contents,
               const RunOptions& options);

}  // namespace spawnfield

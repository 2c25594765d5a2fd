#pragma once

#include <spawnfield/query.h>

#include <optional>
#include <vector>

namespace bench {

/// A pose of the 2D raster of top layers, with its verdict.
struct TopPose {
    double z = 0;
    spawnfield::Verdict verdict{};
};

/// A pose for each column, row by row as in RasterResult; nothing where there is no terrain.
using TopRaster = std::vector<std::optional<TopPose>>;

}  // namespace bench

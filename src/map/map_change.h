#pragma once

#include "geometry/tile.h"

#include <spawnfield/map.h>

#include <vector>

namespace spawnfield {

/// How a changed map differs from the one before.
struct MapChange {
    Map base;
    std::vector<ElementBox> boxes;  ///< around all removed and added elements (see ChangedGeometry)
};

}  // namespace spawnfield

#pragma once

#include "geometry/tile.h"

#include <spawnfield/geometry.h>

#include <cstdint>
#include <vector>

namespace spawnfield {

/// A geometry that shares all tiles of another one, without some of its parts and with further parts.
struct ChangedGeometry {
    Geometry geometry;
    /// Boxes that together contain all removed and added elements, each around the elements of one tile. Outside of
    /// them, nothing has changed.
    std::vector<ElementBox> boxes;
    bool changes_terrain = false;  ///< terrain was removed or added
};

/// Removes the parts that are marked (one mark for each part of `base`), then adds the parts of a scene. Queries find
/// in the result exactly what they find in Geometry(scene) of the changed scene, and in the same order of parts. If a
/// part is removed, reads all tiles of `base`; otherwise the time depends on the added elements only.
ChangedGeometry changed_geometry(const Geometry& base, const std::vector<bool>& is_removed, const Scene& added,
                                 int threads);

}  // namespace spawnfield

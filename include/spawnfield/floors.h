#pragma once

#include <spawnfield/export.h>
#include <spawnfield/terrain.h>

#include <vector>

namespace spawnfield {

/// A height around which much of a map's ground lies: a storey, a deck, a plateau.
struct Floor {
    double height = 0;  ///< m; the height at which this floor has most ground
    /// Layers in this range belong to the floor. The limit between two floors is half way between their heights, so the
    /// lower half of a ramp belongs to the lower floor. The range of the lowest floor has no lower limit, and that of
    /// the highest floor no upper limit. So every layer belongs to exactly one floor.
    ZRange z;
    double area = 0;   ///< m2 of ground in this range
    double share = 1;  ///< share of the map's ground, 0 .. 1
};

/// Returns the floors of a map, from the lowest to the highest. There is at least one, unless the map has no ground.
///
/// Ground is each cell of each layer with at least 1.5 m of free height up to the next layer. If a map has no such
/// cell, all cells of all layers are ground. The density is the number of ground cells at each height, counted in steps
/// of 1 cm and smoothed over 0.25 m upwards and downwards. A peak of the density is a floor if it is separate, flat and
/// large. Separate: between it and the next higher peak, the density falls below half of its own. Flat: of the ground
/// that is nearer to this peak than to any other, at least half lies within 0.25 m. Large: it has at least 2 % of the
/// ground, and 1 m2. If there is no such peak, for example in hills, all ground is one floor at the median height.
/// O(cells x layers). Source: persistence of peaks (Edelsbrunner, Letscher, Zomorodian, Topological persistence and
/// simplification, 2002).
SPAWNFIELD_API std::vector<Floor> find_floors(const TerrainMap& terrain, int threads = 0);

}  // namespace spawnfield

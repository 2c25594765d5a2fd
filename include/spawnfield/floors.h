#pragma once

#include <spawnfield/export.h>
#include <spawnfield/terrain.h>

#include <vector>

namespace spawnfield {

/// A height around which much of a map's ground lies: a storey, a deck, a plateau.
struct Floor {
    double height = 0;  ///< m, where the ground of this floor is densest
    /// Layers in this range belong to the floor. The limit between two floors is half way between their heights, so a
    /// ramp belongs to the lower one up to half its height. The lowest and the highest floor have no limit outward:
    /// every layer belongs to exactly one floor.
    ZRange z;
    double area = 0;   ///< m2 of ground in this range
    double share = 1;  ///< of the map's ground, 0 .. 1
};

/// Floors of a map from the lowest to the highest. At least one, unless there is no ground.
///
/// Ground is each cell of each layer with 1.5 m or more of free height up to the next layer, or, where a map has no
/// such cell, each cell of each layer. Its heights are counted in steps of 1 cm and smoothed over 0.25 m to either
/// side. A peak of that density is a floor if it is separate (between it and the next higher peak the density falls to
/// less than half of its own), flat (half of the ground that is nearer to it than to another peak lies within 0.25 m)
/// and large (2 % of the ground or more, and 1 m2). Ground without such a peak, hills for example, is one floor at the
/// median height. O(cells x layers). Source: persistence of peaks (Edelsbrunner, Letscher, Zomorodian, Topological
/// persistence and simplification, 2002).
SPAWNFIELD_API std::vector<Floor> find_floors(const TerrainMap& terrain, int threads = 0);

}  // namespace spawnfield

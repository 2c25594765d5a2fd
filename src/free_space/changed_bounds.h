#pragma once

#include "geometry/tile.h"

#include <spawnfield/solid_bounds.h>

#include <span>

namespace spawnfield {

/// Returns the images that SolidBounds(geometry, bounds, cell) of a changed geometry has, where `base` has those of the
/// unchanged one with the same bounds. Tiles that meet no box of the changes are shared with `base`. Each other one is
/// made when it is first opened, so this function only lists them.
SolidBounds changed_bounds(const SolidBounds& base, const Geometry& geometry, const Bounds& bounds,
                           std::span<const ElementBox> boxes);

/// Returns the images of a changed scene with tiles of their own, as a new bake makes them: all tiles that differ are
/// made, all others are copied. The tiles of the unchanged images must have the version that this program writes.
SolidBounds made_bounds(const SolidBounds& changed, int threads);

}  // namespace spawnfield

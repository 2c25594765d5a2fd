#pragma once

#include "base/tile_store.h"

#include <spawnfield/scene.h>

namespace spawnfield {

/// Fills the triangles, pieces and primitives of a scene from the tiles of geometry.bin version 2. scene.parts must be
/// set. Throws FileError if the tiles are damaged or contradict each other.
void read_old_tiles(const TileStore& tiles, std::uint64_t triangles, std::uint64_t elements, Scene& scene);

}  // namespace spawnfield

#pragma once

#include "geometry/tile.h"

#include <spawnfield/terrain.h>

#include <span>

namespace spawnfield {

/// Returns rasterize_terrain() of a changed geometry, where `base` is that of the unchanged one. Only tiles that meet a
/// box of the changes, or come within a cell of one, are computed.
TerrainMap changed_terrain(const TerrainMap& base, const Geometry& geometry, std::span<const ElementBox> boxes,
                           const ZRange& z_limits, int threads = 0);

/// Returns count_layers() of changed_terrain(), in less time.
int changed_layers(const TerrainMap& base, const Geometry& geometry, std::span<const ElementBox> boxes,
                   const ZRange& z_limits, int threads = 0);

/// Returns whether a page has the same tiles in both maps, which have the same frame.
bool has_same_tiles(const TerrainMap& a, const TerrainMap& b, const std::string& page);

/// Returns the largest number of layers in a cell. It is 0 without any height: TerrainMap::layers() is then 1, because
/// the page of the highest layer always exists.
int count_layers(const TerrainMap& terrain);

}  // namespace spawnfield

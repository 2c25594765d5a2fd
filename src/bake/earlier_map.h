#pragma once

#include "geometry/tile.h"

#include <spawnfield/bake.h>

namespace spawnfield {

/// A map of an earlier state of a scene. It has the raster and the limits of the map that is baked now.
struct EarlierMap {
    Map map;
    TerrainMap terrain;
    std::pair<double, double> heightmap_z;  ///< of map.yaml: heights of the pixels 0 and 65535 of heightmap.png
    /// Boxes that together contain all elements that were removed or added since, each around the elements of one tile.
    std::vector<ElementBox> boxes;
};

/// What of an old map can be used for a new bake.
struct EarlierState {
    std::optional<EarlierMap> map;
    std::string why_not;  ///< the reason why the new map must be baked in full, if there is no `map`
};

/// Reads the map in `folder`, and compares it with the map that is baked now. `now` is complete up to its geometry.
/// Throws FileError for `scene_file` if a part that no glob matches differs, for the folder if it is not a map or is
/// damaged, and ArgumentError for globs that match nothing and for options that differ.
EarlierState earlier_state(const std::filesystem::path& folder, const std::filesystem::path& scene_file, const Map& now,
                           const std::vector<std::string>& globs, const BakeOptions& options);

/// Writes heightmap.png as a copy of the file of the earlier map. Throws FileError if that file was altered, and
/// OutputError.
void copy_heightmap(const Map& from, const std::filesystem::path& to);

}  // namespace spawnfield

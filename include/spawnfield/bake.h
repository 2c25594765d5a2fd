#pragma once

#include <spawnfield/export.h>
#include <spawnfield/map.h>

namespace spawnfield {

struct BakeOptions {
    double resolution = 0;  ///< m; 0: 0.1 m, or coarser with a notice where that passes max_columns
    double occupancy_resolution =
        0;               ///< m; 0: 2.5 times the resolution, or coarser with a notice where OctoMap needs it
    Bounds bounds = {};  ///< empty: the scene's
    ZRange z = {};       ///< z limits; without any: those of `bounds`, if given
    bool allow_no_terrain = false;
    int threads = 0;
    Progress progress = {};
};

/// Returns the map of a scene in memory, for scenes without files: geometry, mask, layers and floors are those that
/// bake() writes, so queries give the same answers. Its hash, scene_file and folder are empty.
///
/// Throws ArgumentError for bad options, a scene without terrain (unless allowed), and bounds that do not meet the
/// scene.
SPAWNFIELD_API Map make_map(const Scene& scene, const BakeOptions& options = {});

/// What a bake did, for its summary.
struct BakeReport {
    std::vector<std::string> notices;
    std::vector<std::pair<std::string, double>> seconds;  ///< by stage, in order
    int layers = 0;
    std::size_t occupancy_leaves = 0;
    std::uintmax_t bytes = 0;  ///< of the folder
    std::string hash;          ///< as Map::hash
};

/// Writes the map folder: map.yaml and map_files.
///
/// A map with z limits has terrain.tiff, heightmap.png, preview.png and occupancy.bt within them; its geometry stays
/// whole, as a robot collides with solid space beyond them too. Written into a temporary folder beside it, then
/// renamed: an old map stays whole until the new one is complete. Other files that lie in an old map's folder move to
/// the new one. Throws FileError if the scene has no terrain (unless allowed) or does not meet the bounds,
/// ArgumentError for bad options, OutputError.
SPAWNFIELD_API BakeReport bake(Scene scene, const std::filesystem::path& scene_file,
                               const std::filesystem::path& folder, const BakeOptions& options = {});

}  // namespace spawnfield

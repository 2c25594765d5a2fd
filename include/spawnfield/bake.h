#pragma once

#include <spawnfield/export.h>
#include <spawnfield/map.h>

#include <limits>

namespace spawnfield {

struct BakeOptions {
    double resolution = 0;            ///< m; 0: 0.1 m, or coarser with a notice if the map would exceed max_columns
    double occupancy_resolution = 0;  ///< m; 0: 2.5 times the resolution, or coarser with a notice if OctoMap needs it
    Bounds bounds = {};               ///< empty: the bounds of the scene
    ZRange z = {};  ///< z limits of the map; without limits: those of `bounds`, unless `bounds` is empty
    bool allow_no_terrain = false;
    /// Bytes. A map that would need more, by an estimate before the work, is refused with MemoryError.
    double max_memory = std::numeric_limits<double>::infinity();
    int threads = 0;
    Progress progress = {};
};

/// Returns the map of a scene in memory, for scenes without files. Its geometry, mask, layers and floors are the same
/// as those that bake() writes, so queries give the same answers. Its hash, scene_file and folder are empty.
///
/// Throws ArgumentError for bad options, a scene without terrain (unless allowed), and bounds that do not meet the
/// scene.
SPAWNFIELD_API Map make_map(const Scene& scene, const BakeOptions& options = {});

/// The numbers that the summary of a bake contains.
struct BakeReport {
    std::vector<std::string> notices;
    /// The name and the seconds of each stage. Stages that write files run at the same time, so the sum may be longer
    /// than the bake. A name may occur several times.
    std::vector<std::pair<std::string, double>> seconds;
    int layers = 0;
    std::size_t occupancy_leaves = 0;
    std::uintmax_t bytes = 0;  ///< size of the folder
    std::string hash;          ///< the same as Map::hash
};

/// Writes the map folder: map.yaml and map_files. `scene_file` is that from which the scene was read; empty: the scene
/// was made in memory; then Map::scene_file is "(memory)", and the hash that of an empty file.
///
/// If the map has z limits, terrain.tiff, heightmap.png, preview.png and occupancy.bt are restricted to them. The
/// geometry is not restricted, because a robot also collides with solid space beyond the limits. The map is written to
/// a temporary folder beside `folder`, which is then renamed: an old map stays until the new one is complete. Other
/// files in the folder of an old map move to the new folder. Throws FileError if the scene has no terrain (unless
/// allowed) or does not meet the bounds, ArgumentError for bad options, and OutputError.
SPAWNFIELD_API BakeReport bake(Scene scene, const std::filesystem::path& scene_file,
                               const std::filesystem::path& folder, const BakeOptions& options = {});

/// Bakes again only the region of a map that has changed. All files are the same, byte for byte, as those of bake().
///
/// `folder` has the map of an earlier state of the scene, baked with the same options. `changed_parts` are globs of the
/// names of all parts that were moved, changed, added or removed since, as for without_parts(); parts that match, but
/// are the same, cost nothing. "*" finds all changes. Each part has a hash in the map, so a change of a part that no
/// glob matches is an error, not a wrong map.
///
/// If a part changes the bounds of the scene, or another version of the program baked the old map, the map is baked in
/// full, with a notice. Throws FileError if other parts differ, if `folder` is not a map, or is a damaged one;
/// ArgumentError for options that are not those of the old map, for globs that match nothing, and for two parts of the
/// same name; otherwise as bake(). The old map stays until the new one is complete.
SPAWNFIELD_API BakeReport update_map(Scene scene, const std::filesystem::path& scene_file,
                                     const std::filesystem::path& folder, const std::vector<std::string>& changed_parts,
                                     const BakeOptions& options = {});

}  // namespace spawnfield

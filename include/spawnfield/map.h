#pragma once

#include <spawnfield/export.h>
#include <spawnfield/floors.h>
#include <spawnfield/occupancy.h>
#include <spawnfield/solid_bounds.h>
#include <spawnfield/terrain.h>

#include <map>
#include <memory>

namespace spawnfield {

/// Version 9 stores grids of heightmaps in geometry.bin. Version 8 has an occupancy_origin. Version 7 stores the names
/// of nodes and materials of meshes in geometry.bin, for rules of place. Version 6 stores a hash of each part there,
/// for update_map(). Version 5 stores geometry.bin in small tiles under a tree; the tiles of an older map are converted
/// when it is opened, which takes about 0.5 s for a million triangles. Version 4 stores less in bounds.bin: a tile
/// whose cells are all the same only once, and an interval list that cells share only once. Version 3 added z_limits
/// and floors. A map of version 2 has no z limits, and its floors are computed from terrain.tiff.
inline constexpr int map_format_version = 9;

class MapFiles;    // of a map that was read: the files that are read later
struct MapChange;  // of a changed map: what differs from the map before

/// A scene, prepared for queries. `folder` is empty until the map is written or read.
struct Map {
    std::string name;
    Bounds bounds;                         ///< poses beyond them in x and y are `outside`
    ZRange z_limits;                       ///< poses beyond them are `outside`; layers beyond them are not ground
    double resolution = 0.1;               ///< side of a terrain cell, m
    double occupancy_resolution = 0;       ///< side of a voxel, m
    Vec3 occupancy_origin = Vec3::Zero();  ///< where 0, 0, 0 of occupancy.bt is in the scene, m
    Geometry geometry;
    SolidBounds solid_bounds;         ///< for the cells of the terrain's raster
    std::optional<GeoOrigin> origin;  ///< the scene's place in the coordinates of a survey
    bool is_unlabelled = false;       ///< as in Scene: also desks and wall tops are terrain
    int layers = 0;                   ///< largest number of terrain layers in the column of a cell's centre
    /// From find_floors(). No value for a map of format version 2, and for a changed map if terrain has changed.
    std::optional<std::vector<Floor>> floors;
    std::string scene_file;  ///< name of the file from which it was baked
    std::string scene_hash;  ///< xxh64 of that file, 16 hexadecimal digits
    std::string hash;        ///< 16 hexadecimal digits, from the checksums of the map's files
    std::filesystem::path folder;
    std::shared_ptr<const MapFiles> files = {};  ///< of the folder; nullptr for a map that was not read
    int format_version = map_format_version;     ///< of the folder
    std::vector<std::string> changes = {};       ///< of a changed map (changes.h), in words: "without crate*", …
    std::shared_ptr<const MapChange> change = {};
};

/// The files of a map folder, except map.yaml. Other files in the folder do not belong to the map.
inline constexpr std::array map_files{"bounds.bin",   "geometry.bin", "heightmap.png",
                                      "occupancy.bt", "preview.png",  "terrain.tiff"};

/// Reads map.yaml, and opens geometry.bin and bounds.bin. Verifies the sizes of all files; tiles are verified when they
/// are first used. Throws FileError, which names the file, if the map is missing, damaged, cut short or of a newer
/// version.
SPAWNFIELD_API Map read_map(const std::filesystem::path& folder);

/// Returns the pages of terrain.tiff, or makes them for a map without a folder. Throws FileError.
SPAWNFIELD_API TerrainMap read_terrain(const Map& map);

/// Returns Map::floors. If the map has none, computes them with find_floors() from the terrain. Throws FileError.
SPAWNFIELD_API std::vector<Floor> floors_of(const Map& map);

/// Returns the tree of occupancy.bt, or makes it for a map without a folder. Throws FileError.
SPAWNFIELD_API OccupancyTree read_occupancy(const Map& map);

/// Verifies the sizes and checksums of all files of the folder. Throws FileError at the first that differs.
SPAWNFIELD_API void verify_map(const std::filesystem::path& folder);

}  // namespace spawnfield

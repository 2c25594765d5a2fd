#pragma once

#include <spawnfield/export.h>
#include <spawnfield/floors.h>
#include <spawnfield/occupancy.h>
#include <spawnfield/solid_bounds.h>
#include <spawnfield/terrain.h>

#include <map>

namespace spawnfield {

/// A scene made ready for queries. `folder` is empty until it is written or read.
struct Map {
    std::string name;
    Bounds bounds;                    ///< poses beyond them in x and y are `outside`
    ZRange z_limits;                  ///< poses beyond them are `outside`, layers beyond them are no ground
    double resolution = 0.1;          ///< of the terrain, m
    double occupancy_resolution = 0;  ///< m
    Geometry geometry;
    SolidBounds solid_bounds;                  ///< of the terrain's raster
    std::optional<GeoOrigin> origin;           ///< where it lies in a survey's coordinates
    int layers = 0;                            ///< most terrain layers above one cell centre
    std::optional<std::vector<Floor>> floors;  ///< as find_floors; nothing: in a map of format version 2
    std::string scene_file;                    ///< name of the file it was baked from
    std::string scene_hash;                    ///< xxh64 of that file, 16 hexadecimal digits
    std::string hash;                          ///< of the map: of its files' checksums, 16 hexadecimal digits
    std::filesystem::path folder;
};

/// The files of a map folder beside map.yaml. What else lies there is none of spawnfield's.
inline constexpr std::array map_files{"bounds.bin",   "geometry.bin", "heightmap.png",
                                      "occupancy.bt", "preview.png",  "terrain.tiff"};

/// What queries need: map.yaml and geometry.bin, sizes and checksums verified.
/// Throws FileError, which names the file, for a map that is missing, damaged, cut short or newer.
SPAWNFIELD_API Map read_map(const std::filesystem::path& folder);

/// Returns the pages of terrain.tiff, or makes them for a map without a folder. Throws FileError.
SPAWNFIELD_API TerrainMap read_terrain(const Map& map);

/// Map::floors, or where there are none find_floors of the terrain. Throws FileError.
SPAWNFIELD_API std::vector<Floor> floors_of(const Map& map);

/// Returns the tree of occupancy.bt, or makes it for a map without a folder. Throws FileError.
SPAWNFIELD_API OccupancyTree read_occupancy(const Map& map);

/// Sizes and checksums of all files of the folder. Throws FileError at the first that differs.
SPAWNFIELD_API void verify_map(const std::filesystem::path& folder);

/// Version 3 added z_limits and floors. Version 2 is read: without z limits, floors found anew from terrain.tiff.
inline constexpr int map_format_version = 3;

}  // namespace spawnfield

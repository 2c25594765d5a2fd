#pragma once

#include <spawnfield/map.h>

namespace spawnfield {

/// map.yaml of a folder whose other files are written: what they are, their sizes and checksums. Returns the map's
/// hash.
std::string write_map_yaml(const std::filesystem::path& folder, const Map& map, const TerrainMap& terrain,
                           std::pair<double, double> heightmap_range);

/// A file of the map as map.yaml lists it.
struct ListedFile {
    std::string name, checksum;
    std::string head_checksum;  ///< of files that are read tile by tile
    std::uintmax_t bytes = 0;
};

/// map.yaml: fills all of Map but its geometry. Throws FileError.
struct MapYaml {
    Map map;
    GridFrame frame;
    std::vector<std::string> pages;  ///< of terrain.tiff
    std::vector<ListedFile> files;
};
MapYaml read_map_yaml(const std::filesystem::path& folder);

}  // namespace spawnfield

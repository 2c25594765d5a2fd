#pragma once

#include "map/listed_file.h"

#include <spawnfield/map.h>

namespace spawnfield {

/// Writes map.yaml to a folder that already contains the map's other files, and lists their sizes and checksums in it.
/// `written` has entries that are known already; the other files are read. Returns the map's hash.
std::string write_map_yaml(const std::filesystem::path& folder, const Map& map, const TerrainMap& terrain,
                           std::pair<double, double> heightmap_range, const std::vector<ListedFile>& written);

/// The contents of map.yaml. `map` is complete except for its geometry and its solid bounds.
struct MapYaml {
    Map map;
    GridFrame frame;
    std::vector<std::string> pages;  ///< of terrain.tiff
    std::vector<ListedFile> files;
    std::pair<double, double> heightmap_z;  ///< heights of the pixels 0 and 65535 of heightmap.png, m
};
/// Reads map.yaml of a map folder. Throws FileError.
MapYaml read_map_yaml(const std::filesystem::path& folder);

/// Returns the entry of a file in map.yaml. Throws FileError if there is none.
const ListedFile& listed(const MapYaml& yaml, const std::string& name);

/// Returns whether this version of the program baked the map, with these versions of its libraries. Throws FileError.
bool is_of_this_program(const std::filesystem::path& folder);

/// Verifies the size and the checksum of one of the map's files. Throws FileError if they are not those of map.yaml.
void check_listed(const std::filesystem::path& folder, const std::string& file);

}  // namespace spawnfield

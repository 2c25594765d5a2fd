#include "map/bounds_file.h"
#include "map/changed_terrain.h"
#include "map/geometry_file.h"
#include "map/map_change.h"
#include "map/map_yaml.h"
#include "map/terrain_file.h"

#include <spawnfield/error.h>
#include <spawnfield/map.h>

#include <algorithm>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

const ListedFile& listed(const MapYaml& yaml, const std::string& name)
{
    const auto file = std::find_if(yaml.files.begin(), yaml.files.end(),
                                   [&](const ListedFile& f) { return f.name == name; });
    if (file == yaml.files.end())
        throw FileError((yaml.map.folder / "map.yaml").string(),
                        "does not list " + name + " under files; bake the map again");
    return *file;
}

}  // namespace

Map read_map(const fs::path& folder)
{
    MapYaml yaml = read_map_yaml(folder);
    for (const ListedFile& file : yaml.files) check_size(folder, file);
    yaml.map.solid_bounds = open_bounds(folder / "bounds.bin", listed(yaml, "bounds.bin").head_checksum);
    yaml.map.geometry = open_geometry(folder / "geometry.bin", listed(yaml, "geometry.bin").head_checksum);
    return std::move(yaml.map);
}

TerrainMap read_terrain(const Map& map)
{
    if (map.change)
        return changed_terrain(read_terrain(map.change->base), map.geometry, map.change->boxes, map.z_limits);
    if (map.folder.empty())
        return rasterize_terrain(map.geometry, frame_around(map.bounds, map.resolution), 0, {}, map.z_limits);
    const MapYaml yaml = read_map_yaml(map.folder);
    const fs::path file = map.folder / "terrain.tiff";
    check_size(map.folder, listed(yaml, "terrain.tiff"));
    check_checksum(map.folder, listed(yaml, "terrain.tiff"));
    TerrainMap terrain = read_terrain_file(file, yaml.frame);
    const bool same = std::equal(
        terrain.pages.begin(), terrain.pages.end(), yaml.pages.begin(), yaml.pages.end(),
        [](const TerrainMap::Page& page, const std::string& name) { return page.name == name; });
    if (!same) throw FileError(file.string(), "has other pages than map.yaml lists; bake the map again");
    return terrain;
}

std::vector<Floor> floors_of(const Map& map) { return map.floors ? *map.floors : find_floors(read_terrain(map)); }

OccupancyTree read_occupancy(const Map& map)
{
    if (map.folder.empty()) return build_occupancy(map.geometry, map.bounds, map.occupancy_resolution);
    check_listed(map.folder, "occupancy.bt");
    return read_occupancy(map.folder / "occupancy.bt");
}

void check_listed(const fs::path& folder, const std::string& file)
{
    const MapYaml yaml = read_map_yaml(folder);
    check_size(folder, listed(yaml, file));
    check_checksum(folder, listed(yaml, file));
}

void verify_map(const fs::path& folder)
{
    for (const ListedFile& file : read_map_yaml(folder).files) {
        check_size(folder, file);
        check_checksum(folder, file);
    }
}

}  // namespace spawnfield

#include "base/temporary.h"
#include "map/bounds_file.h"
#include "map/changed_terrain.h"
#include "map/geometry_file.h"
#include "map/map_change.h"
#include "map/map_files.h"
#include "map/map_yaml.h"

#include <spawnfield/error.h>
#include <spawnfield/map.h>

#include <fcntl.h>

namespace spawnfield {

namespace fs = std::filesystem;

namespace {

/// Opens the files of a map, whose names must not change meanwhile.
Map opened_map(const fs::path& folder)
{
    MapYaml yaml = read_map_yaml(folder);
    for (const ListedFile& file : yaml.files) check_size(folder, file);
    yaml.map.solid_bounds = open_bounds(folder / "bounds.bin", listed(yaml, "bounds.bin").head_checksum);
    yaml.map.geometry = open_geometry(folder / "geometry.bin", listed(yaml, "geometry.bin").head_checksum);
    yaml.map.files = std::make_shared<const MapFiles>(yaml);
    return std::move(yaml.map);
}

}  // namespace

/// If another run replaces the folder while its files are opened, some may be those of the old map and some those of
/// the new one, or missing. Then the new folder is opened.
Map read_map(const fs::path& folder)
{
    constexpr int most_attempts = 100;
    for (int attempt = 1;; ++attempt) {
        const Descriptor before(open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
        const auto is_replaced = [&] { return attempt < most_attempts && before && !is_reached_by(before, folder); };
        try {
            Map map = opened_map(folder);
            if (!is_replaced()) return map;
        } catch (const FileError&) {
            if (!is_replaced()) throw;
        }
    }
}

TerrainMap read_terrain(const Map& map)
{
    if (map.change)
        return changed_terrain(read_terrain(map.change->base), map.geometry, map.change->boxes, map.z_limits);
    if (map.files) return map.files->terrain();
    return rasterize_terrain(map.geometry, frame_around(map.bounds, map.resolution), 0, {}, map.z_limits);
}

std::vector<Floor> floors_of(const Map& map) { return map.floors ? *map.floors : find_floors(read_terrain(map)); }

OccupancyTree read_occupancy(const Map& map)
{
    if (map.files) return map.files->occupancy();
    return build_occupancy(map.geometry, map.bounds, map.occupancy_resolution);
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

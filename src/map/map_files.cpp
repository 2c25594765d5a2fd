#include "map/map_files.h"

#include "map/terrain_file.h"

#include <spawnfield/error.h>

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace spawnfield {

namespace fs = std::filesystem;

MapFiles::MapFiles(const MapYaml& yaml)
    : frame_(yaml.frame), occupancy_origin_(yaml.map.occupancy_origin), pages_(yaml.pages),
      terrain_(open_listed(yaml, "terrain.tiff")), occupancy_(open_listed(yaml, "occupancy.bt"))
{
}

MapFiles::OpenFile MapFiles::open_listed(const MapYaml& yaml, const std::string& name)
{
    const fs::path file = yaml.map.folder / name;
    const ListedFile& entry = listed(yaml, name);
    Descriptor descriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (!descriptor) throw FileError(file.string(), std::string("cannot be read: ") + std::strerror(errno));
    return {file, entry, std::move(descriptor)};
}

template <class Read>
auto MapFiles::read_verified(const OpenFile& file, const Read& read)
{
    const std::string path = "/proc/self/fd/" + std::to_string(file.descriptor.get());
    try {
        if (entry_of(path).checksum != file.listed.checksum) throw altered(file.name);
        return read(fs::path(path));
    } catch (const FileError& error) {
        const std::string text = error.what();
        if (!text.starts_with(path + ": ")) throw;
        throw FileError(file.name.string(), text.substr(path.size() + 2));
    }
}

TerrainMap MapFiles::terrain() const
{
    TerrainMap out = read_verified(terrain_, [&](const fs::path& path) { return read_terrain_file(path, frame_); });
    const bool same = std::equal(
        out.pages.begin(), out.pages.end(), pages_.begin(), pages_.end(),
        [](const TerrainMap::Page& page, const std::string& name) { return page.name == name; });
    if (!same) throw FileError(terrain_.name.string(), "has other pages than map.yaml lists; bake the map again");
    return out;
}

OccupancyTree MapFiles::occupancy() const
{
    return read_verified(occupancy_, [&](const fs::path& path) { return read_occupancy(path, occupancy_origin_); });
}

}  // namespace spawnfield

#pragma once

#include "base/temporary.h"
#include "map/map_yaml.h"

namespace spawnfield {

/// The files of a map's folder that are read some time after the map was opened. They are kept open, so that all
/// answers are those of one map, also if another run replaces or removes the folder meanwhile.
class MapFiles {
public:
    /// Opens them. Throws FileError.
    explicit MapFiles(const MapYaml& yaml);

    /// Read and verify a file. Throw FileError.
    TerrainMap terrain() const;
    OccupancyTree occupancy() const;

private:
    struct OpenFile {
        std::filesystem::path name;
        ListedFile listed;
        Descriptor descriptor;
    };
    static OpenFile open_listed(const MapYaml& yaml, const std::string& name);

    /// Returns read(path) of an open file, verified. `path` opens it also if it has no name any more; errors name it as
    /// the folder did.
    template <class Read>
    static auto read_verified(const OpenFile& file, const Read& read);

    GridFrame frame_;
    Vec3 occupancy_origin_;
    std::vector<std::string> pages_;  ///< of terrain.tiff
    OpenFile terrain_, occupancy_;
};

}  // namespace spawnfield

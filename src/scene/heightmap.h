#pragma once

#include "base/yaml_map.h"
#include "scene/height_file.h"

#include <spawnfield/scene.h>

namespace spawnfield {

struct HeightmapOptions {
    std::optional<std::array<double, 2>> size;  ///< m from first to last pixel centre
    std::optional<std::array<double, 2>> cell;  ///< m between neighbouring pixel centres; neither: what the file says
    std::optional<std::array<double, 2>>
        z;  ///< heights of pixel values 0 and 255 or 65535, m; not for values that are metres
    std::optional<std::array<double, 2>>
        origin;  ///< coordinates of the survey that come to lie at the part's origin; none: the middle's
    std::optional<double> no_data;  ///< in place of what the file says
    std::optional<RawLayout> raw;
    std::string place = "heightmap.";  ///< of its keys, for complaints
};

/// Heights on a grid; row 0 is the largest y. NaN: no ground there.
struct Heightmap {
    std::array<double, 2> size{};
    int rows = 0, cols = 0;
    std::vector<double> heights;       ///< m, row after row
    Vec3 middle = Vec3::Zero();        ///< of the grid, from the part's origin, m
    std::optional<GeoOrigin> origin;   ///< survey coordinates of the part's origin, where the file tells them
    std::vector<std::string> notices;  ///< what was assumed
};

/// Of a `heightmap:` key of a scene.yaml, or of a text such as "size: [2, 2], z: [0, 1]" for a file by itself. Throws
/// FileError.
HeightmapOptions read_heightmap_options(const YamlMap& map);
HeightmapOptions parse_heightmap_options(const std::string& text);  ///< throws ArgumentError

/// A file that read_height_file reads, with at least 2 x 2 heights, of which not all are missing. Throws FileError.
Heightmap read_heightmap(const std::filesystem::path& file, const HeightmapOptions& options);

/// Appends it as a sheet whose `middle` is moved by the pose. Each cell is split into two triangles along the diagonal
/// from its smaller (column, row) corner to its larger one; a triangle with a NaN corner is left out.
void append_heightmap(Scene& scene, std::uint32_t part, const Heightmap& map, const Pose& pose, bool sides_up);

/// Tells the scene where it lies in the survey's coordinates, and the user if its parts disagree on it.
void place_scene(Scene& scene, const Heightmap& map, const Pose& pose, const std::string& file);

}  // namespace spawnfield

#pragma once

#include "base/yaml_map.h"
#include "scene/height_file.h"

#include <spawnfield/scene.h>

namespace spawnfield {

struct HeightmapOptions {
    std::optional<std::array<double, 2>> size;  ///< m from first to last pixel centre
    /// m between neighbouring pixel centres. Without size and cell, the file must state it.
    std::optional<std::array<double, 2>> cell;
    /// Heights of the pixel values 0 and 255 or 65535, m. Not allowed if pixels are metres.
    std::optional<std::array<double, 2>> z;
    /// Survey coordinates that are moved to the part's origin; empty: those of the heightmap's middle.
    std::optional<std::array<double, 2>> origin;
    std::optional<double> no_data;  ///< replaces the file's own value
    std::optional<RawLayout> raw;
    std::string place = "heightmap.";  ///< where the keys are given, for messages
};

/// Heights on a grid. Row 0 has the largest y. NaN: there is no ground.
struct Heightmap {
    std::array<double, 2> size{};
    int rows = 0, cols = 0;
    std::vector<double> heights;       ///< m, row after row
    Vec3 middle = Vec3::Zero();        ///< of the grid, relative to the part's origin, m
    std::optional<GeoOrigin> origin;   ///< survey coordinates of the part's origin, if the file states its place
    std::vector<std::string> notices;  ///< about assumptions and missing heights
};

/// Reads the options from a `heightmap:` key of a scene.yaml, or from a text such as "size: [2, 2], z: [0, 1]" for an
/// elevation model by itself. Throws FileError.
HeightmapOptions read_heightmap_options(const YamlMap& map);
HeightmapOptions parse_heightmap_options(const std::string& text);  ///< throws ArgumentError

/// Reads a heightmap from a file that read_height_file() can read. It needs at least 2 x 2 pixels, and at least one
/// height. Throws FileError.
Heightmap read_heightmap(const std::filesystem::path& file, const HeightmapOptions& options);

/// Appends the heightmap as a sheet, moved by the pose. Each cell is split into two triangles along the diagonal from
/// its corner with the smaller column and row to the opposite one. Triangles with a NaN corner are ignored.
void append_heightmap(Scene& scene, std::uint32_t part, const Heightmap& map, const Pose& pose, bool sides_up);

/// Sets the scene's place in survey coordinates, and takes over the notices of the heightmap. Adds a notice if a
/// heightmap disagrees with an earlier one about the place.
void place_scene(Scene& scene, const Heightmap& map, const Pose& pose, const std::string& file);

}  // namespace spawnfield

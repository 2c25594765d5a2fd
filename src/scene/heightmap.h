#pragma once

#include "base/grey_image.h"
#include "scene/yaml_map.h"

#include <spawnfield/scene.h>

namespace spawnfield {

struct HeightmapOptions {
    std::array<double, 2> size{};                ///< m from first to last pixel centre
    std::optional<std::array<double, 2>> z;      ///< heights of pixel values 0 and 255 or 65535, m; not for float images
};

/// Heights on a grid; row 0 is the largest y. NaN: no ground there.
struct Heightmap {
    std::array<double, 2> size{};
    int rows = 0, cols = 0;
    std::vector<double> heights;  ///< m, row after row
};

HeightmapOptions read_heightmap_options(const YamlMap& map);

/// A PNG or TIFF of at least 2 x 2 pixels, one channel. Throws FileError.
GreyImage read_grey_image(const std::filesystem::path& file);

/// An 8- or 16-bit grey image, or a float one, which is metres already. At least 2 x 2 pixels. Throws FileError.
Heightmap read_heightmap(const std::filesystem::path& file, const HeightmapOptions& options);

/// Appends it as a sheet centred on the pose's origin. Each cell is split into two triangles along the diagonal from its
/// smaller (column, row) corner to its larger one; a triangle with a NaN corner is left out.
void append_heightmap(Scene& scene, std::uint32_t part, const Heightmap& map, const Pose& pose, bool sides_up);

}  // namespace spawnfield

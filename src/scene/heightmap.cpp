#include "scene/heightmap.h"

#include "base/png.h"
#include "base/tiff.h"
#include "scene/pieces.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace spawnfield {

GreyImage read_grey_image(const std::filesystem::path& file)
{
    if (!std::filesystem::is_regular_file(file)) throw FileError(file.string(), "does not exist; is the path right?");
    std::ifstream stream(file, std::ios::binary);
    std::string start(8, '\0');
    stream.read(start.data(), std::streamsize(start.size()));
    start.resize(std::size_t(stream.gcount()));
    if (!is_png(start) && !is_tiff(start)) throw FileError(file.string(), "is neither PNG nor TIFF; a heightmap needs to be one of them");
    GreyImage image = is_png(start) ? read_grey_png(file) : read_grey_tiff(file);
    if (image.rows < 2 || image.cols < 2)
        throw FileError(file.string(), "has " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
                                           " pixels, needs at least 2 x 2");
    return image;
}

HeightmapOptions read_heightmap_options(const YamlMap& map)
{
    map.only({"file", "size", "z"});
    HeightmapOptions options;
    options.size = map.positive_pair("size");
    if (map.has("z")) options.z = map.pair("z");
    return options;
}

Heightmap read_heightmap(const std::filesystem::path& file, const HeightmapOptions& options)
{
    GreyImage image = read_grey_image(file);
    const bool is_float = image.largest == 0;
    if (is_float && options.z) throw FileError(file.string(), "is a float image, which is metres already; heightmap.z must go");
    if (!is_float && !options.z) throw FileError(file.string(), "is an integer image; heightmap.z is missing (heights of 0 and of the largest value)");

    Heightmap map{options.size, image.rows, image.cols, std::move(image.pixels)};
    for (std::size_t i = 0; i < map.heights.size(); ++i) {
        double& z = map.heights[i];
        if (!is_float) z = (*options.z)[0] + z / image.largest * ((*options.z)[1] - (*options.z)[0]);
        if (std::isinf(z))
            throw FileError(file.string(), "row " + std::to_string(i / std::size_t(map.cols)) + ", column " +
                                               std::to_string(i % std::size_t(map.cols)) + " is infinite, needs a finite height or NaN (no ground)");
    }
    if (std::all_of(map.heights.begin(), map.heights.end(), [](double z) { return std::isnan(z); }))
        throw FileError(file.string(), "has no heights: every pixel is NaN");
    return map;
}

void append_heightmap(Scene& scene, std::uint32_t part, const Heightmap& map, const Pose& pose, bool sides_up)
{
    const double dx = map.size[0] / (map.cols - 1), dy = map.size[1] / (map.rows - 1);
    constexpr std::uint32_t unused = 0xffffffff;
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> index(map.heights.size(), unused);
    const auto vertex = [&](std::size_t pixel) {
        if (index[pixel] == unused) {
            const double row = double(pixel / std::size_t(map.cols)), col = double(pixel % std::size_t(map.cols));
            const Vec3 local(col * dx - map.size[0] / 2, map.size[1] / 2 - row * dy, map.heights[pixel]);
            index[pixel] = static_cast<std::uint32_t>(vertices.size());
            vertices.push_back(pose.rotation * local + pose.position);
        }
        return index[pixel];
    };
    std::vector<Triangle> triangles;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        if (!std::isnan(map.heights[a] + map.heights[b] + map.heights[c])) triangles.push_back({vertex(a), vertex(b), vertex(c)});
    };
    for (int row = 0; row + 1 < map.rows; ++row)
        for (int col = 0; col + 1 < map.cols; ++col) {
            const std::size_t corner = std::size_t(row) * map.cols + col;
            const std::size_t right = corner + 1, below = corner + map.cols, opposite = below + 1;
            add(corner, below, opposite);  // counterclockwise from above: rows run against y
            add(corner, opposite, right);
        }
    append_sheet(scene, part, vertices, triangles, sides_up);
}

}  // namespace spawnfield

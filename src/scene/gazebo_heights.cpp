#include "scene/gazebo_heights.h"

#include <spawnfield/error.h>

#include <algorithm>

namespace spawnfield {

namespace fs = std::filesystem;

Heightmap gazebo_heights(const fs::path& file, const CollisionGeometry& geometry)
{
    std::vector<std::string> ignored;
    const GreyImage image = read_height_file(file, {}, false, ignored).image;
    if (image.rows < 2 || image.cols < 2) throw FileError(file.string(), "has " + std::to_string(image.cols) + " x " + std::to_string(image.rows) + " pixels, needs at least 2 x 2");
    if (image.largest == 0) throw FileError(file.string(), "has float pixels: a <heightmap> needs an image of 8 or 16 bits; bake the elevation model itself");
    const double brightest = *std::max_element(image.pixels.begin(), image.pixels.end());
    const double scale = brightest > 0 ? geometry.size.z() / brightest : 0;
    const int s = int(geometry.sampling);
    const std::uint64_t wanted = (std::uint64_t(image.rows - 1) * s + 1) * (std::uint64_t(image.cols - 1) * s + 1);
    if (wanted > max_heights) throw FileError(file.string(), "has " + std::to_string(wanted) + " samples with <sampling> " + std::to_string(s) + ", needs at most " + std::to_string(max_heights));
    Heightmap map;
    map.size = {geometry.size.x(), geometry.size.y()};
    map.rows = (image.rows - 1) * s + 1;
    map.cols = (image.cols - 1) * s + 1;
    map.heights.reserve(wanted);
    const auto pixel = [&](int row, int col) { return image.pixels[std::size_t(std::min(row, image.rows - 1)) * image.cols + std::min(col, image.cols - 1)]; };
    for (int row = 0; row < map.rows; ++row)
        for (int col = 0; col < map.cols; ++col) {
            const double v = double(row % s) / s, u = double(col % s) / s;
            const double upper = pixel(row / s, col / s) * (1 - u) + pixel(row / s, col / s + 1) * u;
            const double lower = pixel(row / s + 1, col / s) * (1 - u) + pixel(row / s + 1, col / s + 1) * u;
            map.heights.push_back(scale * (upper * (1 - v) + lower * v));
        }
    return map;
}

}  // namespace spawnfield

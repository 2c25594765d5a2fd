#include "scene/gazebo_heights.h"

#include "base/text.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

std::string size_of(const GreyImage& image) { return std::to_string(image.cols) + " x " + std::to_string(image.rows); }

void check(const GreyImage& image, int sampling, const std::string& file)
{
    if (image.rows < 2 || image.cols < 2)
        throw FileError(file, "has " + size_of(image) + " pixels, needs at least 2 x 2");
    const std::uint64_t wanted = (std::uint64_t(image.rows - 1) * sampling + 1) *
                                 (std::uint64_t(image.cols - 1) * sampling + 1);
    if (wanted > max_heights)
        throw FileError(file, "has " + std::to_string(wanted) + " samples with <sampling> " + std::to_string(sampling) +
                                  ", needs at most " + std::to_string(max_heights));
}

void scale_image(GreyImage& image, double height)
{
    const double brightest = *std::max_element(image.pixels.begin(), image.pixels.end());
    for (auto& pixel : image.pixels) pixel *= brightest > 0 ? height / brightest : 0;
}

void scale_elevations(GreyImage& image, const std::optional<double>& no_data, double height, const std::string& file)
{
    for (auto& pixel : image.pixels)
        if (pixel == no_data) pixel = std::numeric_limits<double>::quiet_NaN();
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double pixel : image.pixels)
        if (!std::isnan(pixel)) low = std::min(low, pixel), high = std::max(high, pixel);
    if (!std::isfinite(low) || !std::isfinite(high))
        throw FileError(file, "has no heights, or heights that are infinite");
    for (auto& pixel : image.pixels) pixel = low + (pixel - low) * (high > low ? height / (high - low) : 1);
}

/// Returns notices about the differences from Gazebo. Gazebo needs square images; it fills up and resamples elevation
/// models to a square whose side is 2^n + 1.
std::vector<std::string> gazebo_differences(const GreyImage& image, bool is_image)
{
    const bool is_square = image.rows == image.cols;
    if (is_image)
        return is_square ? std::vector<std::string>{}
                         : std::vector{"is " + size_of(image) + " pixels large, but Gazebo needs a square image"};
    std::vector<std::string> out{
        "is read as an elevation model, as in Gazebo since Harmonic: its lowest point keeps its height, and its "
        "highest is <size> z above that"};
    if (!is_square || !std::has_single_bit(unsigned(image.rows - 1)))
        out.push_back("is " + size_of(image) +
                      " pixels large; Gazebo resamples it to a square of 2^n + 1, so its heights differ a little from "
                      "those here");
    return out;
}

/// Interpolates from a to b. If share is 0, b is not used, so it may be NaN.
double between(double a, double b, double share) { return share == 0 ? a : a * (1 - share) + b * share; }

}  // namespace

Heightmap gazebo_heights(const fs::path& path, const CollisionGeometry& geometry)
{
    const std::string file = path.string();
    const bool is_image = lower_case(path.extension().string()) == ".png";
    std::vector<std::string> ignored;
    HeightFile from = read_height_file(path, {}, false, ignored);
    GreyImage& image = from.image;
    const int s = int(geometry.sampling);
    check(image, s, file);
    if (is_image)
        scale_image(image, geometry.size.z());
    else
        scale_elevations(image, from.no_data, geometry.size.z(), file);
    Heightmap map;
    map.size = {geometry.size.x(), geometry.size.y()};
    map.rows = (image.rows - 1) * s + 1;
    map.cols = (image.cols - 1) * s + 1;
    map.notices = gazebo_differences(image, is_image);
    map.heights.reserve(std::size_t(map.rows) * std::size_t(map.cols));
    const auto pixel = [&](int row, int col) {
        return image.pixels[std::size_t(std::min(row, image.rows - 1)) * image.cols + std::min(col, image.cols - 1)];
    };
    for (int row = 0; row < map.rows; ++row)
        for (int col = 0; col < map.cols; ++col) {
            const double v = double(row % s) / s, u = double(col % s) / s;
            const double upper = between(pixel(row / s, col / s), pixel(row / s, col / s + 1), u);
            const double lower = between(pixel(row / s + 1, col / s), pixel(row / s + 1, col / s + 1), u);
            map.heights.push_back(between(upper, lower, v));
        }
    return map;
}

}  // namespace spawnfield

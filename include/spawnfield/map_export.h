#pragma once

#include <spawnfield/query.h>

#include <filesystem>
#include <string>
#include <vector>

/// A whole map in files of other programs. What their pixels, frames and colours mean: docs/exports.md.
namespace spawnfield {

/// The verdict on one pose in each cell of a frame.
struct VerdictImage {
    static constexpr std::uint8_t no_pose = 255;

    GridFrame frame;
    std::vector<std::uint8_t> verdicts;  ///< a Verdict or no_pose; row after row, row 0 is the largest y
    VerdictCounts counts{};
    std::uint64_t exact_checks = 0;

    std::uint8_t at(int row, int col) const { return verdicts[std::size_t(row) * std::size_t(frame.cols) + std::size_t(col)]; }
};

/// Asks at the centre of each cell, as a 2D raster does there; no pose where the column has not the chosen layer. Of the
/// options step and bounds are left aside. In strips of rows: a byte for each cell, and little more.
/// Throws ArgumentError as `raster` does, and for LayerChoice All: a cell has one verdict.
VerdictImage verdict_image(const Map& map, const CollisionChecker& checker, const GridFrame& frame, const RasterOptions& options);

/// The image that belongs to a map_server's yaml: of the same name, but .pgm. Throws ArgumentError unless that ends in .yaml or .yml.
std::filesystem::path nav2_image_of(const std::filesystem::path& yaml);

/// The feasible area as map_server of ROS and nav2 reads it: `yaml`, and nav2_image_of(yaml) beside it.
///
/// Free (254) where the verdict is valid, occupied (0) where it is another, unknown (205) where there is no pose or the cell's
/// centre is outside. Pixels are cells; `origin` is the lower left corner of the lower left one. Each line of `comment`
/// is one of the yaml. Both files appear, or none. Throws ArgumentError for the name, OutputError.
/// Source: map_server's documentation of its map format (wiki.ros.org/map_server).
void write_nav2_map(const VerdictImage& image, const std::filesystem::path& yaml, const std::vector<std::string>& comment = {});

}  // namespace spawnfield

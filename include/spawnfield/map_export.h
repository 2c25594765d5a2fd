#pragma once

#include <spawnfield/export.h>
#include <spawnfield/query.h>

#include <filesystem>
#include <string>
#include <vector>

/// A whole map in files of other programs.
namespace spawnfield {

/// The verdict on one pose in each cell of a frame.
struct VerdictImage {
    static constexpr std::uint8_t no_pose = 255;

    GridFrame frame;
    std::vector<std::uint8_t> verdicts;  ///< a Verdict or no_pose; row after row, row 0 is the largest y
    VerdictCounts counts;
    std::uint64_t exact_checks = 0;

    std::uint8_t at(int row, int col) const
    {
        return verdicts[std::size_t(row) * std::size_t(frame.cols) + std::size_t(col)];
    }
};

/// Returns the verdict at the centre of each cell, as a 2D raster gives it; no pose where the column lacks the chosen
/// layer. The options' step and bounds are not used. Works in strips of rows: a byte for each cell, and little more.
/// Throws as raster() does, and ArgumentError for LayerChoice All, because a cell has one verdict.
SPAWNFIELD_API VerdictImage verdict_image(const Judge& judge, const GridFrame& frame, const RasterOptions& options);

/// The image that belongs to a map_server's yaml: of the same name, but .pgm. Throws ArgumentError unless that ends in
/// .yaml or .yml.
SPAWNFIELD_API std::filesystem::path nav2_image_of(const std::filesystem::path& yaml);

/// The feasible area as map_server of ROS and nav2 reads it: `yaml`, and nav2_image_of(yaml) beside it.
///
/// Free (254) where the verdict is valid, occupied (0) where it is another, unknown (205) where there is no pose or the
/// cell's centre is outside. Pixels are cells; `origin` is the lower left corner of the lower left one. Each line of
/// `comment` is one of the yaml. Both files appear, or none. Throws ArgumentError for the name, OutputError. Source:
/// map_server's documentation of its map format (wiki.ros.org/map_server).
SPAWNFIELD_API void write_nav2_map(const VerdictImage& image, const std::filesystem::path& yaml,
                                   const std::vector<std::string>& comment = {});

struct GeoTiffOptions {
    LayerChoice layers = {LayerChoice::Kind::Top, 0};  ///< whose clearance and slope are written: one layer
    ZRange z = {};       ///< layers beyond these heights, m, or beyond the map's z limits are left out
    bool survey = true;  ///< in the survey's coordinates where the map knows them by an EPSG code
    int threads = 0;
    Progress progress = {};
};

/// Bands of float32 over a frame's cells, at their centres; no-data is NaN. In this order, by their descriptions:
///
/// - elevation, elevation_1, …: layers of the column from the top down, m; as many as the highest stack of the frame
/// has
/// - layers: how many the column has; 0 where there is no terrain
/// - clearance: from the chosen layer up to the next solid, m; 0 where something stands on it; no-data under the open
/// sky
/// - slope: of the chosen layer, degrees; by its neighbours' heights, so a layer's edge is steep
/// - water: highest water surface, m
/// - obstacle: highest obstacle that stands above elevation, or where there is no terrain, m
/// - verdict: with `verdicts` (of the same frame) only: the number of the Verdict
///
/// A local metric frame, or the survey's: pixels are areas, upper left corner first, x right, y up. Tiles deflated with
/// predictor 3; BigTIFF where it might pass 4 GB. O(elements + cells), in rows of tiles. Throws ArgumentError for
/// LayerChoice All, OutputError. Sources: OGC GeoTIFF 1.1 (19-008r4); GDAL's GeoTIFF driver for GDAL_METADATA and
/// GDAL_NODATA.
SPAWNFIELD_API void write_geotiff(const Map& map, const GridFrame& frame, const VerdictImage* verdicts,
                                  const GeoTiffOptions& options, const std::filesystem::path& file);

/// A raster's poses as points of a binary little-endian PLY, in their order, given to `sink` in pieces: x, y, z as
/// double (m), red, green, blue of the verdict as in heat maps, and its number as uchar `verdict`. Each line of
/// `comment` is one of the header, and one explains the numbers. Source: Turk, The PLY Polygon File Format, 1994.
SPAWNFIELD_API void write_ply(const RasterResult& raster, const std::vector<std::string>& comment,
                              const std::function<void(std::string_view)>& sink);

/// Poses to be drawn into a GLB.
struct GlbMarkers {
    std::vector<Pose> poses = {};         ///< scene_from_robot
    std::vector<Verdict> verdicts = {};   ///< one for each pose, or none at all
    std::vector<std::string> names = {};  ///< one for each pose, or none at all: "spawn 0", …
    const Robot* robot = nullptr;  ///< drawn with a cone on its top along its x; without it the cone alone, 1 m long
};

/// Writes the scene as binary glTF 2.0, given to `sink` in pieces: y up as glTF wants it, (x, y, z) becomes (x, z, -y),
/// metres.
///
/// A node for each part, of its name; a material for each label and for the verdicts of markers. Their root carries the
/// scene's place in whole metres, so that float32 corners keep their millimetres far from the origin. Round solids
/// become polygons on their surface: of 32 sides, of 16 where there are more than 2000 of them, of 8 beyond 20000.
/// Markers are the children of a node "spawns". About 100 bytes of memory for each triangle. Throws OutputError beyond
/// the 4 GiB that the format can hold, FileError for a damaged map. Source: Khronos, glTF 2.0 specification (ISO/IEC
/// 12113:2022).
SPAWNFIELD_API void write_glb(const Map& map, const GlbMarkers& markers,
                              const std::function<void(std::string_view)>& sink, int threads = 0,
                              const Progress& progress = {});

}  // namespace spawnfield

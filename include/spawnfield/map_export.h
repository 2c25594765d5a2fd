#pragma once

#include <spawnfield/export.h>
#include <spawnfield/query.h>

#include <filesystem>
#include <string>
#include <vector>

/// Functions that write a whole map into files of other programs.
namespace spawnfield {

/// A verdict for each cell of a raster.
struct VerdictImage {
    static constexpr std::uint8_t no_pose = 255;

    GridFrame frame;
    std::vector<std::uint8_t> verdicts;  ///< a Verdict or no_pose; row after row, row 0 is the largest y
    VerdictCounts counts;
    std::uint64_t exact_checks = 0;
    /// For settled robots, those of RasterRest in rad and m, in the order of the verdicts: NaN where the robot has no
    /// settled pose. Empty for level robots.
    std::vector<float> tilt = {}, margin = {};

    /// A quantity of each valid pose, in the order of the verdicts; NaN for other cells.
    struct Measured {
        PlaceQuantity quantity = PlaceQuantity::Clearance;
        std::vector<float> values;
    };
    std::vector<Measured> measured = {};

    std::uint8_t at(int row, int col) const
    {
        return verdicts[std::size_t(row) * std::size_t(frame.cols) + std::size_t(col)];
    }
};

/// Returns the verdict at the centre of each cell, as a 2D raster gives it; no_pose where the column lacks the chosen
/// layer. The options' step and bounds are not used. Judges a few rows at a time, so that memory is little more than a
/// byte for each cell; nine bytes for settled robots, and four more for each of the measures' columns, which become
/// VerdictImage::measured. Throws as raster() and raster_quantity() do, and ArgumentError for LayerChoice All, because
/// a cell has one verdict.
SPAWNFIELD_API VerdictImage verdict_image(const Judge& judge, const GridFrame& frame, const RasterOptions& options,
                                          const PlaceMeasures& measures = {});

/// Returns the name of the image that belongs to the yaml file of a nav2 map: the same name with the ending .pgm.
/// Throws ArgumentError unless `yaml` ends in .yaml or .yml.
SPAWNFIELD_API std::filesystem::path nav2_image_of(const std::filesystem::path& yaml);

/// Writes the area of valid poses for the map_server of ROS and nav2: the file `yaml`, and nav2_image_of(yaml) beside
/// it.
///
/// A pixel is unknown (205) where there is no pose or the verdict is `outside`, free (254) where it is `valid`,
/// occupied (0) where it is any other. A pixel is a cell; `origin` in the yaml is the lower left corner of the raster.
/// Each line of `comment` becomes a comment line of the yaml. Both files appear, or none. Returns notices for the user:
/// old files that could not be removed. Throws ArgumentError for a wrong ending of the name, and OutputError. Source:
/// map_server's documentation of its map format (wiki.ros.org/map_server).
SPAWNFIELD_API std::vector<std::string> write_nav2_map(const VerdictImage& image, const std::filesystem::path& yaml,
                                                       const std::vector<std::string>& comment = {});

struct GeoTiffOptions {
    LayerChoice layers = {LayerChoice::Kind::Top, 0};  ///< the one layer whose free height and slope are written
    ZRange z = {};       ///< layers beyond these heights, m, or beyond the map's z limits are left out
    bool survey = true;  ///< use survey coordinates if the map's origin has an EPSG code
    int threads = 0;
    Progress progress = {};
};

/// Writes a GeoTIFF. Its bands are float32 values at the centres of the frame's cells; no-data is NaN. The bands, in
/// this order, with these descriptions:
///
/// - elevation, elevation_1, …: heights of the layers from the top down, m; as many bands as the column with most
///   layers has layers
/// - layers: number of layers in the column; 0 where there is no terrain
/// - free_height: free height above the chosen layer, m; 0 where something stands on the layer; no-data where nothing
/// is
///   above it
/// - slope: slope of the chosen layer, degrees, from the heights of neighbouring cells; so the edge of a layer is steep
/// - water: highest water surface, m
/// - obstacle: highest obstacle that stands above elevation, or where there is no terrain, m
/// - verdict: number of the Verdict; only if `verdicts` (of the same frame) is given
/// - tilt, margin: of the settled robot, degrees and m; only if `verdicts` has them
/// - those of VerdictImage::measured, with the names and units of the quantities
///
/// The coordinates are the map's own metres or the survey's. A pixel is an area; the first pixel is the upper left one.
/// Tiles are deflated with predictor 3. A file that might exceed 4 GB becomes a BigTIFF. Works on one row of tiles
/// after the other. O(elements + cells). Throws ArgumentError for LayerChoice All, and OutputError. Sources: OGC
/// GeoTIFF 1.1 (19-008r4); GDAL's GeoTIFF driver for GDAL_METADATA and GDAL_NODATA.
SPAWNFIELD_API void write_geotiff(const Map& map, const GridFrame& frame, const VerdictImage* verdicts,
                                  const GeoTiffOptions& options, const std::filesystem::path& file);

/// Writes the poses of a raster, in their order, as points of a binary little-endian PLY. Passes the file to `sink` in
/// pieces. A point has x, y, z as double (m), the verdict's colour in heat maps as red, green, blue, and the verdict's
/// number as uchar `verdict`. Points of settled robots (RasterResult::rests) also have roll, pitch, tilt (rad) and
/// margin (m) as double; tilt and margin are NaN if the robot has no settled pose. Each line of `comment` becomes a
/// comment line of the header; one more line explains the numbers. Source: Turk, The PLY Polygon File Format, 1994.
SPAWNFIELD_API void write_ply(const RasterResult& raster, const std::vector<std::string>& comment,
                              const std::function<void(std::string_view)>& sink);

/// Poses to draw in a GLB file.
struct GlbMarkers {
    std::vector<Pose> poses = {};         ///< scene_from_robot
    std::vector<Verdict> verdicts = {};   ///< one for each pose, or none at all
    std::vector<std::string> names = {};  ///< one for each pose, or none at all: "spawn 0", …
    const Robot* robot = nullptr;  ///< drawn with a cone on top that points along its x; nullptr: only a cone, 1 m long
};

/// Writes the scene as binary glTF 2.0 (GLB), in metres. Passes the file to `sink` in pieces. In glTF y points up, so
/// (x, y, z) becomes (x, z, -y).
///
/// Each part becomes a node with the part's name. Each label, and each verdict of the markers, has a material. The root
/// node has the scene's centre, in whole metres, as its translation, so that float32 corners are exact to millimetres
/// far from the origin. Circles of round primitives become polygons of 32 sides; of 16 sides if there are more than
/// 2000 round primitives, of 8 if there are more than 20000. Markers are the children of a node "spawns". Needs about
/// 100 bytes of memory for each triangle. Throws OutputError for more than the 4 GiB that the format can hold, and
/// FileError for a damaged map. Source: Khronos, glTF 2.0 specification (ISO/IEC 12113:2022).
SPAWNFIELD_API void write_glb(const Map& map, const GlbMarkers& markers,
                              const std::function<void(std::string_view)>& sink, int threads = 0,
                              const Progress& progress = {});

}  // namespace spawnfield

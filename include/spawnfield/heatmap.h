#pragma once

#include <spawnfield/export.h>
#include <spawnfield/picture_format.h>
#include <spawnfield/query.h>

namespace spawnfield {

enum class HeatmapQuantity {
    Verdict,
    Height,
    Slope,
    // These are measured of each pose (HeatmapOptions::values), as in PlaceQuantity:
    Clearance,
    HeadRoom,
    Roughness,
    View,
    Room,  ///< only for settled poses
    // These are about the robot at rest, for rasters of settled poses at one yaw (RasterResult::rests):
    Tilt,
    Roll,
    Pitch,
    Margin,
    Belly,
    Island  ///< HeatmapOptions::islands
};

/// Returns whether a quantity is about the robot at rest.
inline bool is_of_rest(HeatmapQuantity quantity) { return quantity >= HeatmapQuantity::Tilt; }

/// A kind of robot among the spawns of a picture.
struct HeatmapKind {
    std::string name;              ///< in the legend
    const Robot* robot = nullptr;  ///< its outline; nullptr: arrows
};

/// Returns whether a picture of this quantity needs HeatmapOptions::values.
inline bool is_measured(HeatmapQuantity quantity)
{
    return quantity >= HeatmapQuantity::Clearance && quantity <= HeatmapQuantity::Room;
}

struct HeatmapOptions {
    HeatmapQuantity quantity = HeatmapQuantity::Verdict;
    int pixels = 1000;               ///< length of the picture's longer side, 200 .. 16000
    std::vector<Spawn> spawns = {};  ///< drawn as footprints to scale, or as arrows in the direction of their yaw
    std::vector<Verdict> spawn_verdicts = {};   ///< one for each spawn, which sets its colour; or empty
    std::vector<std::string> spawn_names = {};  ///< one for each spawn, written beside it; or empty
    /// If the spawns are of several kinds of robots: the kinds, and the index of its kind for each spawn. Kinds have
    /// the colours of kind_palette, and the eighth has the same colour as all that follow it. Not with spawn_verdicts.
    std::vector<HeatmapKind> kinds = {};
    std::vector<std::size_t> spawn_kinds = {};
    std::vector<Vec3> starts = {}, goals = {};                   ///< of pairs: drawn as discs and as diamonds
    std::vector<std::string> start_names = {}, goal_names = {};  ///< one for each start and goal, or empty
    std::vector<std::vector<Vec3>> paths = {};                   ///< drawn as lines
    std::string title = {};                                      ///< first line of the picture; empty: the map's name
    std::string caption = {};  ///< second line: the robot and settings of the verdicts; may be empty
    /// The robot of the raster. Without a robot, spawns are arrows, and obstacles are those at the height of the
    /// origin.
    const Robot* robot = nullptr;
    int headings = 1;  ///< number of yaws of the raster, 1 .. 255
    /// For each pose of the raster, the number of headings at which it is valid. Empty: its verdict holds at all
    /// headings.
    std::vector<std::uint8_t> valid_headings = {};
    /// For measured quantities: the value of each pose of the raster, as raster_quantity() returns it.
    std::vector<double> values = {};
    /// For HeatmapQuantity::Island: the number of the island of each pose of the raster, as islands_of() returns it
    /// (negative: none), and the area of each island, m2.
    std::vector<std::int32_t> islands = {};
    std::vector<double> island_areas = {};
    std::optional<PictureFormat> format = {};  ///< no value: the ending of the file's name decides
    int threads = 0;                           ///< 0: all cores
};

/// Draws a raster over the hill-shaded relief of the map, with a legend, scale bar, north arrow and axes in metres.
///
/// A column may have several poses (layers, heights). The picture shows it as valid if one of them is valid, and
/// otherwise with the verdict of the topmost pose in the raster's list. A column of a 3D raster without listed poses is
/// aerial. Each pixel shows the nearest column; level ground has exactly the legend's colour. Places with an obstacle
/// at the height of the robot are dark, so the collision colour around them is the margin that the robot's size adds.
/// Obstacles are computed from the geometry, at up to 2000 places along the longer side. The legend counts columns,
/// with the verdict that is shown; its percentages are of the columns with a pose. With several headings, a column is
/// shown as valid at all headings, as valid at some, or with its most frequent verdict.
///
/// Height: z of the pose that is shown. Slope: slope of the layer that is shown, degrees, from the heights of
/// neighbouring terrain cells. Clearance, head room, roughness, view and room: HeatmapOptions::values. Tilt, roll and
/// pitch: degrees; margin and belly clearance: m; as in SettledPose. Quantities are shown where the pose is valid at
/// all headings. Islands: the six largest of those in the picture have a colour each, and the others share one; the
/// number of an island is written where it has most room, if there is room. Pictures narrower than 12:1 get a white
/// margin.
///
/// Spawns are drawn as footprints, each with the outline of its own kind, if these are at least 6 pixels long.
/// Otherwise they are arrows, or dots if arrows would be too close together. Names that would cover each other are left
/// out; the legend contains the number of names that are shown. The colours of verdicts suit all kinds of colour
/// vision. The colours of quantities are viridis (Smith, van der Walt, 2015). O(pixels + columns + poses + terrain
/// cells * layers). Throws ArgumentError unless the options are within their limits, the raster has columns and its
/// poses stand on them. Throws OutputError.
SPAWNFIELD_API void write_heatmap(const Map& map, const TerrainMap& terrain, const RasterResult& raster,
                                  const HeatmapOptions& options, const std::filesystem::path& file);

/// Draws the map from above, hill-shaded, with a title, legend, scale bar, north arrow and axes. The longer side has
/// 1000 pixels.
///
/// Terrain is coloured by height. Obstacles (solid more than 1e-3 m above the top layer) are grey, and higher ones are
/// lighter. Water is blue unless something is higher than the water. If more than a quarter of the ground lies under
/// something (a roof, another floor), there is one small picture for each floor of the map instead, at most 16. It
/// shows the highest layers of this floor, and everything that begins less than 2 m above them. Throws ArgumentError
/// for a map without cells, and OutputError.
SPAWNFIELD_API void write_preview(const Map& map, const TerrainMap& terrain, const std::filesystem::path& file);

}  // namespace spawnfield

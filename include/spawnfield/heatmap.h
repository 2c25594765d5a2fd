#pragma once

#include <spawnfield/export.h>
#include <spawnfield/picture_format.h>
#include <spawnfield/query.h>

namespace spawnfield {

enum class HeatmapQuantity { Verdict, Height, Clearance, Slope };

struct HeatmapOptions {
    HeatmapQuantity quantity = HeatmapQuantity::Verdict;
    int pixels = 1000;                          ///< longer side of the picture, 200 .. 16000
    std::vector<Spawn> spawns = {};             ///< drawn as footprints to scale, or as arrows along their yaw
    std::vector<Verdict> spawn_verdicts = {};   ///< one for each spawn: its colour; or none
    std::vector<std::string> spawn_names = {};  ///< one for each spawn: written beside it; or none
    std::string title = {};                     ///< first line of the picture; empty: the map's name
    std::string caption = {};                   ///< second line: what the verdicts hold for; may be empty
    /// The raster's robot. Without it spawns are arrows, and obstacles are looked for at the height of the origin.
    const Robot* robot = nullptr;
    int headings = 1;  ///< yaws that the raster was made at, 1 .. 255
    /// For each pose of the raster, at how many headings it is valid. Empty: its verdict holds at all of them.
    std::vector<std::uint8_t> valid_headings = {};
    std::optional<PictureFormat> format = {};  ///< none: the file's ending says it
    int threads = 0;                           ///< 0: all cores
};

/// Draws a raster over the hill-shaded relief of the map, with legend, scale bar, north arrow and axes in metres.
///
/// Where a column has several poses (layers, heights) the picture shows it as valid if one of them is, else as the
/// topmost of the listed poses says; a column of a 3D raster without any is aerial. Each pixel shows the nearest
/// column, level ground in just the legend's colour. Obstacles are dark wherever one stands at the height of the robot,
/// so that around them the collision colour is the margin that the robot's size adds; they are drawn from the geometry,
/// at up to 2000 places along the longer side. The legend counts columns, each one as it is shown; shares are of those
/// that have a pose. With several headings a column is valid at all of them, at some, or else shown as the commonest
/// verdict.
///
/// Height: z of the pose that is shown. Clearance: horizontal distance from a valid column to the nearest one that is
/// not, or beyond the raster, m. Slope: of the layer that is shown, degrees, from differences between terrain cells.
/// Quantities are shown where the pose is valid at all headings. Views thinner than 12 : 1 get white room.
///
/// Spawns are footprints where those are at least 6 pixels long, otherwise arrows, or dots where arrows would be
/// crowded. Names that would cover each other are left out, and the legend says how many are shown.
/// Colours of verdicts are for all kinds of colour vision; of quantities: viridis (Smith, van der Walt, 2015) for
/// quantities. O(pixels + columns + poses + terrain cells * layers). Throws ArgumentError unless options are within
/// their limits, the raster has columns and its poses stand on them; OutputError.
SPAWNFIELD_API void write_heatmap(const Map& map, const TerrainMap& terrain, const RasterResult& raster,
                                  const HeatmapOptions& options, const std::filesystem::path& file);

/// Hill-shaded top view of a map with title, legend, scale bar, north arrow and axes, 1000 pixels on its longer side.
///
/// Terrain is coloured by height, obstacles (solid more than 1e-3 m above the top layer) are grey, the higher the
/// lighter, water is blue where nothing stands out of it. If more than a quarter of the ground lies under something (a
/// roof, another floor), there is one small picture for each floor of the map instead, at most 16: its highest layers,
/// and what begins less than 2 m above them. Throws ArgumentError for a map without cells, OutputError.
SPAWNFIELD_API void write_preview(const Map& map, const TerrainMap& terrain, const std::filesystem::path& file);

}  // namespace spawnfield

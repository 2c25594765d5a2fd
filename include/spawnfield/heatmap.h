#pragma once

#include <spawnfield/query.h>

namespace spawnfield {

enum class HeatmapQuantity { Verdict, Height, Clearance, Slope };

struct HeatmapOptions {
    HeatmapQuantity quantity = HeatmapQuantity::Verdict;
    int pixels = 1000;               ///< longer side of the picture, 200 .. 16000
    std::vector<Spawn> spawns = {};  ///< drawn as arrows along their yaw, as dots where they are many
    std::string title = {};          ///< first line of the picture; empty: the map's name
};

/// Draws a raster over the hill-shaded relief of the map, with legend, scale bar, north arrow and axes in metres.
///
/// Where a column has several poses (layers, heights) the picture shows it as valid if one of them is, else as the topmost
/// of the listed poses says; a column of a 3D raster without any is aerial. Each pixel shows the nearest column, level
/// ground in just the legend's colour. Height: z of the pose that is shown. Clearance: horizontal distance from a valid
/// column to the nearest one that is not, or beyond the raster, m. Slope: of the top layer, degrees. Views thinner than
/// 12 : 1 get white room. Colours: Okabe, Ito, Color Universal Design, 2008, for verdicts; viridis (Smith, van der Walt,
/// 2015) for quantities. O(pixels + columns + poses + terrain cells).
/// Throws ArgumentError unless options are within their limits, the raster has columns and its poses stand on them;
/// OutputError.
void write_heatmap(const Map& map, const TerrainMap& terrain, const RasterResult& raster, const HeatmapOptions& options,
                   const std::filesystem::path& file);

/// Hill-shaded top view of a map with title, legend, scale bar, north arrow and axes, 1000 pixels on its longer side.
///
/// Terrain is coloured by height, obstacles (solid more than 1e-3 m above the top layer) are grey, the higher the lighter,
/// water is blue where nothing stands out of it. If more than a quarter of the ground lies under something (a roof, another
/// floor), there is one small picture for each floor of the map instead, at most 16: its highest layers, and what begins less
/// than 2 m above them. Throws ArgumentError for a map without cells, OutputError.
void write_preview(const Map& map, const TerrainMap& terrain, const std::filesystem::path& file);

}  // namespace spawnfield

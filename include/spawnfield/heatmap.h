#pragma once

#include <spawnfield/query.h>

namespace spawnfield {

enum class HeatmapQuantity { Verdict, Height, Clearance, Slope };

struct HeatmapOptions {
    HeatmapQuantity quantity = HeatmapQuantity::Verdict;
    int pixels = 1000;          ///< longer side of the picture, 200 .. 16000
    std::vector<Spawn> spawns;  ///< drawn as arrows along their yaw
    std::string title;          ///< first line of the picture
};

/// Draws a raster over the hill-shaded relief of the map, with legend, scale bar, north arrow and axes in metres.
///
/// Where a column has several poses (layers, heights) the picture shows it as valid if one of them is, else as the topmost
/// says. Clearance: horizontal distance from a valid column to the nearest one that is not, m. Colours: Okabe, Ito, Color
/// Universal Design, 2008, for verdicts; viridis (Smith, van der Walt, 2015) for quantities.
/// Throws ArgumentError, OutputError.
void write_heatmap(const Map& map, const TerrainMap& terrain, const RasterResult& raster, const HeatmapOptions& options,
                   const std::filesystem::path& file);

/// Hill-shaded top view of a map with title, scale bar, north arrow and axes: terrain by height, obstacles grey, water blue.
void write_preview(const TerrainMap& terrain, const std::string& title, const std::filesystem::path& file);

}  // namespace spawnfield

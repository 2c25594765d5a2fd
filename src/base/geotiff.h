#pragma once

#include "base/geo_frame.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace spawnfield {

/// GeoTIFF's and GDAL's tags of a TIFF file's first page as they stand there; empty where it has none.
struct GeoTags {
    std::vector<double> pixel_scale, tiepoints, transformation, doubles;
    std::vector<std::uint16_t> keys;
    std::string ascii, metadata, no_data;
    bool has_mask = false;  ///< a further page tells which pixels count
};
GeoTags read_geo_tags(const std::filesystem::path& file);

/// Whether they say where the pixels lie.
bool is_georeferenced(const GeoTags& tags);

/// From ModelPixelScale and the first ModelTiepoint, or ModelTransformation, and the GeoKeys.
///
/// Pixels that are areas (GTRasterType 1, the default) have their heights at the centres, points (2) at the corners.
/// Adds notices on what is assumed. Their unit is ProjLinearUnitsGeoKey's, else that of the coordinate system by its
/// EPSG code. Throws FileError for degrees, rotation, images that are mirrored, other linear units than metres,
/// kilometres and feet, codes that PROJ does not know. Source: OGC GeoTIFF Standard 1.1 (19-008r4), and GeoTIFF 1.8.2
/// for the keys.
GeoFrame geo_frame(const GeoTags& tags, const std::string& file, std::vector<std::string>& notices);

/// GDAL_NODATA; NaN is one too. Throws FileError if it is no number.
std::optional<double> no_data_value(const GeoTags& tags, const std::string& file);

/// m per unit of the heights, < 0 for depths: the unit type in GDAL's metadata, else that of the vertical system by its
/// EPSG code, else VerticalUnitsGeoKey, else 1. Adds notices where they disagree. Throws FileError for other units, and
/// for heights that are stored with a scale or an offset.
double height_unit(const GeoTags& tags, const std::string& file, std::vector<std::string>& notices);

}  // namespace spawnfield

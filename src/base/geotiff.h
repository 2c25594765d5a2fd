#pragma once

#include "base/geo_frame.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace spawnfield {

/// The GeoTIFF and GDAL tags of the first page of a TIFF file, unchanged. A tag that the file does not have is empty.
struct GeoTags {
    std::vector<double> pixel_scale, tiepoints, transformation, doubles;
    std::vector<std::uint16_t> keys;
    std::string ascii, metadata, no_data;
    bool has_mask = false;  ///< a second page states which pixels are valid
};

/// Reads the tags. Throws FileError if the file is not a TIFF image.
GeoTags read_geo_tags(const std::filesystem::path& file);

/// Returns whether the tags give the place of the pixels.
bool is_georeferenced(const GeoTags& tags);

/// Returns the place of the pixels from ModelPixelScale and the first ModelTiepoint, or from ModelTransformation, and
/// from the GeoKeys.
///
/// If pixels are areas (GTRasterType 1, the default), heights belong to their centres; if they are points (2), to their
/// corners. The unit is that of ProjLinearUnitsGeoKey, or else that of the coordinate system with the file's EPSG code.
/// Adds notices about assumptions. Throws FileError for degrees, for rotated or mirrored images, for linear units other
/// than metres, kilometres and feet, and for EPSG codes that PROJ does not know. Source: OGC GeoTIFF Standard 1.1
/// (19-008r4); GeoTIFF 1.8.2 for the keys.
GeoFrame geo_frame(const GeoTags& tags, const std::string& file, std::vector<std::string>& notices);

/// Returns the value of GDAL_NODATA, which may be NaN; empty if the file does not have the tag. Throws FileError if it
/// is not a number.
std::optional<double> no_data_value(const GeoTags& tags, const std::string& file);

/// Returns metres per unit of the heights, < 0 for depths. The unit comes from the unit type in GDAL's metadata, else
/// from the vertical coordinate system by its EPSG code, else from VerticalUnitsGeoKey, else it is 1. Adds notices if
/// these disagree. Throws FileError for other units, and for heights that are stored with a scale or an offset.
double height_unit(const GeoTags& tags, const std::string& file, std::vector<std::string>& notices);

}  // namespace spawnfield

#pragma once

#include <cstdint>

namespace spawnfield {

/// Tags of TIFF files that GeoTIFF and GDAL add.
enum GeoTag : std::uint32_t {
    model_pixel_scale = 33550,
    model_tiepoint = 33922,
    model_transformation = 34264,
    geo_key_directory = 34735,
    geo_double_params = 34736,
    geo_ascii_params = 34737,
    gdal_metadata = 42112,
    gdal_no_data = 42113,
};

/// Registers the types of these tags with libtiff. open_tiff() calls it.
void register_geo_tags();

}  // namespace spawnfield

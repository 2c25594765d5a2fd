#pragma once

#include <cstdint>

namespace spawnfield {

/// TIFF tags that GeoTIFF and GDAL define.
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

/// Registers the types of these tags with libtiff. Only open_tiff() needs to call it.
void register_geo_tags();

}  // namespace spawnfield

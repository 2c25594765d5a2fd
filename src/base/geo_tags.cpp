#include "base/geo_tags.h"

#include "base/tiff.h"

#include <iterator>

namespace spawnfield {
namespace {

TIFFExtendProc parent_extender = nullptr;

void extend_tags(TIFF* tiff)
{
    static char names[8][20] = {"ModelPixelScale", "ModelTiepoint",  "ModelTransformation", "GeoKeyDirectory",
                                "GeoDoubleParams", "GeoAsciiParams", "GDALMetadata",        "GDALNoData"};
    const auto any = [](std::uint32_t tag, TIFFDataType type, char* name) {
        return TIFFFieldInfo{tag, TIFF_VARIABLE2, TIFF_VARIABLE2, type, FIELD_CUSTOM, 1, 1, name};
    };
    const auto text = [](std::uint32_t tag, char* name) {
        return TIFFFieldInfo{tag, TIFF_VARIABLE, TIFF_VARIABLE, TIFF_ASCII, FIELD_CUSTOM, 1, 0, name};
    };
    static const TIFFFieldInfo fields[] = {any(model_pixel_scale, TIFF_DOUBLE, names[0]),
                                           any(model_tiepoint, TIFF_DOUBLE, names[1]),
                                           any(model_transformation, TIFF_DOUBLE, names[2]),
                                           any(geo_key_directory, TIFF_SHORT, names[3]),
                                           any(geo_double_params, TIFF_DOUBLE, names[4]),
                                           text(geo_ascii_params, names[5]),
                                           text(gdal_metadata, names[6]),
                                           text(gdal_no_data, names[7])};
    libtiff().merge_field_info(tiff, fields, std::uint32_t(std::size(fields)));
    if (parent_extender != nullptr) parent_extender(tiff);
}

}  // namespace

void register_geo_tags() { parent_extender = libtiff().set_tag_extender(extend_tags); }

}  // namespace spawnfield

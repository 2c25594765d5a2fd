#pragma once

#include "base/geo_frame.h"
#include "base/grey_image.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace spawnfield {

/// Pixels without a header, little-endian, row after row from the largest y.
struct RawLayout {
    enum class Type { Uint8, Uint16, Int16, Float32, Float64 } type = Type::Float32;
    int rows = 0, cols = 0;
};

/// An elevation model as its file tells it.
struct HeightFile {
    GreyImage image;
    std::optional<GeoFrame> frame;  ///< where the file tells it, and it was asked for
    std::optional<double> no_data;  ///< pixels of this value have no height; NaN ones never have
    bool is_turned = false;         ///< the file stores largest - pixel; no_data is as it stores it
    double height_unit = 1;         ///< m; < 0: the pixels are depths
};

/// A bake takes about bake_bytes of memory for each height, so that more than max_heights fit into nobody's; from
/// many_heights on it is told.
inline constexpr std::uint64_t max_heights = 1 << 26, many_heights = 1 << 23, bake_bytes = 650;

/// PNG (grey, 8 or 16 bits), TIFF and GeoTIFF, ESRI ASCII grid, or what `raw` tells. Without `wants_frame` nobody looks
/// at where it lies, so that degrees and the like do no harm. Adds to notices what is assumed. Throws FileError.
HeightFile read_height_file(const std::filesystem::path& file, const std::optional<RawLayout>& raw, bool wants_frame,
                            std::vector<std::string>& notices);

}  // namespace spawnfield

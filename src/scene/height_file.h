#pragma once

#include "base/geo_frame.h"
#include "base/grey_image.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace spawnfield {

/// Layout of a file of pixels without a header: little-endian, row after row, the first row at the largest y.
struct RawLayout {
    enum class Type { Uint8, Uint16, Int16, Float32, Float64 } type = Type::Float32;
    int rows = 0, cols = 0;
};

/// The content of an elevation model's file.
struct HeightFile {
    GreyImage image;
    std::optional<GeoFrame> frame;  ///< set if the file states it and the caller wants it
    std::optional<double> no_data;  ///< pixels of this value have no height; NaN ones never have
    bool is_inverted = false;       ///< `image` has largest - (the file's pixel); `no_data` is a value of the file
    double height_unit = 1;         ///< m per unit of a pixel; < 0: the pixels are depths
};

/// A bake needs about bake_bytes of memory per height. Above max_heights no usual computer has enough; above
/// many_heights there is a notice.
inline constexpr std::uint64_t max_heights = 1 << 26, many_heights = 1 << 23, bake_bytes = 650;

/// Reads PNG (grey, 8 or 16 bits), TIFF and GeoTIFF, an ESRI ASCII grid, or a file with the layout `raw`. Without
/// `wants_frame` the place of the pixels is not read, so coordinates in degrees are accepted. Adds notices about
/// assumptions. Throws FileError.
HeightFile read_height_file(const std::filesystem::path& file, const std::optional<RawLayout>& raw, bool wants_frame,
                            std::vector<std::string>& notices);

}  // namespace spawnfield

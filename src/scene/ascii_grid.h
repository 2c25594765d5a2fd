#pragma once

#include "base/geo_frame.h"
#include "base/grey_image.h"

#include <string_view>

namespace spawnfield {

/// An elevation model in a text file; heights are the numbers as they stand there.
struct AsciiGrid {
    GreyImage image;
    GeoFrame frame;
    double no_data = -9999;
};

bool is_ascii_grid(std::string_view start);  ///< its first word is one of a grid's header

/// ESRI's ASCII grid: header words in any case and order, then rows from the north, values between white space.
///
/// xllcorner is the edge of the outermost cell, xllcenter its centre; dx and dy may stand for cellsize. Throws
/// FileError with line numbers; for more than `most` cells before anything of them is read.
AsciiGrid parse_ascii_grid(std::string_view text, const std::string& file, std::uint64_t most);

}  // namespace spawnfield

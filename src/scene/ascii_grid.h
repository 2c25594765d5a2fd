#pragma once

#include "base/geo_frame.h"
#include "base/grey_image.h"

#include <string_view>

namespace spawnfield {

/// An elevation model from a text file. The pixels are the heights as numbers of the file.
struct AsciiGrid {
    GreyImage image;
    GeoFrame frame;
    double no_data = -9999;
};

/// Returns whether the first word of the file is a key of a grid's header.
bool is_ascii_grid(std::string_view start);

/// Reads an ESRI ASCII grid: header keys in any case and order, then the values, row after row, the northern one first,
/// separated by white space.
/// xllcorner is the outer edge of the first cell, xllcenter its centre; dx and dy may replace cellsize. Throws
/// FileError with the line; a grid of more than `most` cells is refused before its values are read.
AsciiGrid parse_ascii_grid(std::string_view text, const std::string& file, std::uint64_t most);

}  // namespace spawnfield

#pragma once

#include <string>

namespace spawnfield {

/// Place of an elevation model's pixels in survey coordinates. Row 0 has the largest y.
struct GeoFrame {
    double x = 0, y = 0;        ///< centre of the upper left pixel, in units
    double dx = 1, dy = 1;      ///< distance between neighbouring centres, in units, > 0
    double unit = 1;            ///< m per unit
    bool is_projected = false;  ///< the file states that x and y are not degrees
    std::string crs;            ///< "EPSG:32611", or the name that the file gives; empty: unknown
};

}  // namespace spawnfield

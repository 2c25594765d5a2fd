#pragma once

#include <string>

namespace spawnfield {

/// Where the pixels of an elevation model lie in the coordinates of its survey; row 0 is the largest y.
struct GeoFrame {
    double x = 0, y = 0;        ///< of the upper left pixel's centre, in units
    double dx = 1, dy = 1;      ///< between neighbouring centres, in units, > 0
    double unit = 1;            ///< m
    bool is_projected = false;  ///< the file says that these are no degrees
    std::string crs;            ///< "EPSG:32611", or the file's own words; empty: it does not tell
};

}  // namespace spawnfield

#pragma once

#include <spawnfield/export.h>
#include <spawnfield/types.h>

#include <string>
#include <vector>

namespace spawnfield {

/// A closed set in the map's x-y plane, m: the union of some polygons, at the heights of a range.
///
/// A point is in a polygon if it is inside an odd number of its rings, or within 1e-9 m of a ring. So holes are rings
/// too. If a ring crosses itself, parts that it encloses twice are outside.
struct Region {
    using Ring = std::vector<Eigen::Vector2d>;  ///< at least 3 corners, finite; the first one is not repeated;
                                                ///< clockwise or counterclockwise
    using Polygon = std::vector<Ring>;
    std::string name;  ///< for the user: the file from which it comes
    std::vector<Polygon> polygons;
    /// Heights of the region, m. They apply to layers if poses stand on layers (sample, 2D rasters), and to the robot's
    /// origin in `search`.
    ZRange z = {};
    std::vector<std::string> notices = {};  ///< assumptions that were made while reading

    SPAWNFIELD_API Bounds bounds() const;  ///< of all polygons, with the heights of z
};

/// The places at which poses are wanted.
struct Area {
    std::vector<Region> within = {};    ///< poses are in at least one of these; empty: everywhere
    std::vector<Region> keep_out = {};  ///< poses are in none of these

    bool is_everywhere() const { return within.empty() && keep_out.empty(); }
    SPAWNFIELD_API Bounds bounds() const;  ///< of `within`; infinite if `within` is empty
};

SPAWNFIELD_API Region box_region(double x0, double y0, double x1, double y1, const ZRange& z = {});

}  // namespace spawnfield

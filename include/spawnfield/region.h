#pragma once

#include <spawnfield/export.h>
#include <spawnfield/types.h>

#include <string>
#include <vector>

namespace spawnfield {

/// A closed set of the map's x-y plane, m: what lies in any of some polygons, at the heights of a range.
///
/// A point is in a polygon if it is inside an odd number of its rings (so holes are rings too, and a ring that crosses
/// itself has its doubly wound part outside), or within 1e-9 m of a ring.
struct Region {
    using Ring = std::vector<Eigen::Vector2d>;  ///< 3 corners or more, the first one once; finite; either way round
    using Polygon = std::vector<Ring>;
    std::string name;  ///< in words for the user: its file
    std::vector<Polygon> polygons;
    /// Heights of the region, m: of layers where poses stand on layers (sample, 2D rasters), of the robot's origin in
    /// `search`.
    ZRange z = {};
    std::vector<std::string> notices = {};  ///< what was assumed while reading

    SPAWNFIELD_API Bounds bounds() const;  ///< of the rings, and of z
};

/// Where poses are wanted.
struct Area {
    std::vector<Region> within = {};    ///< in any of these; none: everywhere
    std::vector<Region> keep_out = {};  ///< in none of these

    bool is_everywhere() const { return within.empty() && keep_out.empty(); }
    SPAWNFIELD_API Bounds bounds() const;  ///< of `within`; infinite if that is everywhere
};

SPAWNFIELD_API Region box_region(double x0, double y0, double x1, double y1, const ZRange& z = {});

}  // namespace spawnfield

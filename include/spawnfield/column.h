#pragma once

#include <spawnfield/export.h>
#include <spawnfield/geometry.h>

namespace spawnfield {

/// One piece's interval on a vertical line; a sheet's has no length.
struct Span {
    double bottom = 0, top = 0;
    std::uint32_t part = 0;
    bool terrain = false;  ///< a robot may stand on its top
    bool sealed = true;    ///< false: of a mesh with holes that is solid by wish, so its inside is a guess
};

/// What stands on the vertical line through (x, y).
struct Column {
    std::vector<Span> spans;     ///< every single piece's, terrain and obstacle, highest top first; not joined
    std::vector<double> layers;  ///< upper ends of joined terrain, from the top down
    std::vector<double> water;   ///< water surfaces, from the top down
};

/// Layers closer than this are one, and intervals closer than this are joined, m.
inline constexpr double layer_tolerance = 1e-6;

/// Exact intervals along the vertical line through (x, y).
///
/// A filled mesh counts as inside between odd and even crossings (crossing number with one decision per edge, so a line
/// through an edge or corner is counted once); lines along its surface count too. Sheets: triangles seen edge-on give
/// nothing. Source: Haines, Point in Polygon Strategies, Graphics Gems IV, 1994 (crossings test).
SPAWNFIELD_API Column column_at(const Geometry& geometry, double x, double y);

struct Ground {
    double height = 0;
    bool terrain = false;
    std::uint32_t part = 0;
};

/// The highest upper end of a single span at or below z; within touch_tolerance terrain wins.
SPAWNFIELD_API std::optional<Ground> ground_below(const Column& column, double z);

}  // namespace spawnfield

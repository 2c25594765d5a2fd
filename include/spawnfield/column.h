#pragma once

#include <spawnfield/export.h>
#include <spawnfield/geometry.h>

namespace spawnfield {

/// The interval in which a vertical line runs through one piece. For a sheet, bottom and top are equal.
struct Span {
    double bottom = 0, top = 0;
    bool terrain = false;  ///< a robot may stand on its top
    /// False: the piece is a mesh with holes that the user asked to fill, so its inside is a guess.
    bool sealed = true;
    std::uint32_t part = 0;  // last, so that no padding follows: copies of a whole Span are faster

    bool operator==(const Span&) const = default;
};

/// What stands on the vertical line through (x, y).
struct Column {
    std::vector<Span> spans;     ///< one for each piece, terrain and obstacles, not joined; the highest top first
    std::vector<double> layers;  ///< upper ends of joined terrain, from the top down
    std::vector<double> water;   ///< water surfaces, from the top down

    bool operator==(const Column&) const = default;
};

/// Layers closer than this are one, and intervals closer than this are joined, m.
inline constexpr double layer_tolerance = 1e-6;

/// Returns the exact intervals along the vertical line through (x, y).
///
/// In a filled mesh, the line is inside after an odd number of crossings and outside after an even number. Each edge
/// belongs to one triangle only, so a line through an edge or a corner is counted once. A line along the surface also
/// counts. A vertical triangle of a sheet gives no interval. Source: Haines, Point in Polygon Strategies, Graphics Gems
/// IV, 1994 (crossings test).
SPAWNFIELD_API Column column_at(const Geometry& geometry, double x, double y);

struct Ground {
    double height = 0;
    bool terrain = false;
    std::uint32_t part = 0;
};

/// Returns the highest upper end of a single span at or below z. If terrain and an obstacle are equally high (to
/// touch_tolerance), returns the terrain.
SPAWNFIELD_API std::optional<Ground> ground_below(const Column& column, double z);

}  // namespace spawnfield

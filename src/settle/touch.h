#pragma once

#include "settle/convex.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace spawnfield {

/// A way in which a body touches the ground when it is lowered: the body at `height` touches it at this place.
struct Touch {
    double height;  ///< how much the body must be raised, m; negative: lowered
    Vec3 body;      ///< the point of the body, before it is raised
    Vec3 slope;     ///< direction from the ground to the body, perpendicular to the touching surfaces; z is 1
};

/// Touches that may be left out.
struct WantedTouches {
    double least = -std::numeric_limits<double>::infinity();  ///< height, m; lower touches may be left out
    /// Bit k: touches of this edge or corner of the ground may be left out.
    std::uint8_t covered_edges = 0, covered_points = 0;

    bool has_edge(std::size_t k) const { return k >= 8 || (covered_edges >> k & 1) == 0; }
    bool has_point(std::size_t k) const { return k >= 8 || (covered_points >> k & 1) == 0; }
};

/// Adds the ways in which a body, moved along z only, touches the ground from above. The highest of them is where it
/// comes to lie on the ground; there, the ground's highest point is below the body's lowest point in every vertical
/// line. The others are below it, and may become the highest one when the body is turned a little. Adds nothing if body
/// and ground do not overlap seen from above. It takes less time if only some touches are wanted.
void add_touches(const Convex& body, const Convex& ground, std::vector<Touch>& out, const WantedTouches& wanted = {});

/// Returns the highest of these touches for any two bodies, by a general method that takes longer.
std::optional<Touch> highest_touch(const Convex& body, const Convex& ground);

/// Returns the heights between which the body must not be, because it would touch the solid. Returns nothing if they do
/// not overlap seen from above.
std::optional<Interval> blocked_heights(const Convex& body, const Convex& solid);

}  // namespace spawnfield

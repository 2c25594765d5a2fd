#pragma once

#include <spawnfield/types.h>

#include <optional>

namespace spawnfield {

enum class ShapeKind : std::uint8_t { Box, Sphere, Cylinder, Capsule, Hull };

/// A convex solid at a place. Cylinders and capsules lie along their own z, all are centred on their own origin.
struct Shape {
    ShapeKind kind = ShapeKind::Box;
    Vec3 size =
        Vec3::Zero();  ///< box: side lengths; sphere: radius, -, -; cylinder, capsule: radius, straight length, -
    Pose pose;         ///< parent_from_shape
};

/// Vertical interval of a solid, m.
struct Interval {
    double bottom, top;
};

/// Where the vertical line through (x, y) runs through the shape, surface included (to touch_tolerance);
/// nothing where it passes by. Not for hulls.
std::optional<Interval> vertical_interval(const Shape& shape, double x, double y);

/// Smallest axis-aligned box in the parent's frame. Not for hulls.
Bounds bounds_of(const Shape& shape);

/// Lines and points this close to a surface lie on it, m: rounding of coordinates up to 10 km stays below it.
inline constexpr double touch_tolerance = 1e-9;

/// Solids that are this close to each other touch, m: the measured tolerance of libccd for exact contact.
inline constexpr double touch_margin = 1e-6;

}  // namespace spawnfield

#pragma once

#include <spawnfield/export.h>
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

/// Shapes by their sizes (m, > 0) at a place: box_shape({1, 1, 2}, {{3, 0, 1}}) is a box around (3, 0, 1).
inline Shape box_shape(const Vec3& size, const Pose& pose = {}) { return {ShapeKind::Box, size, pose}; }
inline Shape sphere_shape(double radius, const Vec3& centre) { return {ShapeKind::Sphere, {radius, 0, 0}, {centre}}; }
inline Shape cylinder_shape(double radius, double length, const Pose& pose = {})
{
    return {ShapeKind::Cylinder, {radius, length, 0}, pose};
}
inline Shape capsule_shape(double radius, double straight_length, const Pose& pose = {})
{
    return {ShapeKind::Capsule, {radius, straight_length, 0}, pose};
}

/// Returns whether the sizes that the shape's kind uses are > 0 m, and they and its pose are finite. Not for hulls.
SPAWNFIELD_API bool has_extent(const Shape& shape);

SPAWNFIELD_API const char* to_string(ShapeKind kind);  ///< as in scene.yaml: "box", …

/// Vertical interval of a solid, m.
struct Interval {
    double bottom, top;
};

/// Where the vertical line through (x, y) runs through the shape, surface included (to touch_tolerance);
/// nothing where it passes by. Not for hulls.
SPAWNFIELD_API std::optional<Interval> vertical_interval(const Shape& shape, double x, double y);

/// Smallest axis-aligned box in the parent's frame. Not for hulls.
SPAWNFIELD_API Bounds bounds_of(const Shape& shape);

/// Lines and points this close to a surface lie on it, m: rounding of coordinates up to 10 km stays below it.
inline constexpr double touch_tolerance = 1e-9;

/// Solids that are this close to each other touch, m: the measured tolerance of libccd for exact contact.
inline constexpr double touch_margin = 1e-6;

}  // namespace spawnfield

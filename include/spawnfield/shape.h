#pragma once

#include <spawnfield/export.h>
#include <spawnfield/types.h>

#include <optional>

namespace spawnfield {

enum class ShapeKind : std::uint8_t { Box, Sphere, Cylinder, Capsule, Hull };

/// A convex solid at a place. The axis of a cylinder or capsule is its own z. The origin of each shape is its centre.
struct Shape {
    ShapeKind kind = ShapeKind::Box;
    /// Box: side lengths; sphere: radius, -, -; cylinder, capsule: radius, straight length, -.
    Vec3 size = Vec3::Zero();
    Pose pose;  ///< parent_from_shape
};

/// These functions make shapes from sizes (m, > 0) and a place: box_shape({1, 1, 2}, {{3, 0, 1}}) is a box around (3,
/// 0, 1).
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

/// Returns whether the sizes that the kind of shape uses are > 0 m, and all sizes and the pose are finite. Not for
/// hulls.
SPAWNFIELD_API bool has_extent(const Shape& shape);

SPAWNFIELD_API const char* to_string(ShapeKind kind);  ///< as in scene.yaml: "box", …

/// The interval of heights in which a vertical line runs through a solid, m.
struct Interval {
    double bottom, top;

    bool operator==(const Interval&) const = default;
};

/// Returns the interval in which the vertical line through (x, y) runs through the shape, including its surface (to
/// touch_tolerance). Returns nothing if the line does not meet the shape. Not for hulls.
SPAWNFIELD_API std::optional<Interval> vertical_interval(const Shape& shape, double x, double y);

/// Returns the smallest axis-aligned box around the shape, in the parent's frame. Not for hulls.
SPAWNFIELD_API Bounds bounds_of(const Shape& shape);

/// A line or a point that is this close to a surface lies on it, m. Rounding of coordinates up to 10 km is smaller.
inline constexpr double touch_tolerance = 1e-9;

/// Solids that are this close to each other touch, m. This is the measured tolerance of libccd for contacts.
inline constexpr double touch_margin = 1e-6;

}  // namespace spawnfield

#pragma once

#include <spawnfield/robot.h>

#include <Eigen/Geometry>

#include <memory>

namespace octomap {
class OcTree;
}

/// The interface of the module src/narrow_phase: a shared library that contains all code that uses FCL, and that is
/// loaded when the first CollisionChecker is made. FCL has 29,000 symbols, whose relocation takes a third of the time
/// in which a program starts.
namespace spawnfield::narrow_phase_module {

/// The position and the rotation of a body in some frame, m.
using Transform = Eigen::Isometry3d;

/// An object of FCL: a convex part of a robot, or an octree.
class Body {
public:
    virtual ~Body() = default;
};

/// Returns the body of a robot's part, in the shape's own frame; for a hull, in the robot's frame.
std::unique_ptr<const Body> make_part(const RobotPart& part);
std::unique_ptr<const Body> make_octree(std::shared_ptr<const octomap::OcTree> tree);

// Each of these returns whether FCL finds a collision. All coordinates must be relative to a common frame, near whose
// origin the part lies, so that they are small and precise.
bool meets_triangle(const Body& part, const Transform& frame_from_part, const std::array<Vec3, 3>& corners);
bool meets_shape(const Body& part, const Transform& frame_from_part, const Shape& shape,
                 const Transform& frame_from_shape);
bool meets_octree(const Body& part, const Transform& frame_from_part, const Body& octree,
                  const Transform& frame_from_octree);

/// A convex body by the points that are farthest in each direction.
class SupportMap {
public:
    virtual ~SupportMap() = default;
    /// Returns a point of the body that is farthest in this direction (not 0).
    virtual Vec3 support(const Vec3& direction) const = 0;
};

/// Returns whether two convex bodies have a common point (Gilbert, Johnson, Keerthi, A fast procedure for computing the
/// distance between complex objects, 1988; libccd). Use it for bodies that FCL has no shape for.
bool bodies_meet(const SupportMap& a, const SupportMap& b);

/// The functions that the module exports.
struct Functions {
    static constexpr const char *module = "narrow_phase", *failure = "collisions cannot be checked";
    decltype(&narrow_phase_module::make_part) make_part;
    decltype(&narrow_phase_module::make_octree) make_octree;
    decltype(&narrow_phase_module::meets_triangle) meets_triangle;
    decltype(&narrow_phase_module::meets_shape) meets_shape;
    decltype(&narrow_phase_module::meets_octree) meets_octree;
    decltype(&narrow_phase_module::bodies_meet) bodies_meet;
};

}  // namespace spawnfield::narrow_phase_module

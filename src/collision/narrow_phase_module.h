#pragma once

#include <spawnfield/robot.h>

#include <Eigen/Geometry>

#include <memory>

namespace octomap {
class OcTree;
}

/// The interface of the module src/narrow_phase: a shared library that contains all code that uses FCL, and that is
/// loaded for the first CollisionChecker. FCL has 29,000 symbols, whose relocation takes a third of the time in which a
/// program starts.
namespace spawnfield::narrow_phase_module {

/// The position and the rotation of a body in some frame, m.
using Transform = Eigen::Isometry3d;

/// Something as FCL sees it: a convex part of a robot or an octree.
class Body {
public:
    virtual ~Body() = default;
};

/// Makes a body of a part's shape, in the shape's own frame; of a hull, in the robot's frame.
std::unique_ptr<const Body> make_part(const RobotPart& part);
std::unique_ptr<const Body> make_octree(std::shared_ptr<const octomap::OcTree> tree);

// Each of these returns whether FCL finds a collision. All coordinates must be relative to a common frame, near whose
// origin the part lies, so that they are small and precise.
bool meets_triangle(const Body& part, const Transform& frame_from_part, const std::array<Vec3, 3>& corners);
bool meets_shape(const Body& part, const Transform& frame_from_part, const Shape& shape,
                 const Transform& frame_from_shape);
bool meets_octree(const Body& part, const Transform& frame_from_part, const Body& octree,
                  const Transform& frame_from_octree);

/// The functions that the module exports.
struct Functions {
    static constexpr const char *module = "narrow_phase", *failure = "collisions cannot be checked";
    decltype(&make_part) part;
    decltype(&make_octree) octree;
    decltype(&meets_triangle) triangle;
    decltype(&meets_shape) shape;
    decltype(&meets_octree) in_octree;
};

}  // namespace spawnfield::narrow_phase_module

#pragma once

#include <spawnfield/geometry.h>
#include <spawnfield/shape.h>

#include <array>
#include <optional>
#include <vector>

namespace spawnfield {

/// The inside of a primitive, or of all filled mesh pieces of a part.
struct Solid3 {
    std::uint32_t part = 0;
    Bounds bounds;                               ///< m
    std::optional<Shape> shape = {};             ///< nothing: a mesh
    std::vector<std::array<Vec3, 3>> triangles;  ///< of a mesh
};

/// How deep two solids overlap: the diameter of a sphere that fits into both.
struct SharedDepth {
    enum class Proof {
        Less,      ///< no sphere of the asked diameter fits
        Exact,     ///< the largest sphere has this diameter, to 1e-6 m
        AtLeast,   ///< a sphere of this diameter fits; a larger one may fit, too
        Undecided  ///< not found within the effort
    } proof = Proof::Less;
    double depth = 0;           ///< m; Undecided: of the largest sphere that was found
    Vec3 place = Vec3::Zero();  ///< AtLeast: the centre of the sphere; Exact: the middle of the common bounding box
};

/// Returns how deep two solids overlap, if it is more than `least` (m, > 0).
///
/// Two primitives: a sphere of radius r fits into a primitive exactly if its centre is in the primitive that is smaller
/// by r on all sides. So the largest r is found by bisection with the distance of the smaller ones. Others: branch and
/// bound over boxes. The depth of a point below a solid's surface changes by at most the way that the point moves, so
/// a box whose middle is not deep enough for its size has no such sphere.
SharedDepth shared_depth(const Geometry& geometry, const Solid3& a, const Solid3& b, double least);

}  // namespace spawnfield

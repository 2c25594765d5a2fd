#pragma once

#include <spawnfield/types.h>

#include <vector>

namespace spawnfield {

/// A closed triangle mesh.
struct SphereMesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;  ///< counterclockwise from outside
};

/// Returns a polyhedron around the unit sphere: an icosahedron whose faces are divided into four `rounds` times, then
/// scaled up until no face cuts the sphere. It has 20 * 4^rounds triangles, and all vertices have the same distance
/// from the centre.
SphereMesh mesh_around_unit_sphere(int rounds);

}  // namespace spawnfield

#pragma once

#include <spawnfield/types.h>

#include <vector>

namespace spawnfield {

/// A closed triangle mesh.
struct SphereMesh {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;  ///< counterclockwise from outside
};

/// A polyhedron around the unit sphere: the icosahedron, each of its faces cut in four `rounds` times, moved out until
/// no face cuts the sphere. 20 * 4^rounds triangles; all vertices lie equally far from the centre.
SphereMesh mesh_around_unit_sphere(int rounds);

}  // namespace spawnfield

#pragma once

#include "mesh/mesh_file.h"

namespace spawnfield {

using Outline = std::vector<std::array<double, 2>>;

/// Returns closed meshes of the space that an odd number of the outlines enclose, from z = 0 to `height`. Each outer
/// outline is one node, with the holes in it. This is how Gazebo extrudes <polyline> (gazebo::common::GTSMeshUtils). A
/// last point that repeats the first is ignored. O(n^2) for n points. Throws std::domain_error with the reason unless
/// each outline has at least three points, encloses an area, and crosses neither itself nor another.
FileMesh extruded(const std::vector<Outline>& outlines, double height);

}  // namespace spawnfield

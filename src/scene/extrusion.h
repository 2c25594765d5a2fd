#pragma once

#include "mesh/mesh_file.h"

namespace spawnfield {

using Outline = std::vector<std::array<double, 2>>;

/// What lies within an odd number of the outlines, from z = 0 up to `height`: closed meshes, one node for each outer
/// outline with the holes in it. As Gazebo extrudes <polyline> (gazebo::common::GTSMeshUtils); a last point that
/// repeats the first is left out. O(n^2) of the points. Throws std::domain_error, which says why, unless each outline
/// has three points or more, encloses an area, and neither crosses itself nor another.
FileMesh extruded(const std::vector<Outline>& outlines, double height);

}  // namespace spawnfield

#pragma once

#include <spawnfield/robot.h>

namespace spawnfield {

using Corners = std::array<Vec3, 3>;

/// Connected triangles.
using SurfacePiece = std::vector<Corners>;

/// Convex hulls, at most `most`, whose union holds all triangles, and all that closed pieces of them enclose.
///
/// Planes across the axes cut the pieces; what lies in each box between the planes gets its own hull: that of the
/// triangles' parts in it and of those of its corners that lie inside a piece. All else of a solid in a box is between
/// these: the ends of its cuts with the box's faces and edges lie on its surface or are corners. Cuts go where the
/// volume falls most, and end where nothing is gained. Throws std::domain_error if the first hull has no volume. Source
/// of the idea: Wei, Liu, Ling, Su, Approximate Convex Decomposition for 3D Meshes with Collision-Aware Concavity and
/// Tree Search, 2022 (planes that cut the mesh itself); the search here is greedy. O(parts * triangles * cuts tried).
std::vector<RobotPart> convex_split(const std::vector<SurfacePiece>& pieces, int most);

/// m3, of a Hull.
double hull_volume(const RobotPart& hull);

}  // namespace spawnfield

#pragma once

#include <spawnfield/robot.h>

namespace spawnfield {

using Corners = std::array<Vec3, 3>;

/// The triangles of one connected piece.
using SurfacePiece = std::vector<Corners>;

/// Returns at most `most` convex hulls whose union contains all triangles and everything that closed pieces enclose.
///
/// Planes perpendicular to the axes cut the pieces into boxes. Each box gets its own hull: that of the parts of
/// triangles in the box, and of the corners of the box that lie inside a piece. These points are enough: a line in the
/// box leaves a solid on the solid's surface or on a face of the box, a line in a face leaves it on the surface or on
/// an edge, and an edge leaves it on the surface or at a corner. The search is greedy: it cuts where the volume falls
/// most, and stops when nothing is gained. Throws std::domain_error if the hull of all pieces has no volume. O(parts *
/// triangles * cuts tried). Source of the idea: Wei, Liu, Ling, Su, Approximate Convex Decomposition for 3D Meshes with
/// Collision-Aware Concavity and Tree Search, 2022 (planes that cut the mesh itself).
std::vector<RobotPart> convex_split(const std::vector<SurfacePiece>& pieces, int most);

/// Returns the volume of a part of kind Hull, m3.
double hull_volume(const RobotPart& hull);

}  // namespace spawnfield

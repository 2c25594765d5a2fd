#pragma once

#include "mesh/mesh_file.h"

#include <spawnfield/robot.h>

#include <string>

namespace spawnfield {

/// A mesh that is used for collisions.
struct CollisionMesh {
    std::string name;  ///< of its link, or of its part in robot.yaml
    std::filesystem::path file;
    std::vector<FileMesh::Node> nodes;  ///< vertices in the robot's frame
};

/// Returns the nodes with their vertices scaled in the mesh's own frame and then moved to the robot's frame.
std::vector<FileMesh::Node> placed(std::vector<FileMesh::Node> nodes, const Vec3& scale, const Pose& robot_from_mesh);

/// Adds a mesh to the robot: its convex hull, or up to `most` convex parts whose union contains the mesh. Also adds a
/// MeshFit with their volume. Throws std::domain_error if the hull has no volume.
void append_mesh(Robot& robot, const CollisionMesh& mesh, int most);

/// Returns a notice for each mesh whose hulls are at least 5 % larger than the mesh, or whose own volume is unknown.
std::vector<std::string> growth_notices(const Robot& robot);

/// Returns the volume that the nodes enclose, m3. Returns nothing if a piece is not closed (each of its edges must have
/// two faces that run along it in opposite directions), if the bounding boxes of two pieces overlap, or if there are
/// more than 2000 pieces.
std::optional<double> enclosed_volume(const std::vector<FileMesh::Node>& nodes);

}  // namespace spawnfield

#pragma once

#include "mesh/mesh_file.h"

#include <spawnfield/robot.h>

#include <string>

namespace spawnfield {

/// A mesh collision.
struct CollisionMesh {
    std::string name;  ///< of its link
    std::filesystem::path file;
    std::vector<FileMesh::Node> nodes;  ///< vertices in the robot's frame
};

/// The nodes with their vertices scaled in their own frame, then placed.
std::vector<FileMesh::Node> placed(std::vector<FileMesh::Node> nodes, const Vec3& scale, const Pose& robot_from_mesh);

/// Appends the mesh's convex hull to the robot, or up to `most` convex parts that hold all of it, and how well they
/// fit. Throws std::domain_error if the hull has no volume.
void append_mesh(Robot& robot, const CollisionMesh& mesh, int most);

/// A line about each mesh whose hulls are clearly larger, or who knows by how much.
std::vector<std::string> growth_notices(const Robot& robot);

/// m3; nothing unless each edge of each piece has two faces that run along it in opposite directions, and the pieces'
/// boxes lie apart.
std::optional<double> enclosed_volume(const std::vector<FileMesh::Node>& nodes);

}  // namespace spawnfield

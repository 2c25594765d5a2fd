#include "robot/mesh_parts.h"

#include "mesh/face_pieces.h"
#include "robot/convex_split.h"
#include "robot/hull.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace spawnfield {
namespace {

/// Returns whether each directed edge occurs exactly once and its opposite occurs too. Then the pieces are closed, and
/// all faces of a piece have the same orientation.
bool is_oriented(const std::vector<Triangle>& triangles)
{
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
    std::sort(edges.begin(), edges.end());
    if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        return std::binary_search(edges.begin(), edges.end(), std::pair(edge.second, edge.first));
    });
}

/// A closed piece of a mesh.
struct Piece3 {
    double volume = 0;  ///< m3; negative if the faces look inwards
    Bounds bounds;
};

/// Returns the pieces of a node; nothing if one of them is not closed.
std::optional<std::vector<Piece3>> closed_pieces(const FileMesh::Node& node)
{
    if (!is_oriented(node.triangles)) return std::nullopt;
    const FacePieces found = find_pieces(node.triangles);
    std::vector<Piece3> out(found.open_edges.size());
    const Vec3 reference = node.vertices.empty() ? Vec3(Vec3::Zero()) : node.vertices[0];
    for (std::size_t face = 0; face < node.triangles.size(); ++face) {
        Piece3& piece = out[found.of_face[face]];
        Corners corners;
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = node.vertices[node.triangles[face][k]] - reference;
            piece.bounds.extend(corners[k] + reference);
        }
        piece.volume += corners[0].dot(corners[1].cross(corners[2])) / 6;
    }
    return out;
}

}  // namespace

std::vector<FileMesh::Node> placed(std::vector<FileMesh::Node> nodes, const Vec3& scale, const Pose& robot_from_mesh)
{
    for (FileMesh::Node& node : nodes)
        for (Vec3& vertex : node.vertices)
            vertex = robot_from_mesh.rotation * vertex.cwiseProduct(scale) + robot_from_mesh.position;
    return nodes;
}

std::optional<double> enclosed_volume(const std::vector<FileMesh::Node>& nodes)
{
    std::vector<Piece3> pieces;
    for (const FileMesh::Node& node : nodes) {
        const auto node_pieces = closed_pieces(node);
        if (!node_pieces) return std::nullopt;
        pieces.insert(pieces.end(), node_pieces->begin(), node_pieces->end());
    }
    double sum = 0;
    constexpr std::size_t too_many = 2000;  // they are compared pair by pair
    if (pieces.size() > too_many) return std::nullopt;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        sum += std::abs(pieces[i].volume);
        for (std::size_t j = 0; j < i; ++j) {
            const bool apart = (pieces[i].bounds.max.array() <= pieces[j].bounds.min.array()).any() ||
                               (pieces[j].bounds.max.array() <= pieces[i].bounds.min.array()).any();
            if (!apart) return std::nullopt;
        }
    }
    return sum > 0 ? std::optional(sum) : std::nullopt;
}

void append_mesh(Robot& robot, const CollisionMesh& mesh, int most)
{
    std::vector<SurfacePiece> pieces;
    for (const FileMesh::Node& node : mesh.nodes) {
        const FacePieces found = find_pieces(node.triangles);
        const std::size_t first = pieces.size();
        pieces.resize(first + found.open_edges.size());
        for (std::size_t face = 0; face < node.triangles.size(); ++face) {
            const Triangle& t = node.triangles[face];
            pieces[first + found.of_face[face]].push_back(
                {node.vertices[t[0]], node.vertices[t[1]], node.vertices[t[2]]});
        }
    }
    MeshFit fit{mesh.name, mesh.file.filename().string(), 0, 0, enclosed_volume(mesh.nodes)};
    for (RobotPart& part : convex_split(pieces, most)) {
        part.name = mesh.name;
        fit.volume += hull_volume(part);
        ++fit.parts;
        robot.parts.push_back(std::move(part));
    }
    robot.meshes.push_back(std::move(fit));
}

std::vector<std::string> growth_notices(const Robot& robot)
{
    constexpr double noteworthy = 0.05;
    std::vector<std::string> out;
    for (const MeshFit& fit : robot.meshes) {
        if (fit.growth() && *fit.growth() < noteworthy) continue;
        char text[160];
        const std::string what = fit.parts == 1 ? "its convex hull"
                                                : "its " + std::to_string(fit.parts) + " convex parts";
        if (fit.growth())
            std::snprintf(text, sizeof text, "%s, %.3g m3, %.0f %% more than the mesh", what.c_str(), fit.volume,
                          100 * *fit.growth());
        else
            std::snprintf(
                text, sizeof text,
                "%s, %.3g m3; the mesh's own volume is unknown, because the mesh is not watertight or overlaps itself",
                what.c_str(), fit.volume);
        out.push_back((fit.name.empty() ? "" : "\"" + fit.name + "\": ") + fit.file + " is replaced by " + text);
    }
    return out;
}

}  // namespace spawnfield

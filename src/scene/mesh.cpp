#include "scene/mesh.h"

#include "scene/pieces.h"

#include <algorithm>
#include <limits>

namespace spawnfield {
namespace {

Label label_of(const std::string& node, const std::string& material, const MeshOptions& options, Label fallback)
{
    for (const FaceRule& rule : options.rules)
        if ((rule.node && matches(rule.pattern, node)) || (rule.material && matches(rule.pattern, material))) return rule.label;
    return fallback;
}

/// A watertight piece is filled unless some of its faces, but not all, are water, or any are left out.
bool is_filled(const std::vector<Label>& labels, const std::vector<std::uint32_t>& faces, bool watertight,
               MeshOptions::Solid solid)
{
    if (solid == MeshOptions::Solid::No || (solid == MeshOptions::Solid::Auto && !watertight)) return false;
    const auto count = [&](Label label) {
        return std::count_if(faces.begin(), faces.end(), [&](std::uint32_t f) { return labels[f] == label; });
    };
    const auto water = count(Label::Water);
    return count(Label::Ignore) == 0 && (water == 0 || water == std::ptrdiff_t(faces.size()));
}

/// Appends one node's kept faces piece by piece, with the vertices that they use.
class NodeAppender {
public:
    NodeAppender(Scene& scene, std::uint32_t part, const FileMesh::Node& node, const MeshOptions& options, char up)
        : scene_(scene), part_(part), node_(node), options_(options), up_(up), index_(node.vertices.size(), unused)
    {
    }

    void add_piece(const std::vector<std::uint32_t>& faces, const std::vector<Label>& labels, std::uint32_t open_edges)
    {
        Piece piece;
        piece.part = part_;
        piece.first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
        piece.solid = is_filled(labels, faces, open_edges == 0, options_.solid);
        piece.sides_up = options_.sides_up;
        piece.bottom = std::numeric_limits<double>::infinity();
        for (const std::uint32_t face : faces)
            if (labels[face] != Label::Ignore) add_face(face, labels[face], piece);
        piece.triangle_count = static_cast<std::uint32_t>(scene_.triangles.size()) - piece.first_triangle;
        if (piece.triangle_count == 0) return;
        piece.open = piece.solid && (open_edges > 0 || piece.triangle_count < faces.size());
        Part& part = scene_.parts[part_];
        ++(piece.solid ? part.solid_pieces : part.sheet_pieces);
        part.open_edges += open_edges;
        part.triangles += piece.triangle_count;
        scene_.pieces.push_back(piece);
    }

private:
    void add_face(std::uint32_t face, Label label, Piece& piece)
    {
        Triangle triangle{};
        for (int corner = 0; corner < 3; ++corner) {
            triangle[corner] = vertex(node_.triangles[face][corner]);
            piece.bottom = std::min(piece.bottom, scene_.vertices[triangle[corner]].z());
        }
        scene_.triangles.push_back(triangle);
        scene_.triangle_labels.push_back(label);
        scene_.triangle_pieces.push_back(static_cast<std::uint32_t>(scene_.pieces.size()));
    }

    std::uint32_t vertex(std::uint32_t local)
    {
        if (index_[local] == unused) {
            index_[local] = static_cast<std::uint32_t>(scene_.vertices.size());
            const Vec3 metres = turned_up(node_.vertices[local].cwiseProduct(options_.scale), up_);
            scene_.vertices.push_back(options_.pose.rotation * metres + options_.pose.position);
        }
        return index_[local];
    }

    static constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    Scene& scene_;
    const std::uint32_t part_;
    const FileMesh::Node& node_;
    const MeshOptions& options_;
    const char up_;
    std::vector<std::uint32_t> index_;
};

}  // namespace

MeshNames append_mesh(Scene& scene, std::uint32_t part, const FileMesh& mesh, const MeshOptions& options)
{
    const char up = options.up != 0 ? options.up : mesh.up;
    MeshNames names{{}, mesh.materials};
    for (const FileMesh::Node& node : mesh.nodes) {
        std::vector<Label> labels;
        for (const std::uint32_t material : node.materials)
            labels.push_back(label_of(node.name, mesh.materials[material], options, scene.parts[part].label));
        const FacePieces pieces = find_pieces(node.triangles);
        std::vector<std::vector<std::uint32_t>> faces(pieces.open_edges.size());
        for (std::uint32_t face = 0; face < pieces.of_face.size(); ++face) faces[pieces.of_face[face]].push_back(face);
        NodeAppender appender(scene, part, node, options, up);
        for (std::size_t piece = 0; piece < faces.size(); ++piece)
            appender.add_piece(faces[piece], labels, pieces.open_edges[piece]);
        names.nodes.push_back(node.name);
    }
    for (const std::string& notice : mesh.notices)
        if (std::find(scene.notices.begin(), scene.notices.end(), notice) == scene.notices.end()) scene.notices.push_back(notice);
    return names;
}

void append_plane(Scene& scene, std::uint32_t part, double size_x, double size_y, const Pose& pose, bool sides_up)
{
    std::vector<Vec3> corners;
    for (const auto& [sx, sy] : {std::pair{-0.5, -0.5}, std::pair{0.5, -0.5}, std::pair{0.5, 0.5}, std::pair{-0.5, 0.5}})
        corners.push_back(pose.rotation * Vec3(sx * size_x, sy * size_y, 0) + pose.position);
    append_sheet(scene, part, corners, {{0, 1, 2}, {0, 2, 3}}, sides_up);
}

}  // namespace spawnfield

#include "scene/mesh.h"

#include "base/number.h"
#include "mesh/face_pieces.h"
#include "scene/pieces.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

/// Returns the label of the first rule that matches; empty if none does.
std::optional<Label> label_of(const std::string& node, const std::string& material, const std::vector<FaceRule>& rules)
{
    for (const FaceRule& rule : rules)
        if (rule.matches(node, material)) return rule.label;
    return {};
}

/// Returns whether a piece is filled. With Solid::Auto only a watertight piece is. A piece is never filled if one of
/// its faces is ignored, or if some of them, but not all, are water.
bool is_filled(const std::vector<Label>& labels, const std::vector<std::uint32_t>& faces, bool watertight, Solid solid)
{
    if (solid == Solid::No || (solid == Solid::Auto && !watertight)) return false;
    const auto count = [&](Label label) {
        return std::count_if(faces.begin(), faces.end(), [&](std::uint32_t f) { return labels[f] == label; });
    };
    const auto water = count(Label::Water);
    return count(Label::Ignore) == 0 && (water == 0 || water == std::ptrdiff_t(faces.size()));
}

/// Total area of the shells' faces that are level enough for ground and look up or down, m2.
struct ShellAreas {
    double up = 0, down = 0;
};

/// Appends the faces of one node, piece by piece, without those that are ignored, and the vertices that they use.
class NodeAppender {
public:
    /// `groups` has the number of the face group of each material that the node uses, as in Scene::triangle_groups.
    NodeAppender(Scene& scene, std::uint32_t part, const FileMesh::Node& node, const MeshOptions& options, char up,
                 const std::vector<std::uint32_t>& groups)
        : scene_(scene), part_(part), node_(node), options_(options), up_(up), groups_(groups),
          index_(node.vertices.size(), unused)
    {
    }

    /// Gives each face of a piece that no rule matches a label by its slope. If the piece is a shell, adds the areas of
    /// these faces to `areas`, if they are level enough for ground.
    void label_by_slope(const std::vector<std::uint32_t>& faces, const std::vector<char>& has_rule,
                        std::uint32_t open_edges, std::vector<Label>& labels, ShellAreas& areas) const
    {
        const bool filled = is_filled(labels, faces, open_edges == 0, options_.solid);
        for (const std::uint32_t face : faces) {
            if (has_rule[face] != 0) continue;
            const Vec3 normal = up_normal(face);
            const double level = std::cos(*options_.auto_slope) * normal.norm();
            const bool looks_up = normal.z() > level, looks_down = -normal.z() > level;
            labels[face] = looks_up || (filled && looks_down) ? Label::Terrain : Label::Obstacle;
            if (!filled) (looks_down ? areas.down : areas.up) += looks_up || looks_down ? normal.norm() / 2 : 0;
        }
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

    /// Returns a vertex in the scene's frame.
    Vec3 placed(std::uint32_t local) const
    {
        const Vec3 metres = turned_up(node_.vertices[local].cwiseProduct(options_.scale), up_);
        return options_.pose.rotation * metres + options_.pose.position;
    }

private:
    void add_face(std::uint32_t face, Label label, Piece& piece)
    {
        Triangle triangle{};
        for (int corner = 0; corner < 3; ++corner) {
            triangle[corner] = vertex(node_.triangles[face][corner]);
            piece.bottom = std::min(piece.bottom, scene_.vertices[triangle[corner]].z());
        }
        scene_.triangle_groups.resize(scene_.triangles.size());
        scene_.triangle_groups.push_back(groups_[node_.materials[face]]);
        scene_.triangles.push_back(triangle);
        scene_.triangle_labels.push_back(label);
        scene_.triangle_pieces.push_back(static_cast<std::uint32_t>(scene_.pieces.size()));
    }

    std::uint32_t vertex(std::uint32_t local)
    {
        if (index_[local] == unused) {
            index_[local] = static_cast<std::uint32_t>(scene_.vertices.size());
            scene_.vertices.push_back(placed(local));
        }
        return index_[local];
    }

    /// Returns the normal of a face in the scene's frame. It points to the side from which the corners of the file's
    /// face are counterclockwise. Its length is twice the area of the face.
    Vec3 up_normal(std::uint32_t face) const
    {
        const auto [a, b, c] = node_.triangles[face];
        const Vec3 corner = placed(a), normal = (placed(b) - corner).cross(placed(c) - corner);
        return options_.scale.prod() < 0 ? Vec3(-normal) : normal;  // a negative scale mirrors the face
    }

    static constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
    Scene& scene_;
    const std::uint32_t part_;
    const FileMesh::Node& node_;
    const MeshOptions& options_;
    const char up_;
    const std::vector<std::uint32_t>& groups_;
    std::vector<std::uint32_t> index_;
};

/// Appends a face group for each material of the node, in the order of the materials. Returns their numbers by
/// material, as in Scene::triangle_groups.
std::vector<std::uint32_t> append_groups(Scene& scene, std::uint32_t part, const FileMesh& mesh,
                                         const FileMesh::Node& node)
{
    constexpr double infinite = std::numeric_limits<double>::infinity();
    std::vector<std::uint32_t> out(mesh.materials.size());
    for (const std::uint32_t material : node.materials) out[material] = 1;
    for (std::size_t material = 0; material < out.size(); ++material) {
        if (out[material] == 0) continue;
        scene.face_groups.push_back({part, node.name, mesh.materials[material], {}, infinite, -infinite});
        out[material] = std::uint32_t(scene.face_groups.size());
    }
    return out;
}

/// Counts the faces of a node in their groups.
void count_faces(Scene& scene, const FileMesh::Node& node, const std::vector<std::uint32_t>& groups,
                 const std::vector<Label>& labels, const NodeAppender& appender)
{
    for (std::size_t face = 0; face < node.triangles.size(); ++face) {
        FaceGroup& group = scene.face_groups[groups[node.materials[face]] - 1];
        ++group.triangles[std::size_t(labels[face])];
        for (const std::uint32_t corner : node.triangles[face]) {
            const double z = appender.placed(corner).z();
            group.low = std::min(group.low, z);
            group.high = std::max(group.high, z);
        }
    }
}

void append_node(Scene& scene, std::uint32_t part, const FileMesh& mesh, const FileMesh::Node& node,
                 const MeshOptions& options, ShellAreas& areas)
{
    std::vector<std::optional<Label>> of_material;
    for (const std::string& material : mesh.materials)
        of_material.push_back(label_of(node.name, material, options.rules));
    std::vector<Label> labels;
    std::vector<char> has_rule;
    for (const std::uint32_t material : node.materials) {
        labels.push_back(of_material[material].value_or(scene.parts[part].label));
        has_rule.push_back(of_material[material].has_value());
    }
    const FacePieces pieces = find_pieces(node.triangles);
    std::vector<std::vector<std::uint32_t>> faces(pieces.open_edges.size());
    for (std::uint32_t face = 0; face < pieces.of_face.size(); ++face) faces[pieces.of_face[face]].push_back(face);
    const std::vector<std::uint32_t> groups = append_groups(scene, part, mesh, node);
    NodeAppender appender(scene, part, node, options, options.up != 0 ? options.up : mesh.up, groups);
    for (std::size_t piece = 0; piece < faces.size(); ++piece) {
        if (options.auto_slope)
            appender.label_by_slope(faces[piece], has_rule, pieces.open_edges[piece], labels, areas);
        appender.add_piece(faces[piece], labels, pieces.open_edges[piece]);
    }
    count_faces(scene, node, groups, labels, appender);
}

}  // namespace

std::span<const FaceGroup> append_mesh(Scene& scene, std::uint32_t part, const FileMesh& mesh,
                                       const MeshOptions& options)
{
    const std::size_t first = scene.face_groups.size();
    ShellAreas areas;
    for (const FileMesh::Node& node : mesh.nodes) append_node(scene, part, mesh, node, options, areas);
    for (const std::string& notice : mesh.notices)
        if (std::find(scene.notices.begin(), scene.notices.end(), notice) == scene.notices.end())
            scene.notices.push_back(notice);
    if (areas.up == 0 && areas.down > 0)
        scene.notices.push_back("\"" + scene.parts[part].name + "\": no face of its shells looks up and " +
                                number(std::round(areas.down * 1000) / 1000) +
                                " m2 look down, so --auto-label labels them as obstacle; is the mesh inside out?");
    return std::span(scene.face_groups).subspan(first);
}

void append_plane(Scene& scene, std::uint32_t part, double size_x, double size_y, const Pose& pose, bool sides_up)
{
    std::vector<Vec3> corners;
    for (const auto& [sx, sy] :
         {std::pair{-0.5, -0.5}, std::pair{0.5, -0.5}, std::pair{0.5, 0.5}, std::pair{-0.5, 0.5}})
        corners.push_back(pose.rotation * Vec3(sx * size_x, sy * size_y, 0) + pose.position);
    append_sheet(scene, part, corners, {{0, 1, 2}, {0, 2, 3}}, sides_up);
}

}  // namespace spawnfield

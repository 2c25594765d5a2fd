#include "hand_scene.h"

#include <Eigen/Geometry>

#include <algorithm>

using namespace spawnfield;

namespace hand {
namespace {

/// Returns the number of edges with an odd number of faces; 0 for a watertight piece.
std::uint32_t open_edges(const Mesh& mesh)
{
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) edges.push_back(std::minmax(t[i], t[(i + 1) % 3]));
    std::sort(edges.begin(), edges.end());
    std::uint32_t open = 0;
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const auto& edge) { return edge != *first; });
        open += (last - first) % 2 == 1;
        first = last;
    }
    return open;
}

void add_part(Scene& scene, const std::string& kind, Label label)
{
    Part part;
    part.name = kind + "-" + std::to_string(scene.parts.size());
    part.kind = kind;
    part.label = label;
    scene.parts.push_back(part);
}

const char* kind_of(const Shape& shape)
{
    switch (shape.kind) {
    case ShapeKind::Box: return "box";
    case ShapeKind::Sphere: return "sphere";
    case ShapeKind::Cylinder: return "cylinder";
    case ShapeKind::Capsule: return "capsule";
    case ShapeKind::Hull: break;
    }
    return "hull";
}

}  // namespace

Mesh extruded(const std::vector<Eigen::Vector2d>& polygon, double bottom, double top)
{
    const auto n = std::uint32_t(polygon.size());
    Mesh mesh;
    for (const double z : {bottom, top})
        for (const auto& corner : polygon) mesh.vertices.emplace_back(corner.x(), corner.y(), z);
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t next = (i + 1) % n;
        mesh.triangles.insert(mesh.triangles.end(), {{i, next, n + next}, {i, n + next, n + i}});
    }
    for (std::uint32_t i = 2; i < n; ++i)
        mesh.triangles.insert(mesh.triangles.end(), {{0, i, i - 1}, {n, n + i - 1, n + i}});
    return mesh;
}

Mesh box(const Vec3& size)
{
    const double x = size.x() / 2, y = size.y() / 2;
    return extruded({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, -size.z() / 2, size.z() / 2);
}

Mesh rectangle(double size_x, double size_y)
{
    const double x = size_x / 2, y = size_y / 2;
    return {{{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}}, {{0, 1, 3}, {1, 2, 3}}};
}

Mesh relief(int cells, double size, const std::function<double(double x, double y)>& height)
{
    Mesh mesh;
    const auto coordinate = [&](int i) { return size * (double(i) / cells - 0.5); };
    for (int row = 0; row <= cells; ++row)
        for (int col = 0; col <= cells; ++col)
            mesh.vertices.emplace_back(coordinate(col), coordinate(row), height(coordinate(col), coordinate(row)));
    const auto width = std::uint32_t(cells + 1);
    for (std::uint32_t row = 0; row + 1 < width; ++row)
        for (std::uint32_t col = 0; col + 1 < width; ++col) {
            const std::uint32_t a = row * width + col, b = a + 1, c = b + width, d = a + width;
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
        }
    return mesh;
}

Mesh convex_hull(const std::vector<Vec3>& points)
{
    Mesh mesh = {points, {}};
    const auto n = std::uint32_t(points.size());
    const auto is_face = [&](const Triangle& t) {
        const Vec3 normal = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]);
        for (std::uint32_t i = 0; i < n; ++i)
            if (i != t[0] && i != t[1] && i != t[2] && normal.dot(points[i] - points[t[0]]) > 0) return false;
        return true;
    };
    for (std::uint32_t a = 0; a < n; ++a)
        for (std::uint32_t b = a + 1; b < n; ++b)
            for (std::uint32_t c = b + 1; c < n; ++c)
                for (const Triangle& t : {Triangle{a, b, c}, Triangle{a, c, b}})
                    if (is_face(t)) mesh.triangles.push_back(t);
    return mesh;
}

Mesh moved(Mesh mesh, const Pose& pose)
{
    for (Vec3& vertex : mesh.vertices) vertex = pose.rotation * vertex + pose.position;
    return mesh;
}

Mesh flipped(Mesh mesh)
{
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

Mesh without(Mesh mesh, std::size_t first, std::size_t count)
{
    const auto begin = mesh.triangles.begin() + std::ptrdiff_t(first);
    mesh.triangles.erase(begin, begin + std::ptrdiff_t(count));
    return mesh;
}

void add_shape(Scene& scene, Label label, const Shape& shape)
{
    add_part(scene, kind_of(shape), label);
    scene.parts.back().solid_pieces = 1;
    scene.primitives.push_back({shape, std::uint32_t(scene.parts.size() - 1), label});
}

void add_mesh(Scene& scene, Label label, const Mesh& mesh, const MeshOptions& options)
{
    add_part(scene, options.kind, label);
    add_piece(scene, mesh, options);
}

void add_piece(Scene& scene, const Mesh& mesh, const MeshOptions& options)
{
    Part& part = scene.parts.back();
    std::vector<Label> labels = options.labels;
    if (labels.empty()) labels.assign(mesh.triangles.size(), part.label);
    const std::uint32_t open = open_edges(mesh);
    const bool wet = std::find(labels.begin(), labels.end(), Label::Water) != labels.end();

    Piece piece;
    piece.part = std::uint32_t(scene.parts.size() - 1);
    piece.first_triangle = std::uint32_t(scene.triangles.size());
    piece.triangle_count = std::uint32_t(mesh.triangles.size());
    piece.solid = options.fill && open == 0 && !wet;
    piece.sides_up = options.sides_up && !piece.solid;
    piece.bottom = std::min_element(mesh.vertices.begin(), mesh.vertices.end(), [](const Vec3& a, const Vec3& b) {
                       return a.z() < b.z();
                   })->z();

    ++(piece.solid ? part.solid_pieces : part.sheet_pieces);
    part.open_edges += open;
    part.triangles += piece.triangle_count;
    const auto offset = std::uint32_t(scene.vertices.size());
    for (const Triangle& t : mesh.triangles) scene.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    scene.vertices.insert(scene.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    scene.triangle_labels.insert(scene.triangle_labels.end(), labels.begin(), labels.end());
    scene.triangle_pieces.insert(scene.triangle_pieces.end(), mesh.triangles.size(),
                                 std::uint32_t(scene.pieces.size()));
    scene.pieces.push_back(piece);
}

}  // namespace hand

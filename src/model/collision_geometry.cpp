#include "model/collision_geometry.h"

#include <spawnfield/error.h>

#include <algorithm>

namespace spawnfield {

using Kind = CollisionGeometry::Kind;

std::string scoped_name(const CollisionBody& body)
{
    std::string out;
    for (const std::string& name : body.names)
        if (!name.empty()) out += (out.empty() ? "" : "::") + name;  // the name of a URDF's collision may be empty
    return out;
}

std::optional<Shape> shape_of(const CollisionGeometry& geometry, const Pose& pose)
{
    const Vec3& size = geometry.size;
    switch (geometry.kind) {
    case Kind::Box: return Shape{ShapeKind::Box, size, pose};
    case Kind::Sphere: return Shape{ShapeKind::Sphere, Vec3(size[0], 0, 0), pose};
    case Kind::Cylinder: return Shape{ShapeKind::Cylinder, Vec3(size[0], size[1], 0), pose};
    case Kind::Capsule: return Shape{ShapeKind::Capsule, Vec3(size[0], size[1], 0), pose};
    case Kind::Ellipsoid:
        return size[0] == size[1] && size[1] == size[2]
                   ? std::optional(Shape{ShapeKind::Sphere, Vec3(size[0], 0, 0), pose})
                   : std::nullopt;
    default: return {};
    }
}

bool has_submesh(const FileMesh& mesh, const CollisionGeometry& geometry)
{
    return geometry.submesh.empty() ||
           std::any_of(mesh.nodes.begin(), mesh.nodes.end(),
                       [&](const FileMesh::Node& node) { return node.name == geometry.submesh; });
}

FileMesh submesh_of(const FileMesh& mesh, const CollisionGeometry& geometry, const std::string& file)
{
    if (geometry.submesh.empty()) return mesh;
    FileMesh out;
    out.materials = mesh.materials;
    out.notices = mesh.notices;
    std::string names;
    for (const FileMesh::Node& node : mesh.nodes) {
        if (node.name == geometry.submesh) out.nodes.push_back(node);
        names += (names.empty() ? "" : ", ") + node.name;
    }
    if (out.nodes.empty()) throw FileError(file, "has no submesh \"" + geometry.submesh + "\"; its nodes are " + names);
    if (!geometry.is_centred) return out;
    Bounds box;
    for (const FileMesh::Node& node : out.nodes)
        for (const Vec3& vertex : node.vertices) box.extend(vertex);
    for (FileMesh::Node& node : out.nodes)
        for (Vec3& vertex : node.vertices) vertex -= (box.min + box.max) / 2;
    return out;
}

}  // namespace spawnfield

#pragma once

#include "mesh/mesh_file.h"

#include <spawnfield/shape.h>

#include <array>

namespace spawnfield {

/// The <geometry> of a <collision> in an SDF or URDF file, in the collision's own frame, in metres.
struct CollisionGeometry {
    enum class Kind { Box, Sphere, Cylinder, Capsule, Ellipsoid, Plane, Mesh, Heightmap, Polyline, Unknown };
    Kind kind = Kind::Unknown;
    /// Box: side lengths. Sphere: radius, -, -. Cylinder and capsule: radius, straight length, -. Ellipsoid: radii.
    /// Plane: side lengths of the largest <visual> of its link, -; all 0 if there is none. (A plane is infinite, so the
    /// <size> of the collision itself has no meaning.) Mesh: scale. Heightmap: side lengths, and the height of its
    /// brightest pixel. Polyline: height, -, -.
    Vec3 size = Vec3::Ones();
    Vec3 normal = Vec3::UnitZ();   ///< plane; its length may differ from 1
    std::string uri;               ///< mesh, heightmap: as in the file
    std::filesystem::path folder;  ///< folder of the file that contains it
    std::string submesh;           ///< mesh: the only node that is used; empty: all nodes
    bool is_centred = false;       ///< mesh: the middle of the submesh becomes the origin
    Vec3 position = Vec3::Zero();  ///< heightmap: position of its middle
    unsigned sampling = 1;         ///< heightmap: samples per pixel, interpolated between pixels
    /// Polyline: a point is inside if an odd number of the outlines enclose it.
    std::vector<std::vector<std::array<double, 2>>> outlines;
    std::string element;      ///< Unknown: name of the element in the file
    std::optional<int> line;  ///< line in its file; empty: unknown
};

/// A <collision> with its pose.
struct CollisionBody {
    std::vector<std::string> names;  ///< models from the outermost to the innermost, link, collision
    Pose pose;                       ///< in the frame of the world or model that was read
    CollisionGeometry geometry;
};

/// Returns the names joined as in "house::link::collision" (SDFormat's scoped names).
SPAWNFIELD_MODULE_API std::string scoped_name(const CollisionBody& body);

/// Returns the shape of a box, sphere, cylinder or capsule, and of an ellipsoid that is a sphere; empty for other
/// geometry.
std::optional<Shape> shape_of(const CollisionGeometry& geometry, const Pose& pose);

/// Returns whether the mesh has the node that the geometry names, or the geometry does not name a node.
bool has_submesh(const FileMesh& mesh, const CollisionGeometry& geometry);

/// Returns the part of a mesh file that the geometry uses: all nodes, or the nodes with the name of its submesh. If the
/// geometry is centred, the middle of their bounding box is moved to the origin. Throws FileError if there is no such
/// node.
FileMesh submesh_of(const FileMesh& mesh, const CollisionGeometry& geometry, const std::string& file);

}  // namespace spawnfield

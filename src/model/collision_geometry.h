#pragma once

#include "mesh/mesh_file.h"

#include <spawnfield/shape.h>

#include <array>

namespace spawnfield {

/// The <geometry> of a <collision> of an SDF or URDF file, in its own frame, in metres.
struct CollisionGeometry {
    enum class Kind { Box, Sphere, Cylinder, Capsule, Ellipsoid, Plane, Mesh, Heightmap, Polyline, Unknown };
    Kind kind = Kind::Unknown;
    /// Box: side lengths; sphere: radius, -, -; cylinder, capsule: radius, straight length, -; ellipsoid: radii;
    /// plane: side lengths as drawn by a <visual> of its link, -, all 0 if none draws it (a plane has no end, so the
    /// collision's own <size> means nothing); mesh: scale; heightmap: sides and the height of its brightest pixel;
    /// polyline: height, -, -.
    Vec3 size = Vec3::Ones();
    Vec3 normal = Vec3::UnitZ();   ///< plane; not of unit length necessarily
    std::string uri;               ///< mesh, heightmap: as the file has it
    std::filesystem::path folder;  ///< of the file in which it stands
    std::string submesh;           ///< mesh: the only node that counts; empty: all
    bool is_centred = false;       ///< mesh: the submesh's middle becomes its origin
    Vec3 position = Vec3::Zero();  ///< heightmap: of its middle
    unsigned sampling = 1;         ///< heightmap: samples for each pixel, between them interpolated
    std::vector<std::vector<std::array<double, 2>>> outlines;  ///< polyline: even-odd
    std::string element;                                       ///< Unknown: what stands there
    std::optional<int> line;                                   ///< of its file, where that is known
};

/// A <collision> with its place.
struct CollisionBody {
    std::vector<std::string> names;  ///< models from the outermost in, link, collision
    Pose pose;                       ///< in the world, or in the model that was asked for
    CollisionGeometry geometry;
};

/// "house::link::collision" (SDFormat's scoped names).
SPAWNFIELD_MODULE_API std::string scoped_name(const CollisionBody& body);

/// Of a box, sphere, cylinder or capsule, and of an ellipsoid that is a sphere.
std::optional<Shape> shape_of(const CollisionGeometry& geometry, const Pose& pose);

/// Whether the mesh has the node that the geometry names, or the geometry names none.
bool has_submesh(const FileMesh& mesh, const CollisionGeometry& geometry);

/// What of its file a mesh geometry means: all, or the nodes of its submesh, with the middle of their box moved to the
/// origin if it is to be centred. Throws FileError.
FileMesh submesh_of(const FileMesh& mesh, const CollisionGeometry& geometry, const std::string& file);

}  // namespace spawnfield

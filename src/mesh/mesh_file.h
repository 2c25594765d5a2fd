#pragma once

#include <spawnfield/types.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace spawnfield {

/// The content of a mesh file: one welded mesh for each node, on the axes of the file, in metres; scale, up axis and
/// pose of a part are not applied yet.
struct FileMesh {
    struct Node {
        std::string name;
        std::vector<Vec3> vertices;            ///< transformed by the node and all its parents
        std::vector<Triangle> triangles;       ///< counterclockwise from outside, also if the node's transform mirrors
        std::vector<std::uint32_t> materials;  ///< one for each triangle: index into `materials` of the mesh
    };
    std::vector<Node> nodes;
    std::vector<std::string> materials;
    char up = 'z';                     ///< up axis by the format: 'x', 'y' or 'z'
    std::vector<std::string> notices;  ///< about content that is not read; each begins with the file name
};

/// The formats of mesh files that may be read: those of the tests (glTF, OBJ, STL, PLY, COLLADA, FBX, 3DS, OFF, 3MF),
/// or all that assimp reads.
enum class MeshFormats { Tested, Any };

/// Reads a mesh. Throws FileError for a file that is missing, malformed, of another format or without triangles, that
/// has coordinates which are not finite, or for a glTF that assimp would read wrongly (mesh_reader/gltf_file.h).
FileMesh read_mesh(const std::filesystem::path& file, MeshFormats formats);

/// Returns the version of assimp, for example "5.2.4".
std::string mesh_reader_version();

/// Returns the formats that an option `any_mesh` stands for.
inline MeshFormats mesh_formats(bool any_mesh) { return any_mesh ? MeshFormats::Any : MeshFormats::Tested; }

/// Reads each file once for all parts that use it, and keeps it in memory until the last of them has read it.
class MeshFiles {
public:
    explicit MeshFiles(MeshFormats formats) : formats_(formats) {}

    /// Announces one call of read() for this file.
    void expect(const std::filesystem::path& file) { ++files_[file].remaining_uses; }
    /// Returns the mesh; throws FileError as read_mesh().
    std::shared_ptr<const FileMesh> read(const std::filesystem::path& file);

private:
    struct Entry {
        std::size_t remaining_uses = 0;
        std::shared_ptr<const FileMesh> mesh;
    };
    MeshFormats formats_;
    std::map<std::filesystem::path, Entry> files_;
};

/// Rotates a point from the given up axis to z up. From y up, (x, y, z) becomes (x, -z, y). From x up (with -y to the
/// right) it becomes (-y, -z, x).
inline Vec3 turned_up(const Vec3& point, char up)
{
    if (up == 'x') return {-point.y(), -point.z(), point.x()};
    return up == 'y' ? Vec3(point.x(), -point.z(), point.y()) : point;
}

}  // namespace spawnfield

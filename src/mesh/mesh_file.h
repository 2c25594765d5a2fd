#pragma once

#include <spawnfield/types.h>

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

namespace spawnfield {

/// A mesh file as its nodes give it: one welded mesh per node, file axes and units of metres, before scale, up and
/// pose.
struct FileMesh {
    struct Node {
        std::string name;
        std::vector<Vec3> vertices;            ///< transformed by the node and all its parents
        std::vector<Triangle> triangles;       ///< counterclockwise from outside also where the node mirrors
        std::vector<std::uint32_t> materials;  ///< one for each triangle
    };
    std::vector<Node> nodes;
    std::vector<std::string> materials;
    char up = 'z';                     ///< what the format says
    std::vector<std::string> notices;  ///< of what the file holds and is not read; begin with the file
};

/// Any format assimp reads. Throws FileError for a file that is missing, malformed, without triangles, that has
/// coordinates which are no finite numbers, or a glTF of which assimp would read less or other geometry than it has
/// (mesh/gltf_file.h).
FileMesh read_mesh(const std::filesystem::path& file);

/// Reads each file once for all parts that name it, and keeps it only until the last of them has it.
class MeshFiles {
public:
    void expect(const std::filesystem::path& file) { ++files_[file].uses_left; }
    std::shared_ptr<const FileMesh> read(const std::filesystem::path& file);

private:
    struct Entry {
        std::size_t uses_left = 0;
        std::shared_ptr<const FileMesh> mesh;
    };
    std::map<std::filesystem::path, Entry> files_;
};

/// y up to z up: (x, y, z) becomes (x, -z, y); x up (with -y to the right), by way of y up: (-y, -z, x).
inline Vec3 turned_up(const Vec3& point, char up)
{
    if (up == 'x') return {-point.y(), -point.z(), point.x()};
    return up == 'y' ? Vec3(point.x(), -point.z(), point.y()) : point;
}

}  // namespace spawnfield

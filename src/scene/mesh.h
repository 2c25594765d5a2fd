#pragma once

#include "mesh/mesh_file.h"
#include "scene/glob.h"

namespace spawnfield {

/// Label of the faces whose node or material name matches, by the names it looks at.
struct FaceRule {
    std::string pattern;
    bool node = false, material = false;
    Label label = Label::Obstacle;
};

struct MeshOptions {
    enum class Solid { Auto, Yes, No };
    Pose pose;                  ///< scene_from_part
    Vec3 scale = Vec3::Ones();  ///< on the file's own axes, after the file's own unit
    char up = 0;                ///< 'x', 'y', 'z'; 0: what the format says, else z
    Solid solid = Solid::Auto;
    bool sides_up = false;
    std::vector<FaceRule> rules;
};

/// What label rules can match in a mesh.
struct MeshNames {
    std::vector<std::string> nodes, materials;
};

/// Appends the mesh's faces to the scene as pieces of `part`, and its notices that the scene has not yet.
MeshNames append_mesh(Scene& scene, std::uint32_t part, const FileMesh& mesh, const MeshOptions& options);

/// A horizontal rectangle of the given side lengths around the pose's origin.
void append_plane(Scene& scene, std::uint32_t part, double size_x, double size_y, const Pose& pose, bool sides_up);

}  // namespace spawnfield

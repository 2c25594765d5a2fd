#pragma once

#include "mesh/mesh_file.h"
#include "scene/glob.h"

#include <spawnfield/scene.h>

#include <spawnfield/scene_parts.h>

#include <optional>
#include <span>

namespace spawnfield {

/// Label of the faces whose names match the globs.
struct FaceRule {
    std::string node = "*", material = "*";
    Label label = Label::Obstacle;
    bool either = false;  ///< one of the two needs to match, not both

    bool matches(const std::string& node_name, const std::string& material_name) const
    {
        const bool by_node = spawnfield::matches(node, node_name),
                   by_material = spawnfield::matches(material, material_name);
        return either ? by_node || by_material : by_node && by_material;
    }
};

struct MeshOptions {
    Pose pose;                  ///< scene_from_part
    Vec3 scale = Vec3::Ones();  ///< on the file's own axes, after the file's own unit
    char up = 0;                ///< 'x', 'y', 'z'; 0: what the format says, else z
    Solid solid = Solid::Auto;
    bool sides_up = false;
    std::vector<FaceRule> rules;
    std::optional<double>
        auto_slope;  ///< rad; what no rule matches is terrain where it looks up and is less steep, else obstacle
};

/// Appends the mesh's faces to the scene as pieces of `part`, its face groups, and its notices that the scene has not
/// yet. Returns the groups, until the scene gets more of them.
///
/// With auto_slope the winding says which side of a shell's face is up. In a filled piece it does not matter: only
/// the upper end of a solid interval carries robots.
std::span<const FaceGroup> append_mesh(Scene& scene, std::uint32_t part, const FileMesh& mesh,
                                       const MeshOptions& options);

/// A horizontal rectangle of the given side lengths around the pose's origin.
void append_plane(Scene& scene, std::uint32_t part, double size_x, double size_y, const Pose& pose, bool sides_up);

}  // namespace spawnfield

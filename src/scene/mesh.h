#pragma once

#include "mesh/mesh_file.h"
#include "scene/glob.h"

#include <spawnfield/scene.h>

#include <spawnfield/scene_parts.h>

#include <optional>
#include <span>

namespace spawnfield {

/// A label for the faces whose names match the globs.
struct FaceRule {
    std::string node = "*", material = "*";
    Label label = Label::Obstacle;
    bool either = false;  ///< one of the two globs is enough; else both must match

    bool matches(const std::string& node_name, const std::string& material_name) const
    {
        const bool by_node = spawnfield::matches(node, node_name),
                   by_material = spawnfield::matches(material, material_name);
        return either ? by_node || by_material : by_node && by_material;
    }
};

/// How a mesh becomes part of a scene.
struct MeshOptions {
    Pose pose;                  ///< scene_from_part
    Vec3 scale = Vec3::Ones();  ///< along the axes of the file, in addition to its unit
    char up = 0;                ///< 'x', 'y', 'z'; 0: that of the format, else z
    Solid solid = Solid::Auto;
    bool sides_up = false;  ///< robots stand only on the side that the winding shows as up
    std::vector<FaceRule> rules;
    /// rad. A face that no rule matches is terrain if it looks up and is less steep than this, else obstacle.
    std::optional<double> auto_slope;
};

/// Appends the faces of the mesh to the scene as pieces of `part`, with its face groups and with those of its notices
/// that the scene does not have yet. Returns the groups; the span is valid until the scene gets more of them.
///
/// With auto_slope, the winding shows which side of a shell's face is up. In a filled piece the winding does not
/// matter: robots stand only on the upper end of a solid interval.
std::span<const FaceGroup> append_mesh(Scene& scene, std::uint32_t part, const FileMesh& mesh,
                                       const MeshOptions& options);

/// Appends a rectangle around the pose's origin, in the x-y plane of the pose, with the given side lengths.
void append_plane(Scene& scene, std::uint32_t part, double size_x, double size_y, const Pose& pose, bool sides_up);

}  // namespace spawnfield

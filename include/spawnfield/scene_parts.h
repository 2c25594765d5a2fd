#pragma once

#include <spawnfield/export.h>
#include <spawnfield/scene.h>

/// Scenes made in code. The parts go the same way as those of a scene file: equal vertices are welded, and watertight
/// pieces are filled.
namespace spawnfield {

/// Whether what a mesh encloses is solid.
enum class Solid : std::uint8_t {
    Auto,  ///< each watertight piece is, unless only some of its faces are water
    Yes,   ///< each piece is, also if it has holes
    No     ///< its faces have no thickness
};

/// Adds a mesh as a part. Triangles index the vertices, counterclockwise as seen from outside; vertices are in the
/// scene's frame, m. Triangles with two equal corners are left out.
/// Throws ArgumentError for an index beyond the vertices, or a coordinate that is not finite or beyond 1e7 m.
SPAWNFIELD_API void add_mesh(Scene& scene, const std::string& name, Label label, const std::vector<Vec3>& vertices,
                             const std::vector<Triangle>& triangles, Solid solid = Solid::Auto);

/// Adds a solid shape as a part. Throws ArgumentError for a hull, for sizes that are not > 0, and for places beyond
/// 1e7 m.
SPAWNFIELD_API void add_shape(Scene& scene, const std::string& name, Label label, const Shape& shape);

}  // namespace spawnfield

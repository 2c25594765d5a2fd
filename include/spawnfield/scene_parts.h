#pragma once

#include <spawnfield/export.h>
#include <spawnfield/scene.h>

/// Functions that make scenes in code. Parts are treated like those of a scene file: equal vertices are welded, and
/// watertight pieces are filled.
namespace spawnfield {

/// Whether the inside of a mesh is solid.
enum class Solid : std::uint8_t {
    Auto,  ///< the inside of each watertight piece is solid, unless some of its faces are water and some are not
    Yes,   ///< the inside of each piece is solid, even if the piece has holes
    No     ///< the faces have no thickness
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

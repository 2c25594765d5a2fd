#pragma once

#include <spawnfield/geometry.h>

#include <array>
#include <utility>
#include <vector>

namespace spawnfield {

/// All surfaces of a label, for display: corners are rounded.
struct LabelMesh {
    Label label = Label::Terrain;
    Vec3 offset = Vec3::Zero();
    double scale = 1;  ///< corner = offset + scale * (x, y, z), m, relative to the origin of the world
    std::vector<std::array<std::uint16_t, 4>> corners = {};           ///< x, y, z, 0
    std::vector<std::uint32_t> indices = {};                          ///< three for each triangle
    std::vector<std::pair<std::uint32_t, std::uint32_t>> parts = {};  ///< part, and its first triangle; ascending
};

struct WorldMesh {
    std::vector<LabelMesh> meshes;  ///< one for each label that the scene has
    std::size_t triangles = 0;      ///< of the scene
    std::size_t shown = 0;          ///< of the meshes
};

/// Returns the scene for display, relative to `origin`. If it has more than `most_triangles`, its parts are simplified,
/// each by the same share, but those of at most 64 triangles are kept. Source: Garland, Heckbert, Surface
/// simplification using quadric error metrics, 1997 (meshoptimizer).
WorldMesh world_mesh(const Geometry& geometry, const Vec3& origin, std::size_t most_triangles, int threads);

}  // namespace spawnfield

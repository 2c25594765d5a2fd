#pragma once

#include <spawnfield/scene.h>

#include <filesystem>

namespace bench {

/// A scene as Embree reads it: triangles in single precision, sorted by label.
struct TriangleScene {
    spawnfield::Bounds bounds = {};      ///< of the map
    std::vector<float> vertices;         ///< x, y, z of each, and one more float, because Embree reads four of each
    std::vector<std::uint32_t> indices;  ///< three for each triangle
    std::array<std::uint64_t, 3> counts = {};  ///< triangles of Terrain, Obstacle and Water, in this order
};

/// Returns the triangles of a scene; a box becomes twelve. Throws std::invalid_argument if the scene has other
/// primitives.
TriangleScene triangle_scene_of(const spawnfield::Scene& scene, const spawnfield::Bounds& bounds);

/// Calls add(a, b, c) with the twelve triangles of a box. Their normals point out.
template <class Add>
void for_each_side(const spawnfield::Shape& box, const Add& add)
{
    using spawnfield::Vec3;
    const auto corner = [&](int i) -> Vec3 {
        const Vec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
        return box.pose.rotation * box.size.cwiseProduct(sign) + box.pose.position;
    };
    constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& [a, b, c, d] : faces) {
        add(corner(a), corner(b), corner(c));
        add(corner(a), corner(c), corner(d));
    }
}

/// Files with the bytes of these arrays, for another process on the same machine. Throw std::runtime_error.
void write_triangles(const std::filesystem::path& file, const TriangleScene& scene);
TriangleScene read_triangles(const std::filesystem::path& file);

}  // namespace bench

#pragma once

#include <spawnfield/scene.h>

#include <algorithm>

namespace spawnfield {

/// Element e is triangle e of the scene, or primitive e - (number of triangles).
inline std::size_t element_count(const Scene& scene) { return scene.triangles.size() + scene.primitives.size(); }

inline bool is_triangle(const Scene& scene, std::uint32_t element) { return element < scene.triangles.size(); }

inline const Primitive& primitive_of(const Scene& scene, std::uint32_t element)
{
    return scene.primitives[element - scene.triangles.size()];
}

inline std::array<Vec3, 3> corners_of(const Scene& scene, std::uint32_t triangle)
{
    const Triangle& t = scene.triangles[triangle];
    return {scene.vertices[t[0]], scene.vertices[t[1]], scene.vertices[t[2]]};
}

inline Bounds element_bounds(const Scene& scene, std::uint32_t element)
{
    if (!is_triangle(scene, element)) return bounds_of(primitive_of(scene, element).shape);
    Bounds box;
    for (const Vec3& corner : corners_of(scene, element)) box.extend(corner);
    return box;
}

inline Label element_label(const Scene& scene, std::uint32_t element)
{
    return is_triangle(scene, element) ? scene.triangle_labels[element] : primitive_of(scene, element).label;
}

inline bool has_filled_meshes(const Scene& scene)
{
    return std::any_of(scene.pieces.begin(), scene.pieces.end(), [](const Piece& piece) { return piece.solid; });
}

inline std::uint32_t element_part(const Scene& scene, std::uint32_t element)
{
    return is_triangle(scene, element) ? scene.pieces[scene.triangle_pieces[element]].part
                                       : primitive_of(scene, element).part;
}

/// Returns the face group of a triangle, as in Scene::triangle_groups.
inline std::uint32_t face_group(const Scene& scene, std::uint32_t triangle)
{
    return triangle < scene.triangle_groups.size() ? scene.triangle_groups[triangle] : 0;
}

}  // namespace spawnfield

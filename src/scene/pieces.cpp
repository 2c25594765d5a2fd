#include "scene/pieces.h"

#include <algorithm>

namespace spawnfield {

std::uint32_t add_part(Scene& scene, const std::string& name, const std::string& kind, Label label)
{
    Part part;
    part.name = name;
    part.kind = kind;
    part.label = label;
    scene.parts.push_back(std::move(part));
    return static_cast<std::uint32_t>(scene.parts.size() - 1);
}

void append_sheet(Scene& scene, std::uint32_t part, const std::vector<Vec3>& vertices,
                  const std::vector<Triangle>& triangles, bool sides_up)
{
    if (triangles.empty()) return;
    Piece piece;
    piece.part = part;
    piece.first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    piece.triangle_count = static_cast<std::uint32_t>(triangles.size());
    piece.sides_up = sides_up;
    piece.bottom = vertices[triangles[0][0]].z();
    const auto base = static_cast<std::uint32_t>(scene.vertices.size());
    for (const Vec3& vertex : vertices) piece.bottom = std::min(piece.bottom, vertex.z());
    scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
    for (const Triangle& t : triangles) scene.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    scene.triangle_labels.resize(scene.triangles.size(), scene.parts[part].label);
    scene.triangle_pieces.resize(scene.triangles.size(), static_cast<std::uint32_t>(scene.pieces.size()));
    scene.pieces.push_back(piece);
    ++scene.parts[part].sheet_pieces;
    scene.parts[part].triangles += piece.triangle_count;
}

}  // namespace spawnfield

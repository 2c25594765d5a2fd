#pragma once

#include <spawnfield/scene.h>

#include <string>

namespace spawnfield {

/// Faces joined over shared edges.
struct FacePieces {
    std::vector<std::uint32_t> of_face;     ///< piece of each face; pieces are numbered by their first face
    std::vector<std::uint32_t> open_edges;  ///< of each piece: edges with an odd number of faces; 0: watertight
};

/// Connected components over edges of welded faces. O(faces log faces).
FacePieces find_pieces(const std::vector<Triangle>& faces);

/// Appends a part without geometry; its number.
std::uint32_t add_part(Scene& scene, const std::string& name, const std::string& kind, Label label);

/// Appends one piece without thickness: triangles index `vertices`, which are in the scene's frame.
void append_sheet(Scene& scene, std::uint32_t part, const std::vector<Vec3>& vertices,
                  const std::vector<Triangle>& triangles, bool sides_up);

}  // namespace spawnfield

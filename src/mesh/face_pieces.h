#pragma once

#include <spawnfield/types.h>

#include <vector>

namespace spawnfield {

/// Faces joined over shared edges.
struct FacePieces {
    std::vector<std::uint32_t> of_face;     ///< piece of each face; pieces are numbered by their first face
    std::vector<std::uint32_t> open_edges;  ///< of each piece: edges with an odd number of faces; 0: watertight
};

/// Connected components over edges of welded faces. O(faces log faces).
FacePieces find_pieces(const std::vector<Triangle>& faces);

}  // namespace spawnfield

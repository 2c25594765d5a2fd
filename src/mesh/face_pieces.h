#pragma once

#include <spawnfield/types.h>

#include <vector>

namespace spawnfield {

/// The pieces of a mesh: faces that are connected over shared edges.
struct FacePieces {
    std::vector<std::uint32_t> of_face;  ///< piece of each face; pieces are numbered by their first face
    std::vector<std::uint32_t>
        open_edges;  ///< of each piece: number of edges with an odd number of faces; 0: watertight
};

/// Returns the pieces of welded faces: their connected components over edges. O(faces log faces).
FacePieces find_pieces(const std::vector<Triangle>& faces);

}  // namespace spawnfield

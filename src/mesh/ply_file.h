#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// Vertices and faces of a PLY file, in its order. Colours, normals and all else are left aside.
struct PlyMesh {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::uint32_t> corners;       ///< vertices, face after face; each is in 0 .. vertices.size() - 1
    std::vector<std::size_t> face_ends = {};  ///< in corners, one for each face
};

/// Whether the file's first line is that of a PLY file.
bool is_ply(std::string_view bytes);

/// A PLY file of any of its three formats: element vertex with x, y, z; faces by element face with a list
/// vertex_indices or vertex_index, or by element tristrips, whose strips -1 ends. Row by row as the header says, and
/// not a number more or less. Throws FileError, with the line or, in binary files, the row: a header that is damaged or
/// tells more than the file holds; numbers that are none, too few or too many in a row; corners that are no vertices;
/// faces without corners; no faces at all; anything after the last row. Source: Turk, The PLY Polygon File Format,
/// 1994.
PlyMesh parse_ply(std::string_view bytes, const std::string& file);

}  // namespace spawnfield

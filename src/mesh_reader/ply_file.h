#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// Vertices and faces of a PLY file, in the order of the file. Colours, normals and other properties are ignored.
struct PlyMesh {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::uint32_t> corners;       ///< vertex indices, face after face, 0 .. vertices.size() - 1
    std::vector<std::size_t> face_ends = {};  ///< end of each face in `corners`
};

/// Returns whether the first line is that of a PLY file.
bool is_ply(std::string_view bytes);

/// Reads a PLY file in any of its three formats. It needs the element vertex with x, y, z, and faces: the element face
/// with a list vertex_indices or vertex_index, or the element tristrips, whose strips end with -1. Each row must have
/// exactly the numbers that the header declares.
///
/// Throws FileError with the line or, in binary files, the row for: a header that is damaged or declares more than the
/// file contains; words that are not numbers, and too few or too many of them in a row; corners that are not vertices;
/// faces without corners; a file without faces; anything after the last row. Source: Turk, The PLY Polygon File Format,
/// 1994.
PlyMesh parse_ply(std::string_view bytes, const std::string& file);

}  // namespace spawnfield

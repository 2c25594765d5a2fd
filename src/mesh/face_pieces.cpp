#include "mesh/face_pieces.h"

#include <algorithm>
#include <numeric>

namespace spawnfield {
namespace {

struct Edge {
    std::uint32_t low, high, face;
    auto key() const { return std::pair{low, high}; }
};

std::vector<Edge> sorted_edges(const std::vector<Triangle>& faces)
{
    std::vector<Edge> edges;
    edges.reserve(3 * faces.size());
    for (std::uint32_t face = 0; face < faces.size(); ++face)
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = faces[face][corner], b = faces[face][(corner + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), face});
        }
    std::sort(edges.begin(), edges.end(), [](const Edge& l, const Edge& r) { return l.key() < r.key(); });
    return edges;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t face)
{
    while (parents[face] != face) face = parents[face] = parents[parents[face]];
    return face;
}

}  // namespace

FacePieces find_pieces(const std::vector<Triangle>& faces)
{
    const std::vector<Edge> edges = sorted_edges(faces);
    std::vector<std::uint32_t> parents(faces.size());
    std::iota(parents.begin(), parents.end(), 0u);
    for (std::size_t i = 1; i < edges.size(); ++i)
        if (edges[i].key() == edges[i - 1].key()) {
            const std::uint32_t a = root_of(parents, edges[i].face), b = root_of(parents, edges[i - 1].face);
            parents[std::max(a, b)] = std::min(a, b);
        }
    FacePieces pieces;
    pieces.of_face.resize(faces.size());
    for (std::uint32_t face = 0; face < faces.size(); ++face) {
        const std::uint32_t root = root_of(parents, face);
        if (root == face) {
            pieces.of_face[face] = static_cast<std::uint32_t>(pieces.open_edges.size());
            pieces.open_edges.push_back(0);
        } else {
            pieces.of_face[face] =
                pieces.of_face[root];  // a root is the smallest face of its piece, so it was visited before
        }
    }
    for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
        while (last < edges.size() && edges[last].key() == edges[first].key()) ++last;
        if ((last - first) % 2 == 1) ++pieces.open_edges[pieces.of_face[edges[first].face]];
    }
    return pieces;
}

}  // namespace spawnfield

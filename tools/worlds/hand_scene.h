#pragma once

#include <spawnfield/scene.h>

#include <functional>
#include <string>
#include <vector>

/// Scenes made by hand, as plain values: for tests that do without files and without the reader.
namespace hand {

/// Faces of one piece, counterclockwise from outside or above.
struct Mesh {
    std::vector<spawnfield::Vec3> vertices;
    std::vector<spawnfield::Triangle> triangles;
};

/// Closed body between two heights over a counterclockwise polygon, all of which can be seen from its first corner.
/// n corners: triangles 2 i and 2 i + 1 are the side from corner i to the next, 2 n and on are bottom and top in turns.
Mesh extruded(const std::vector<Eigen::Vector2d>& polygon, double bottom, double top);

Mesh box(const spawnfield::Vec3& size);        ///< centred; sides in order -y, x, y, -x
Mesh rectangle(double size_x, double size_y);  ///< level, centred, seen from above

/// cells x cells squares, centred, each split from its smallest x, largest y to its largest x, smallest y.
Mesh relief(int cells, double size, const std::function<double(double x, double y)>& height);

/// Of points of which no four lie in a plane and none inside. O(points^4).
Mesh convex_hull(const std::vector<spawnfield::Vec3>& points);

Mesh moved(Mesh mesh, const spawnfield::Pose& pose);
Mesh flipped(Mesh mesh);                                        ///< wound the other way round
Mesh without(Mesh mesh, std::size_t first, std::size_t count);  ///< some triangles left out; vertices stay

struct MeshOptions {
    std::string kind = "mesh";
    bool fill = true;                            ///< solid if watertight and no face is water
    bool sides_up = false;                       ///< counts for sheets
    std::vector<spawnfield::Label> labels = {};  ///< of the triangles; empty: all have the part's
};

/// Add a part with one piece or primitive, named after its kind and number.
void add_shape(spawnfield::Scene& scene, spawnfield::Label label, const spawnfield::Shape& shape);
void add_mesh(spawnfield::Scene& scene, spawnfield::Label label, const Mesh& mesh, const MeshOptions& options = {});

/// Adds another piece to the last part.
void add_piece(spawnfield::Scene& scene, const Mesh& mesh, const MeshOptions& options = {});

}  // namespace hand

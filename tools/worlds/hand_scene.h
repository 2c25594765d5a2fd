#pragma once

#include <spawnfield/scene.h>

#include <functional>
#include <string>
#include <vector>

/// Functions that build scenes as plain values, for tests that need neither files nor the file readers.
namespace hand {

/// Faces of one piece; their corners run counterclockwise as seen from outside or from above.
struct Mesh {
    std::vector<spawnfield::Vec3> vertices;
    std::vector<spawnfield::Triangle> triangles;
};

/// Returns the closed body between two heights over a counterclockwise polygon. The whole polygon must be visible from
/// its first corner.
///
/// With n corners, triangles 2 i and 2 i + 1 are the side from corner i to the next corner; from triangle 2 n on,
/// triangles of the bottom and of the top alternate.
Mesh extruded(const std::vector<Eigen::Vector2d>& polygon, double bottom, double top);

Mesh box(const spawnfield::Vec3& size);        ///< centred; the order of the sides is -y, x, y, -x
Mesh rectangle(double size_x, double size_y);  ///< level, centred, facing up

/// Returns a centred sheet of cells x cells squares. The diagonal of each square runs from (smallest x, largest y) to
/// (largest x, smallest y).
Mesh relief(int cells, double size, const std::function<double(double x, double y)>& height);

/// Returns the convex hull of the points. No four points may lie in a plane, and none inside the hull. O(points^4).
Mesh convex_hull(const std::vector<spawnfield::Vec3>& points);

Mesh moved(Mesh mesh, const spawnfield::Pose& pose);
Mesh flipped(Mesh mesh);                                        ///< with the opposite winding
Mesh without(Mesh mesh, std::size_t first, std::size_t count);  ///< without some triangles; keeps all vertices

struct MeshOptions {
    std::string kind = "mesh";
    bool fill = true;                            ///< solid if watertight and no face is water
    bool sides_up = false;                       ///< has an effect on sheets only
    std::vector<spawnfield::Label> labels = {};  ///< of each triangle; empty: all have the label of the part
};

/// Adds a part with one primitive. The name of the part is its kind and number.
void add_shape(spawnfield::Scene& scene, spawnfield::Label label, const spawnfield::Shape& shape);

/// Adds a part with one piece. The name of the part is its kind and number.
void add_mesh(spawnfield::Scene& scene, spawnfield::Label label, const Mesh& mesh, const MeshOptions& options = {});

/// Adds another piece to the last part.
void add_piece(spawnfield::Scene& scene, const Mesh& mesh, const MeshOptions& options = {});

}  // namespace hand

#pragma once

#include <spawnfield/shape.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace spawnfield {

/// A named entry of a scene file. Its geometry lies in the scene's arrays.
struct Part {
    std::string name;
    std::string kind;                  ///< "box", "mesh", …: the key that gave its geometry
    Label label = Label::Obstacle;     ///< of what no rule of the part matches
    std::uint32_t solid_pieces = 0;    ///< primitives, octomap leaves and filled mesh pieces
    std::uint32_t sheet_pieces = 0;    ///< planes, heightmaps, mesh pieces that are not watertight or not to be filled
    std::uint32_t open_edges = 0;      ///< edges of its mesh pieces with an odd number of faces
    std::uint32_t triangles = 0;
};

/// Connected faces of one mesh: filled (solid) or without thickness (sheet).
struct Piece {
    std::uint32_t part = 0;
    std::uint32_t first_triangle = 0, triangle_count = 0;
    bool solid = false;
    bool open = false;      ///< solid by wish, though it has holes: must be told, or the mask claims too much
    bool sides_up = false;  ///< a terrain sheet on which robots stand only where the winding looks up
    double bottom = 0;      ///< lowest z of its vertices, m
};

/// A solid given by equation.
struct Primitive {
    Shape shape;  ///< in the scene's frame
    std::uint32_t part = 0;
    Label label = Label::Obstacle;
};

/// Triangles and primitives of one label.
struct LabelCount {
    std::uint64_t triangles = 0, primitives = 0;
};
using LabelCounts = std::array<LabelCount, 3>;  ///< of Terrain, Obstacle, Water

using Triangle = std::array<std::uint32_t, 3>;

/// The world: triangles and primitives, labelled, in metres, z up. Everything of one part stands together, in the
/// order of the scene file; ignored faces are left out.
struct Scene {
    std::string name;
    std::vector<Part> parts;
    std::vector<Vec3> vertices;                 ///< welded: faces that share a corner share its index
    std::vector<Triangle> triangles;            ///< piece after piece
    std::vector<Label> triangle_labels;         ///< one for each triangle
    std::vector<std::uint32_t> triangle_pieces; ///< one for each triangle
    std::vector<Piece> pieces;
    std::vector<Primitive> primitives;
    std::vector<std::string> notices;  ///< defaults that mattered while reading; for the user to see

    Bounds bounds() const;
    bool has_terrain() const;
    LabelCounts count_labels() const;
};

/// `pattern=label`: faces whose node or material name (meshes), or parts whose name (others), match the glob.
struct LabelRule {
    std::string pattern;
    Label label = Label::Obstacle;
};

/// What the space counts as that an OctoMap has not seen, within the box around all that it has.
enum class Unknown : std::uint8_t { Free, Blocked };

struct SceneOptions {
    std::vector<LabelRule> labels = {};  ///< come before the file's own rules; the first match wins
    char up = 0;                         ///< 'y' or 'z' for a bare mesh; 0: what the format says, else z
    double scale = 1.0;                  ///< m per unit of a bare mesh, > 0
    std::optional<Unknown> unknown = {}; ///< of all OctoMaps; nothing: what the scene file says, else Free
};

/// Reads a scene.yaml (format spawnfield-scene/1), an OctoMap (.bt, .ot) or any mesh that assimp reads.
///
/// A bare mesh or OctoMap is one part named after the file; without label rules all of it is terrain, with a notice.
/// Throws FileError with file, part, key, value and limit. Format: DESIGN.md, formats/scene.md.
Scene load_scene(const std::filesystem::path& file, const SceneOptions& options = {});

}  // namespace spawnfield

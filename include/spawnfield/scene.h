#pragma once

#include <spawnfield/export.h>
#include <spawnfield/shape.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace spawnfield {

/// A named entry of a scene file. Its geometry lies in the scene's arrays.
struct Part {
    std::string name;
    std::string kind;                ///< "box", "mesh", …: the key that gave its geometry
    Label label = Label::Obstacle;   ///< of what no rule of the part matches
    std::uint32_t solid_pieces = 0;  ///< primitives, octomap leaves and filled mesh pieces
    std::uint32_t sheet_pieces = 0;  ///< planes, heightmaps, mesh pieces that are not watertight or not to be filled
    std::uint32_t open_edges = 0;    ///< edges of its mesh pieces with an odd number of faces
    std::uint32_t triangles = 0;
};

/// Connected faces of one mesh: filled (solid) or without thickness (sheet).
struct Piece {
    std::uint32_t part = 0;
    std::uint32_t first_triangle = 0, triangle_count = 0;
    bool solid = false;
    bool open = false;      ///< solid by wish, though it has holes: the mask must know it, or it claims too much
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

/// Where a scene lies in the coordinates of a survey, such as those of a UTM zone: x of the survey = x + x_of_scene /
/// unit.
struct GeoOrigin {
    double x = 0, y = 0;  ///< survey coordinates of the scene's 0, 0, in units
    double unit = 1;      ///< m
    std::string crs;      ///< "EPSG:32611", or the survey's own words; empty: unknown
};

/// A rule by which the collisions of a world got their label, for the user to see.
struct NameRule {
    std::string what;  ///< "plane", "name road*", …
    Label label = Label::Obstacle;
    std::size_t count = 0;  ///< of the collisions that it decided
};

/// Faces of one mesh that have the same node and the same material: label rules take or leave them together.
struct FaceGroup {
    std::uint32_t part = 0;
    std::string node, material;                ///< as the file names them, may be empty
    std::array<std::uint64_t, 4> triangles{};  ///< by label, with those that are ignored
    double low = 0, high = 0;                  ///< lowest and highest z of the vertices, m
};

/// The world: triangles and primitives, labelled, in metres, z up. Everything of one part stands together, in the
/// order of the scene file; ignored faces are left out.
struct Scene {
    std::string name;
    std::vector<Part> parts;
    std::vector<Vec3> vertices;                  ///< welded: faces that share a corner share its index
    std::vector<Triangle> triangles;             ///< piece after piece
    std::vector<Label> triangle_labels;          ///< one for each triangle
    std::vector<std::uint32_t> triangle_pieces;  ///< one for each triangle
    std::vector<Piece> pieces;
    std::vector<Primitive> primitives;
    std::optional<GeoOrigin> origin;     ///< from the first elevation model that knows where it lies
    std::vector<std::string> notices;    ///< defaults that mattered while reading; for the user to see
    std::vector<NameRule> rules;         ///< by which an SDF or URDF world was labelled, in their order
    std::vector<FaceGroup> face_groups;  ///< of all meshes, part after part, in the order of their files
    /// What a map of it covers by default; empty: all of it. Infinite planes reach beyond.
    Bounds map_bounds = {};

    SPAWNFIELD_API Bounds bounds() const;
    SPAWNFIELD_API bool has_terrain() const;
    SPAWNFIELD_API LabelCounts count_labels() const;
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
    /// Labels by slope what no rule matches in meshes, OctoMaps and worlds: what looks up and is less steep than this
    /// is terrain, the rest obstacle. rad, 0 .. pi/2, both excluded; nothing: not asked for.
    std::optional<double> auto_slope = {};
    char up = 0;             ///< 'y' or 'z' for a bare mesh; 0: what the format says, else z
    double scale = 1.0;      ///< m per unit of a bare mesh, > 0
    double wall_height = 0;  ///< m, of the walls of a nav2 map, > 0; 0: 2 m, with a notice
    /// Folders that hold models or ROS packages, for model:// and package:// URIs; then come GZ_SIM_RESOURCE_PATH,
    /// IGN_GAZEBO_RESOURCE_PATH, GAZEBO_MODEL_PATH, and the folders above the file with their `models`.
    std::vector<std::filesystem::path> model_paths = {};
    bool allow_missing = false;  ///< included models that are not found are left out with a notice, not an error
    bool strict = false;         ///< anything else that is missing (a mesh, for example) is an error too, not a notice
    std::string heightmap =
        {};  ///< of a bare elevation model: keys as under `heightmap:`, "size: [513, 513], z: [0, 75]"
    Bounds bounds =
        {};  ///< infinite planes are cut to these, and 50 m beyond; empty: to all the rest and their drawn size
    std::optional<Unknown> unknown = {};  ///< of all OctoMaps; nothing: what the scene file says, else Free
};

/// Reads a scene.yaml (format spawnfield-scene/1), an SDF world or model (.sdf, .world, a model's folder), a URDF, an
/// OctoMap (.bt, .ot), an elevation model (GeoTIFF, ESRI ASCII grid, PNG, raw), a 2D map (map.yaml of nav2 or ROS) or
/// any mesh that assimp reads.
///
/// A bare mesh or OctoMap is one part named after the file; without label rules all of it is terrain, with a notice. So
/// is an elevation model: terrain whose middle lies at 0, 0, with the heights of the file; Scene::origin tells where
/// that is. A 2D map is part "floor", terrain at z = 0 under all cells that are not unknown, and part "walls", boxes on
/// the occupied ones. Of SDF and URDF each collision is a part, named model::link::collision; the options' rules match
/// that name or one of its words between ::. Else planes, heightmaps and what is named as ground is terrain, the rest
/// obstacle. Throws FileError with file, part, key, value and limit.
SPAWNFIELD_API Scene load_scene(const std::filesystem::path& file, const SceneOptions& options = {});

/// The file that a scene is read from: of a model's folder the SDF file that its model.config names. Throws FileError.
SPAWNFIELD_API std::filesystem::path scene_file_of(const std::filesystem::path& scene);

}  // namespace spawnfield

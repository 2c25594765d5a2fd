#pragma once

#include <spawnfield/export.h>
#include <spawnfield/shape.h>

#include <filesystem>
#include <limits>
#include <optional>
#include <vector>

namespace spawnfield {

/// A named entry of a scene file. Its geometry lies in the scene's arrays.
struct Part {
    std::string name;
    std::string kind;                ///< "box", "mesh", …: the key that gave its geometry
    Label label = Label::Obstacle;   ///< label of geometry that no rule of the part matches
    std::uint32_t solid_pieces = 0;  ///< primitives, octomap leaves and filled mesh pieces
    std::uint32_t sheet_pieces = 0;  ///< planes, heightmaps, mesh pieces that are not watertight or must not be filled
    std::uint32_t open_edges = 0;    ///< edges of its mesh pieces with an odd number of faces
    std::uint32_t triangles = 0;
};

/// Connected faces of one mesh: filled (solid) or without thickness (sheet).
struct Piece {
    std::uint32_t part = 0;
    std::uint32_t first_triangle = 0, triangle_count = 0;
    bool solid = false;
    /// It has holes, but it is solid because the user asked for it. The mask uses this, so that it does not prove too
    /// much.
    bool open = false;
    bool sides_up = false;  ///< a terrain sheet on which robots stand only on the side that the winding shows as up
    double bottom = 0;      ///< lowest z of its vertices, m
};

/// A solid that is described by an equation.
struct Primitive {
    Shape shape;  ///< in the scene's frame
    std::uint32_t part = 0;
    Label label = Label::Obstacle;
};

/// Numbers of triangles and primitives with one label.
struct LabelCount {
    std::uint64_t triangles = 0, primitives = 0;
};
using LabelCounts = std::array<LabelCount, 3>;  ///< of Terrain, Obstacle, Water

/// The scene's place in the coordinates of a survey, for example of a UTM zone: x of the survey = x + x_of_scene /
/// unit.
struct GeoOrigin {
    double x = 0, y = 0;  ///< survey coordinates of the scene's point 0, 0, in units
    double unit = 1;      ///< length of the survey's unit, m
    std::string crs;      ///< "EPSG:32611", or the survey's own text; empty: unknown
};

/// A rule that labelled collisions of a world, for the user to see.
struct NameRule {
    std::string what;  ///< "plane", "name road*", …
    Label label = Label::Obstacle;
    std::size_t count = 0;  ///< number of collisions that it labelled
};

/// Faces of one mesh that have the same node and the same material. A label rule matches all of them or none.
struct FaceGroup {
    std::uint32_t part = 0;
    std::string node, material;                ///< names from the file; may be empty
    std::array<std::uint64_t, 4> triangles{};  ///< number for each label, including ignored ones
    double low = 0, high = 0;                  ///< lowest and highest z of the vertices, m
};

/// The world: labelled triangles and primitives, in metres, z up. The elements of a part are adjacent, and parts have
/// the order of the scene file. Ignored faces are left out.
struct Scene {
    std::string name;
    std::vector<Part> parts;
    std::vector<Vec3> vertices;                  ///< welded: faces that share a corner share its index
    std::vector<Triangle> triangles;             ///< piece after piece
    std::vector<Label> triangle_labels;          ///< one for each triangle
    std::vector<std::uint32_t> triangle_pieces;  ///< one for each triangle
    std::vector<Piece> pieces;
    std::vector<Primitive> primitives;
    std::optional<GeoOrigin> origin;   ///< from the first elevation model whose file contains it
    std::vector<std::string> notices;  ///< for the user: for example, defaults that influenced the scene
    /// What was left out because its file is missing or cannot be used, in words. `notices` has these texts, too.
    std::vector<std::string> missing = {};
    std::vector<NameRule> rules;         ///< the rules that labelled an SDF or URDF world, in their order
    std::vector<FaceGroup> face_groups;  ///< of all meshes, part after part, in the order of their files
    /// The face group of each triangle: 1 + its index in face_groups; 0: none. May be shorter than `triangles`; those
    /// behind its end have none.
    std::vector<std::uint32_t> triangle_groups = {};
    bool is_unlabelled = false;     ///< no label was given, so everything became terrain
    bool has_moving_parts = false;  ///< a part has a `path`
    /// The bounds of a map of this scene, unless the caller chooses others; empty: those of the whole scene. Infinite
    /// planes extend beyond them.
    Bounds map_bounds = {};

    SPAWNFIELD_API Bounds bounds() const;
    SPAWNFIELD_API bool has_terrain() const;
    SPAWNFIELD_API LabelCounts count_labels() const;
};

/// `pattern=label`: applies to faces whose node or material name matches the glob, and to other parts whose name
/// matches.
struct LabelRule {
    std::string pattern;
    Label label = Label::Obstacle;
};

/// How the space that an OctoMap has not seen counts, within the box around the space that it has seen.
enum class Unknown : std::uint8_t { Free, Blocked };

/// A window of time, both ends included; default: all time.
struct TimeWindow {
    double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();  ///< s

    bool operator==(const TimeWindow&) const = default;
};

struct SceneOptions {
    std::vector<LabelRule> labels = {};  ///< applied before the file's own rules; the first match decides
    /// Labels the faces of meshes, OctoMaps and worlds that no rule matches: a face that looks up and is less steep
    /// than this is terrain, any other is an obstacle. rad, 0 .. pi/2, both excluded. No value: slopes do not set
    /// labels.
    std::optional<double> auto_slope = {};
    char up = 0;             ///< 'y' or 'z' for a bare mesh; 0: as its format defines, else z
    double scale = 1.0;      ///< m per unit of a bare mesh, > 0
    double wall_height = 0;  ///< height of the walls of a nav2 map, m, > 0; 0: 2 m, with a notice
    /// Folders that contain models or ROS packages, for model:// and package:// URIs. The search continues in
    /// GZ_SIM_RESOURCE_PATH, IGN_GAZEBO_RESOURCE_PATH and GAZEBO_MODEL_PATH, then in the folders above the file and
    /// their `models` folders.
    std::vector<std::filesystem::path> model_paths = {};
    /// Included models that are not found, and files of a scene.yaml that do not exist, are left out with a notice
    /// instead of an error.
    bool allow_missing = false;
    /// Other files that are not found (for example, a mesh), and parts that are far away from all others, are an error
    /// instead of a notice.
    bool strict = false;
    bool any_mesh = false;  ///< read meshes in all formats that assimp reads, not only in those that are tested
    /// Settings of a bare elevation model: keys as under `heightmap:`, for example "size: [513, 513], z: [0, 75]".
    std::string heightmap = {};
    /// Infinite planes are cut 50 m beyond these bounds. Empty: chosen from all other geometry and the drawn sizes
    /// of planes.
    Bounds bounds = {};
    /// A part with a `path` becomes the space that it sweeps in this window.
    TimeWindow time = {};
    std::optional<Unknown> unknown = {};  ///< of all OctoMaps; no value: as the scene file says, else Free
};

/// Reads a scene.yaml (format spawnfield-scene/1), an SDF world or model (.sdf, .world, a model's folder), a URDF, an
/// OctoMap (.bt, .ot), an elevation model (GeoTIFF, ESRI ASCII grid, PNG, raw), a 2D map (map.yaml of nav2 or ROS) or
/// any mesh that assimp reads.
///
/// A bare mesh or OctoMap becomes one part, named after the file. Without label rules, all of it is terrain, with a
/// notice. An elevation model also becomes one part. It is terrain with the heights of the file and its middle at 0, 0;
/// Scene::origin is its place in the survey. A 2D map becomes two parts. "floor" is terrain at z = 0 under all cells
/// that are not unknown, and "walls" are boxes on the occupied cells. In SDF and URDF files, each collision becomes a
/// part with the name model::link::collision. The options' rules match this name or one of its words between "::". If
/// none matches, planes, heightmaps and collisions with a name of ground are terrain, and all else is an obstacle.
/// Throws FileError with the file, part, key, value and limit.
SPAWNFIELD_API Scene load_scene(const std::filesystem::path& file, const SceneOptions& options = {});

/// Returns the file from which a scene is read. For a model's folder, this is the SDF file that its model.config names.
/// Throws FileError.
SPAWNFIELD_API std::filesystem::path scene_file_of(const std::filesystem::path& scene);

}  // namespace spawnfield

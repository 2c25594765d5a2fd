#include "base/input_file.h"
#include "base/number.h"
#include "base/text.h"
#include "robot/urdf.h"
#include "scene/bodies.h"
#include "scene/elements.h"
#include "scene/heightmap.h"
#include "scene/mesh.h"
#include "scene/nav2_map.h"
#include "scene/octomap_part.h"
#include "scene/plausibility.h"
#include "scene/sdf_world.h"
#include "scene/yaml_map.h"

#include <spawnfield/error.h>
#include <spawnfield/scene.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace spawnfield {

namespace fs = std::filesystem;

Bounds Scene::bounds() const
{
    Bounds all;
    for (const Vec3& vertex : vertices) all.extend(vertex);
    for (const Primitive& primitive : primitives) {
        const Bounds box = bounds_of(primitive.shape);
        all.extend(box.min);
        all.extend(box.max);
    }
    return all;
}

bool Scene::has_terrain() const
{
    const auto is_terrain = [](const Primitive& primitive) { return primitive.label == Label::Terrain; };
    return std::find(triangle_labels.begin(), triangle_labels.end(), Label::Terrain) != triangle_labels.end() ||
           std::any_of(primitives.begin(), primitives.end(), is_terrain);
}

LabelCounts Scene::count_labels() const
{
    LabelCounts counts{};
    for (const Label label : triangle_labels) ++counts[std::size_t(label)].triangles;
    for (const Primitive& primitive : primitives) ++counts[std::size_t(primitive.label)].primitives;
    return counts;
}

namespace {

std::uint32_t add_part(Scene& scene, const std::string& name, const std::string& kind, Label label)
{
    Part part;
    part.name = name;
    part.kind = kind;
    part.label = label;
    scene.parts.push_back(std::move(part));
    return static_cast<std::uint32_t>(scene.parts.size() - 1);
}

Label read_label(const YamlMap& map, const std::string& fallback)
{
    const std::string label = map.one_of("label", {"terrain", "obstacle", "water", "ignore"}, fallback);
    for (const Label candidate : {Label::Terrain, Label::Obstacle, Label::Water})
        if (label == to_string(candidate)) return candidate;
    return Label::Ignore;
}

FaceRule read_rule(const YamlMap& rule)
{
    rule.only({"node", "material", "label"});
    if (rule.has("node") == rule.has("material")) rule.fail("needs one of node, material");
    if (!rule.has("label")) rule.fail("label", "is missing");
    const bool by_node = rule.has("node");
    return {rule.text(by_node ? "node" : "material"), by_node, !by_node, read_label(rule, "")};
}

std::vector<FaceRule> either_rules(const std::vector<LabelRule>& rules)
{
    std::vector<FaceRule> out;
    for (const LabelRule& rule : rules) out.push_back({rule.pattern, true, true, rule.label});
    return out;
}

using Names = std::vector<std::string>;

bool matches_one(const std::string& pattern, const Names& names)
{
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) { return matches(pattern, name); });
}

/// A rule that matches nothing is most often a slip of the pen.
void tell_idle_rules(const YamlMap& part, const std::vector<FaceRule>& rules, const MeshNames& names, Scene& scene)
{
    for (const FaceRule& rule : rules) {
        if (rule.node && rule.material) continue;  // from the caller; told when all parts are read
        if (matches_one(rule.pattern, rule.node ? names.nodes : names.materials)) continue;
        scene.notices.push_back(part.file() + ": " + part.place() + ": labels: " + (rule.node ? "node" : "material") + " \"" +
                                rule.pattern + "\" matches nothing");
    }
}

void tell_idle_rules(const fs::path& file, const std::vector<LabelRule>& rules, const Names& names, Scene& scene)
{
    constexpr std::size_t most = 8;
    std::string some;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i) some += (i > 0 ? ", " : "") + names[i];
    if (names.size() > most) some += ", …";
    for (const LabelRule& rule : rules)
        if (!matches_one(rule.pattern, names))
            scene.notices.push_back(file.string() + ": label \"" + rule.pattern + "\" matches no node, material or part; there are " + some);
}

/// Reads a file that the part names; what is wrong with it is told with part and key.
template <class Read>
void in_part(const YamlMap& map, const std::string& key, Read read)
{
    const std::string file = map.text(key);
    try {
        read(file);
    } catch (const FileError& error) {
        map.fail(key, std::string("cannot be used: ") + error.what());
    }
}

MeshOptions read_mesh_options(const YamlMap& part, const SceneOptions& options)
{
    MeshOptions mesh;
    mesh.pose = part.pose();
    mesh.scale = part.scale();
    mesh.up = part.has("up") ? part.one_of("up", {"y", "z"}, "z")[0] : char{0};
    const std::string solid = part.one_of("solid", {"auto", "true", "false"}, "auto");
    mesh.solid = solid == "auto" ? MeshOptions::Solid::Auto : solid == "true" ? MeshOptions::Solid::Yes : MeshOptions::Solid::No;
    mesh.sides_up = part.one_of("sides", {"both", "up"}, "both") == "up";
    mesh.rules = either_rules(options.labels);
    if (part.has("labels"))
        for (const YAML::Node& rule : part.list("labels"))
            mesh.rules.push_back(read_rule({rule, part.file(), part.place() + ": labels"}));
    return mesh;
}

void add_names(const Names& more, Names& names)
{
    for (const std::string& name : more)
        if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// What the parts of a scene.yaml have in common.
struct SceneFile {
    fs::path folder;
    const SceneOptions& options;
    MeshFiles meshes;
    Names names;  ///< that label rules of the options can match

    void add(const Names& more)
    {
        if (!options.labels.empty()) add_names(more, names);  // a scene may have 100,000 names
    }
};

void read_part(const YamlMap& map, SceneFile& file, Scene& scene)
{
    const std::string kind = only_key(map, {"box", "sphere", "cylinder", "capsule", "plane", "mesh", "heightmap", "octomap"},
                                      {"name", "label", "xyz", "rpy", "rpy_deg", "up", "scale", "solid", "sides", "labels", "unknown"});
    if (kind == "mesh") map.only({"name", "label", "xyz", "rpy", "rpy_deg", "mesh", "up", "scale", "solid", "sides", "labels"});
    else if (kind == "plane") map.only({"name", "label", "xyz", "rpy", "rpy_deg", "plane", "sides"});
    else if (kind == "heightmap") map.only({"name", "label", "xyz", "rpy", "rpy_deg", "heightmap", "sides"});
    else if (kind == "octomap") map.only({"name", "label", "xyz", "rpy", "rpy_deg", "octomap", "unknown"});
    else map.only({"name", "label", "xyz", "rpy", "rpy_deg", kind.c_str()});

    Label label = read_label(map, "obstacle");
    const std::string name = map.text("name");
    if (kind != "mesh") {
        file.add({name});
        for (const FaceRule& rule : either_rules(file.options.labels))
            if (matches(rule.pattern, name)) {
                label = rule.label;
                break;
            }
    }
    const std::uint32_t part = add_part(scene, name, kind, label);
    if (kind == "mesh") {
        const MeshOptions mesh = read_mesh_options(map, file.options);
        in_part(map, "mesh", [&](const auto& path) {
            const MeshNames found = append_mesh(scene, part, *file.meshes.read(file.folder / path), mesh);
            tell_idle_rules(map, mesh.rules, found, scene);
            file.add(found.nodes);
            file.add(found.materials);
        });
    } else if (label == Label::Ignore) {
        return;
    } else if (kind == "plane") {
        const auto size = map.positive_pair("plane");
        append_plane(scene, part, size[0], size[1], map.pose(), map.one_of("sides", {"both", "up"}, "both") == "up");
    } else if (kind == "heightmap") {
        const HeightmapOptions heightmap = read_heightmap_options(map.map("heightmap"));
        const bool up = map.one_of("sides", {"both", "up"}, "both") == "up";
        in_part(map.map("heightmap"), "file", [&](const auto& path) {
            const Heightmap found = read_heightmap(file.folder / path, heightmap);
            append_heightmap(scene, part, found, map.pose(), up);
            place_scene(scene, found, map.pose(), map.file() + ": " + map.place());
        });
    } else if (kind == "octomap") {
        const Unknown given = map.one_of("unknown", {"free", "blocked"}, "free") == "blocked" ? Unknown::Blocked : Unknown::Free;
        in_part(map, "octomap", [&](const auto& path) {
            append_octomap(scene, part, file.folder / path, map.pose(), file.options.unknown.value_or(given));
        });
    } else {
        scene.primitives.push_back({read_shape(map, kind), part, label});
        scene.parts[part].solid_pieces = 1;
    }
}

Scene read_scene_yaml(const fs::path& file, const SceneOptions& options)
{
    const YamlMap root = read_yaml(file, "spawnfield-scene/1");
    root.only({"format", "name", "parts"});
    Scene scene;
    scene.name = root.text("name", file.stem().string());
    std::set<std::string> part_names;
    SceneFile common{file.parent_path(), options, {}, {}};
    for (const YAML::Node& node : root.list("parts"))
        if (node.IsMap() && node["mesh"] && node["mesh"].IsScalar()) common.meshes.expect(common.folder / node["mesh"].Scalar());
    std::size_t number = 0;
    for (const YAML::Node& node : root.list("parts")) {
        ++number;
        const YamlMap unnamed(node, file.string(), "part " + std::to_string(number));
        const std::string name = unnamed.text("name");
        const YamlMap map(node, file.string(), "part \"" + name + "\"");
        if (!part_names.insert(name).second) map.fail("name", "is given to an earlier part too, needs to be unique");
        read_part(map, common, scene);
        if (scene.parts.back().name != name && !part_names.insert(scene.parts.back().name).second)
            map.fail("octomap", "has unknown space, but its part's name \"" + scene.parts.back().name + "\" is given to another part");
    }
    if (scene.parts.empty()) root.fail("parts", "is empty, needs at least one part");
    tell_idle_rules(file, options.labels, common.names, scene);
    return scene;
}

/// Of a file by itself: the label of a part with this name.
Label bare_label(const std::string& name, const SceneOptions& options, Label fallback)
{
    for (const LabelRule& rule : options.labels)
        if (matches(rule.pattern, name)) return rule.label;
    return fallback;
}

bool is_elevation_model(const fs::path& file, const std::string& extension, const SceneOptions& options)
{
    if (!options.heightmap.empty() || extension == ".asc" || extension == ".tif" || extension == ".tiff" || extension == ".png") return true;
    if (extension == ".raw" && read_file(file).find('\0') != std::string::npos)  // else text: a mesh that assimp reads
        throw FileError(file.string(), "does not tell what is in it: --heightmap 'raw: {type: float32, rows: R, cols: C}, cell: M' does");
    return false;
}

Scene read_elevation_model(const fs::path& file, const SceneOptions& options)
{
    if (options.up != 0 || options.scale != 1.0)
        throw ArgumentError("load_scene", "up and scale are for a mesh; " + file.string() + " is an elevation model, in metres and z up");
    Scene scene;
    scene.name = file.stem().string();
    const Label label = bare_label(scene.name, options, Label::Terrain);
    const std::uint32_t part = add_part(scene, scene.name, "heightmap", label);
    if (label != Label::Ignore) {
        const Heightmap found = read_heightmap(file, parse_heightmap_options(options.heightmap));
        append_heightmap(scene, part, found, {}, false);
        place_scene(scene, found, {}, file.string());
    }
    tell_idle_rules(file, options.labels, {scene.name}, scene);
    return scene;
}

Scene read_nav2_scene(const fs::path& file, const SceneOptions& options)
{
    if (options.up != 0 || options.scale != 1.0 || !options.heightmap.empty())
        throw ArgumentError("load_scene", "up and scale are for a mesh, --heightmap for an elevation model; " + file.string() + " is a 2D map");
    if (!(options.wall_height >= 0) || !std::isfinite(options.wall_height)) throw ArgumentError("load_scene", "wall_height", options.wall_height, "> 0 m");
    constexpr double usual_height = 2;
    const Nav2Map map = read_nav2_map(file);
    if (std::find(map.cells.begin(), map.cells.end(), Nav2Map::Cell::Free) == map.cells.end())
        throw FileError(file.string(), "has no free cell (" + std::to_string(map.cols) + " x " + std::to_string(map.rows) + "); are negate and the thresholds right?");
    Scene scene;
    scene.name = file.stem().string();
    scene.notices = map.notices;
    if (options.wall_height == 0) scene.notices.push_back(file.string() + ": walls are " + number(usual_height) + " m high (--wall-height sets it)");
    append_nav2_map(scene, map, bare_label("floor", options, Label::Terrain), bare_label("walls", options, Label::Obstacle),
                    options.wall_height > 0 ? options.wall_height : usual_height);
    tell_idle_rules(file, options.labels, {"floor", "walls"}, scene);
    return scene;
}

bool is_octomap(const std::string& extension) { return extension == ".bt" || extension == ".ot"; }

Scene read_bare_file(const fs::path& file, const std::string& extension, const SceneOptions& options)
{
    Scene scene;
    scene.name = file.stem().string();
    Label fallback = Label::Obstacle;
    if (options.labels.empty()) {
        fallback = Label::Terrain;
        scene.notices.push_back(file.string() + ": no label given, so everything is terrain (--label 'GLOB=LABEL' tells it apart)");
    }
    if (is_octomap(extension)) {
        if (options.up != 0 || options.scale != 1.0)
            throw ArgumentError("load_scene", "up and scale are for a mesh; " + file.string() + " is an OctoMap, in metres and z up");
        const Label label = bare_label(scene.name, options, fallback);
        const std::uint32_t part = add_part(scene, scene.name, "octomap", label);
        if (label != Label::Ignore) append_octomap(scene, part, file, {}, options.unknown.value_or(Unknown::Free));
        tell_idle_rules(file, options.labels, {scene.name}, scene);
        return scene;
    }
    MeshOptions mesh;
    mesh.scale = Vec3::Constant(options.scale);
    mesh.up = options.up;
    mesh.rules = either_rules(options.labels);
    const MeshNames found = append_mesh(scene, add_part(scene, scene.name, "mesh", fallback), read_mesh(file), mesh);
    Names names;
    add_names(found.nodes, names);
    add_names(found.materials, names);
    tell_idle_rules(file, options.labels, names, scene);
    return scene;
}

void tell_some(const fs::path& file, const Names& names, const std::string& what, Scene& scene)
{
    constexpr std::size_t most = 5;
    if (names.empty()) return;
    std::string some;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i) some += (i > 0 ? ", " : "") + names[i];
    scene.notices.push_back(file.string() + ": " + std::to_string(names.size()) + " " + what + ": " + some + (names.size() > most ? ", …" : ""));
}

void tell_guessed(const fs::path& file, const ModelPaths& paths, Scene& scene)
{
    Names guessed;
    for (const fs::path& folder : paths.guessed()) guessed.push_back(folder.string());
    tell_some(file, guessed, guessed.size() == 1 ? "folder of models was found above the file (--model-path names others)" : "folders of models were found above the file (--model-path names others)", scene);
}

Scene read_sdf_scene(const fs::path& file, const SceneOptions& options)
{
    ModelPaths paths(options.model_paths, file);
    SdfWorld world = read_sdf_world(file, paths);
    if (world.model_count == 0)
        throw FileError(file.string(), "has no models, so nothing to stand on; what is spawned into it at run time has to be in the file");
    Scene scene;
    scene.name = world.name.empty() || world.name == "default" ? file.stem().string() : world.name;
    scene.notices = std::move(world.notices);
    append_bodies(scene, file, std::move(world.bodies), paths, options, std::move(world.missing));
    tell_some(file, world.bare_models, world.bare_models.size() == 1 ? "model has no collision and is not there for a robot" : "models have no collision and are not there for a robot", scene);
    if (world.actor_count > 0) scene.notices.push_back(file.string() + ": <actor>: " + std::to_string(world.actor_count) + " left out, as they move");
    if (world.road_count > 0) scene.notices.push_back(file.string() + ": <road>: " + std::to_string(world.road_count) + " left out, as they are only seen");
    tell_guessed(file, paths, scene);
    return scene;
}

/// A world that is spawned as a URDF, at the origin.
Scene read_urdf_scene(const fs::path& file, const SceneOptions& options)
{
    ModelPaths paths(options.model_paths, file);
    UrdfModel model = read_urdf_model(file, {});
    Scene scene;
    scene.name = model.name;
    scene.notices = std::move(model.notices);
    append_bodies(scene, file, std::move(model.bodies), paths, options, {});
    tell_guessed(file, paths, scene);
    return scene;
}

}  // namespace

fs::path scene_file_of(const fs::path& scene) { return fs::is_directory(scene) ? sdf_file_of(scene) : scene; }

Scene load_scene(const fs::path& scene_path, const SceneOptions& options)
{
    if (!(options.scale > 0) || !std::isfinite(options.scale))
        throw ArgumentError("load_scene", "scale", options.scale, "> 0 m per unit");
    const fs::path file = scene_file_of(scene_path);
    if (!fs::is_regular_file(file)) throw FileError(file.string(), fs::exists(file) ? "is no file" : "does not exist; is the path right?");
    const std::string extension = lower_case(file.extension().string());
    if ((extension == ".yaml" || extension == ".yml") && is_nav2_map(file)) return read_nav2_scene(file, options);
    if (options.wall_height != 0) throw ArgumentError("load_scene", "wall_height is for a 2D map; " + file.string() + " is none");
    const bool yaml = extension == ".yaml" || extension == ".yml", sdf = extension == ".sdf" || extension == ".world", urdf = extension == ".urdf";
    const bool gazebo = sdf || urdf;
    if ((yaml || gazebo) && (options.up != 0 || options.scale != 1.0))
        throw ArgumentError("load_scene", "up and scale are for a bare mesh; " +
                                              (gazebo ? "Gazebo takes a world as it is" : "give them in " + file.string() + " (keys up, scale)"));
    if ((yaml || gazebo) && !options.heightmap.empty())
        throw ArgumentError("load_scene", "--heightmap is for an elevation model by itself" + (yaml ? "; give the keys in " + file.string() + " (heightmap)" : std::string()));
    Scene scene = yaml                                           ? read_scene_yaml(file, options)
                  : sdf                                          ? read_sdf_scene(file, options)
                  : urdf                                         ? read_urdf_scene(file, options)
                  : is_elevation_model(file, extension, options) ? read_elevation_model(file, options)
                                                                 : read_bare_file(file, extension, options);
    const auto is_octomap_part = [](const Part& part) { return part.kind == "octomap"; };
    if (options.unknown && std::none_of(scene.parts.begin(), scene.parts.end(), is_octomap_part))
        scene.notices.push_back(file.string() + ": has no OctoMap, so --unknown has no effect");
    if (element_count(scene) == 0) throw FileError(file.string(), "has no geometry: all of it is ignored" + std::string(gazebo ? ", missing or without collision" : ""));
    const Remedies remedies = yaml     ? Remedies{"scale of its part:", "up of its part"}
                              : gazebo ? Remedies{"<scale> of its mesh:", "Gazebo takes a mesh's own axes, so the model's <pose>"}
                                       : Remedies{"--scale", "--up y or z"};
    for (std::string& doubt : doubts_about(scene, file.string(), remedies)) scene.notices.push_back(std::move(doubt));
    return scene;
}

}  // namespace spawnfield

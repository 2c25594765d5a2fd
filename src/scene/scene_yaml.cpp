#include "scene/scene_yaml.h"

#include "base/number.h"
#include "base/yaml_map.h"
#include "scene/heightmap.h"
#include "scene/label_rules.h"
#include "scene/moving_part.h"
#include "scene/octomap_part.h"
#include "scene/pieces.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <algorithm>
#include <numbers>
#include <set>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

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
    if (!rule.has("node") && !rule.has("material"))
        rule.fail("has neither node nor material, needs one of them or both (then both must match)");
    if (!rule.has("label")) rule.fail("label", "is missing");
    return {rule.text("node", "*"), rule.text("material", "*"), read_label(rule, "")};
}

/// Adds a notice for each rule of a part that matches nothing, because it is most often a typing error.
void note_unused_rules(const YamlMap& part, const std::vector<FaceRule>& rules, std::span<const FaceGroup> groups,
                       Scene& scene)
{
    for (const FaceRule& rule : rules) {
        if (rule.either) continue;  // from the caller; checked when all parts are read
        if (std::any_of(groups.begin(), groups.end(),
                        [&](const FaceGroup& group) { return rule.matches(group.node, group.material); }))
            continue;
        const std::string node = rule.node == "*" ? "" : "node \"" + rule.node + "\"",
                          material = rule.material == "*" ? "" : "material \"" + rule.material + "\"";
        scene.notices.push_back(part.file() + ": " + part.place() + ": labels: " + node +
                                (node.empty() || material.empty() ? "" : " with ") + material + " matches nothing");
    }
}

/// State that all parts of a scene.yaml share.
struct SceneFile {
    fs::path folder;
    const SceneOptions& options;
    MeshFiles meshes;
    Names names;  ///< names that label rules of the options can match

    void add(const Names& more)
    {
        if (!options.labels.empty()) add_names(more, names);  // a scene may have 100,000 names
    }
};

/// Calls read(file) for a file that the part names. An error in the file is reported with the part and the key. With
/// SceneOptions::allow_missing, a part whose file does not exist has no geometry.
template <class Read>
void in_part(const YamlMap& map, const std::string& key, const SceneFile& common, Scene& scene, Read read)
{
    const fs::path file = common.folder / map.text(key);
    if (common.options.allow_missing && is_missing(file)) {
        scene.missing.push_back(map.file() + ": " + map.place() + ": " + key + ": " + file.string() +
                                " is not found: it is ignored");
        scene.notices.push_back(scene.missing.back());
        return;
    }
    try {
        read(file);
    } catch (const FileError& error) {
        map.fail(key, std::string("cannot be used: ") + error.what());
    }
}

/// Returns the slope (rad) for labelling by slope, from the options or else from the part; empty if the part has its
/// own label.
std::optional<double> read_auto_slope(const YamlMap& part, const SceneOptions& options)
{
    if (!part.has("auto_label")) return part.has("label") ? std::nullopt : options.auto_slope;
    if (part.has("label"))
        part.fail("auto_label", "is given together with label, needs only one of them (labels: is allowed)");
    const YamlMap keys = part.map("auto_label");
    keys.only({"slope"});
    const double degrees = keys.positive("slope");
    if (!(degrees < 90)) keys.fail("slope", "is " + number(degrees) + ", needs > 0 and < 90 degrees");
    return options.auto_slope ? options.auto_slope : degrees * std::numbers::pi / 180;
}

MeshOptions read_mesh_options(const YamlMap& part, const SceneOptions& options)
{
    MeshOptions mesh;
    mesh.pose = part.pose();
    mesh.scale = part.scale();
    mesh.up = part.has("up") ? part.one_of("up", {"y", "z"}, "z")[0] : char{0};
    const std::string solid = part.one_of("solid", {"auto", "true", "false"}, "auto");
    mesh.solid = solid == "auto" ? Solid::Auto : solid == "true" ? Solid::Yes : Solid::No;
    mesh.sides_up = part.one_of("sides", {"both", "up"}, "both") == "up";
    mesh.auto_slope = read_auto_slope(part, options);
    mesh.rules = face_rules(options.labels);
    if (part.has("labels"))
        for (const YAML::Node& rule : part.list("labels"))
            mesh.rules.push_back(read_rule({rule, part.file(), part.place() + ": labels"}));
    return mesh;
}

/// Reads the poses of `path:`. Times ascend, and a turn has a clear direction.
TimedPath read_path(const YamlMap& part)
{
    TimedPath out;
    for (const YAML::Node& node : part.list("path")) {
        const YamlMap pose(node, part.file(), part.place() + ": path: pose " + std::to_string(out.size() + 1));
        pose.only({"time", "xyz", "rpy", "rpy_deg"});
        const TimedPose next{pose.finite("time"), pose.pose()};
        if (!out.empty() && next.time <= out.back().time)
            pose.fail("time", "is " + number(next.time) + " s, needs to be later than the pose before (" +
                                  number(out.back().time) + " s)");
        if (!out.empty() && is_half_turn(out.back().pose, next.pose))
            pose.fail("is turned by half a turn, so the direction of the turn is not clear; add a pose between");
        out.push_back(next);
    }
    if (out.size() < 2) part.fail("path", "needs at least 2 poses: [{time: 0, xyz: [0, 0, 0]}, …]");
    return out;
}

/// Reads a part that moves. It becomes the space that it sweeps.
void read_moving_part(const YamlMap& map, const std::string& kind, SceneFile& file, Scene& scene)
{
    if (kind == "mesh")
        map.only({"name", "label", "path", "mesh", "up", "scale", "solid"});
    else if (kind == "box" || kind == "sphere" || kind == "cylinder" || kind == "capsule")
        map.only({"name", "label", "path", kind.c_str()});
    else
        map.fail("path", "is given for a " + kind + "; only box, sphere, cylinder, capsule and mesh can move");
    const std::string name = map.text("name");
    file.add({name});
    const Label label = label_by_name(name, file.options.labels, read_label(map, "obstacle"));
    const TimedPath path = read_path(map);
    const std::uint32_t part = add_part(scene, name, kind, label);
    if (label == Label::Ignore) return;
    if (label != Label::Obstacle)
        map.fail("label", std::string("is ") + to_string(label) + ", but a part that moves is always an obstacle");
    const TimeWindow& window = file.options.time;
    scene.has_moving_parts = true;
    if (window == TimeWindow{})
        scene.notices.push_back(map.file() + ": " + map.place() + " moves; all places on its path count");
    if (kind != "mesh") return append_swept(scene, part, read_shape(map, kind), path, window);
    Scene still;
    add_part(still, name, kind, label);
    MeshOptions mesh = read_mesh_options(map, file.options);
    mesh.rules.clear();
    mesh.auto_slope.reset();
    in_part(map, "mesh", file, scene,
            [&](const fs::path& from) { append_mesh(still, 0, *file.meshes.read(from), mesh); });
    append_swept(scene, part, still, path, window);
    scene.parts[part].open_edges = still.parts[0].open_edges;
    scene.notices.insert(scene.notices.end(), still.notices.begin(), still.notices.end());
}

void read_part(const YamlMap& map, SceneFile& file, Scene& scene)
{
    const std::string kind = only_key(map,
                                      {"box", "sphere", "cylinder", "capsule", "plane", "mesh", "heightmap", "octomap"},
                                      {"name", "label", "path", "xyz", "rpy", "rpy_deg", "up", "scale", "solid",
                                       "sides", "labels", "auto_label", "unknown"});
    if (map.has("path")) return read_moving_part(map, kind, file, scene);
    if (kind == "mesh")
        map.only({"name", "label", "xyz", "rpy", "rpy_deg", "mesh", "up", "scale", "solid", "sides", "labels",
                  "auto_label"});
    else if (kind == "plane")
        map.only({"name", "label", "xyz", "rpy", "rpy_deg", "plane", "sides"});
    else if (kind == "heightmap")
        map.only({"name", "label", "xyz", "rpy", "rpy_deg", "heightmap", "sides"});
    else if (kind == "octomap")
        map.only({"name", "label", "xyz", "rpy", "rpy_deg", "octomap", "auto_label", "unknown"});
    else
        map.only({"name", "label", "xyz", "rpy", "rpy_deg", kind.c_str()});

    Label label = read_label(map, "obstacle");
    const std::string name = map.text("name");
    const std::vector<LabelRule>& rules = file.options.labels;
    const bool by_name = kind != "mesh" && std::any_of(rules.begin(), rules.end(), [&](const LabelRule& rule) {
                             return matches(rule.pattern, name);
                         });
    if (kind != "mesh") {
        file.add({name});
        label = label_by_name(name, file.options.labels, label);
    }
    const std::uint32_t part = add_part(scene, name, kind, label);
    if (kind == "mesh") {
        const MeshOptions mesh = read_mesh_options(map, file.options);
        in_part(map, "mesh", file, scene, [&](const fs::path& path) {
            const std::span<const FaceGroup> groups = append_mesh(scene, part, *file.meshes.read(path), mesh);
            note_unused_rules(map, mesh.rules, groups, scene);
            file.add(names_of(groups));
        });
    } else if (label == Label::Ignore) {
        return;
    } else if (kind == "plane") {
        const auto size = map.positive_pair("plane");
        append_plane(scene, part, size[0], size[1], map.pose(), map.one_of("sides", {"both", "up"}, "both") == "up");
    } else if (kind == "heightmap") {
        const HeightmapOptions heightmap = read_heightmap_options(map.map("heightmap"));
        const bool up = map.one_of("sides", {"both", "up"}, "both") == "up";
        in_part(map.map("heightmap"), "file", file, scene, [&](const fs::path& path) {
            const Heightmap found = read_heightmap(path, heightmap);
            append_heightmap(scene, part, found, map.pose(), up);
            place_scene(scene, found, map.pose(), map.file() + ": " + map.place());
        });
    } else if (kind == "octomap") {
        const Unknown given = map.one_of("unknown", {"free", "blocked"}, "free") == "blocked" ? Unknown::Blocked
                                                                                              : Unknown::Free;
        in_part(map, "octomap", file, scene, [&](const fs::path& path) {
            append_octomap(scene, part, path, map.pose(), file.options.unknown.value_or(given),
                           by_name ? std::nullopt : read_auto_slope(map, file.options));
        });
    } else {
        scene.primitives.push_back({read_shape(map, kind), part, label});
        scene.parts[part].solid_pieces = 1;
    }
}

}  // namespace

Scene read_scene_yaml(const fs::path& file, const SceneOptions& options)
{
    const YamlMap root = read_yaml(file, "spawnfield-scene/1");
    root.only({"format", "name", "parts"});
    Scene scene;
    scene.name = root.text("name", file.stem().string());
    std::set<std::string> part_names;
    SceneFile common{file.parent_path(), options, MeshFiles(mesh_formats(options.any_mesh)), {}};
    for (const YAML::Node& node : root.list("parts"))
        if (node.IsMap() && node["mesh"] && node["mesh"].IsScalar())
            common.meshes.expect(common.folder / node["mesh"].Scalar());
    std::size_t number = 0;
    for (const YAML::Node& node : root.list("parts")) {
        ++number;
        const YamlMap unnamed(node, file.string(), "part " + std::to_string(number));
        const std::string name = unnamed.text("name");
        const YamlMap map(node, file.string(), "part \"" + name + "\"");
        if (!part_names.insert(name).second)
            map.fail("name", "is also the name of an earlier part, needs to be unique");
        read_part(map, common, scene);
        if (scene.parts.back().name != name && !part_names.insert(scene.parts.back().name).second)
            map.fail("octomap", "has unknown space, but its part's name \"" + scene.parts.back().name +
                                    "\" is already used; rename one of the parts");
    }
    if (scene.parts.empty()) root.fail("parts", "is empty, needs at least one part");
    note_unused_rules(file, options.labels, common.names, scene);
    return scene;
}

}  // namespace spawnfield

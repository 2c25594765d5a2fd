#include "scene_args.h"

#include "numbers.h"
#include "spelling.h"

#include <numbers>
#include <sstream>

namespace spawnfield::cli {
namespace {

LabelRule parse_label(const std::string& text)
{
    const std::size_t equals = text.rfind('=');
    const std::string name = equals == std::string::npos ? "" : text.substr(equals + 1);
    for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water, Label::Ignore})
        if (name == to_string(label) && equals > 0) return {text.substr(0, equals), label};
    throw ArgumentError("--label is \"" + text + "\", needs GLOB=terrain, GLOB=obstacle, GLOB=water or GLOB=ignore");
}

/// Returns the slope of --auto-label, rad. Throws ArgumentError.
double parse_slope(const std::string& text)
{
    const std::string key = "slope=";
    std::istringstream number(text.starts_with(key) ? text.substr(key.size()) : "");
    double degrees = 0;
    if (!(number >> degrees) || !number.eof() || !(degrees > 0 && degrees < 90))
        throw ArgumentError("--auto-label is \"" + text +
                            "\", needs slope=DEG with more than 0 and less than 90 degrees, for example slope=30");
    return degrees * std::numbers::pi / 180;
}

}  // namespace

void add_label_options(CLI::App& command, SceneArgs& args)
{
    command
        .add_option("--label", args.labels,
                    "'GLOB=LABEL': label of all nodes, materials, parts, models, links or collisions whose name "
                    "matches (repeatable; the first match wins)")
        ->allow_extra_args(false);
    command.add_option("--auto-label", args.auto_label,
                       "slope=DEG: label by slope what no label names. Faces that look up and are less steep than DEG "
                       "degrees are terrain, others obstacles (meshes, OctoMaps, worlds)");
}

void add_scene_options(CLI::App& command, SceneArgs& args)
{
    start_group(command, help_group::scene);
    command.add_option("--up", args.up, "Up axis of a bare mesh: y or z (default: the format's own, else z)")
        ->check(one_of({"y", "z"}));
    command.add_option("--scale", args.scale, "Metres per unit of a bare mesh (default 1)");
    command.add_option("--heightmap", args.heightmap,
                       "Keys of a bare elevation model as in scene.yaml: 'size: [513, 513], z: [0, 75]'");
    command
        .add_option("--unknown", args.unknown,
                    "free or blocked: meaning of unknown space in an OctoMap, inside the box around all known space "
                    "(default: that of scene.yaml, else free)")
        ->check(one_of({"free", "blocked"}));
    command.add_option("--wall-height", args.wall_height,
                       "Height of the walls of a 2D map (map.yaml of nav2 or ROS), m (default 2)");
    auto* strict = command.add_flag(
        "--strict", args.strict,
        "Refuse a world with a missing file, for example a mesh (missing includes are always refused), or with a part "
        "far away from all others");
    command
        .add_flag("--allow-missing", args.allow_missing,
                  "Leave out included models, and files of a scene.yaml, that are not found")
        ->excludes(strict);
}

SceneOptions scene_options(const SceneArgs& args, const ModelPathArgs& paths)
{
    SceneOptions options;
    for (const std::string& label : args.labels) options.labels.push_back(parse_label(label));
    options.up = args.up.empty() ? char{0} : args.up[0];
    options.scale = parse_positive("--scale", args.scale);
    if (!args.auto_label.empty()) options.auto_slope = parse_slope(args.auto_label);
    if (!args.unknown.empty()) options.unknown = args.unknown == "blocked" ? Unknown::Blocked : Unknown::Free;
    options.heightmap = args.heightmap;
    if (args.wall_height) options.wall_height = parse_positive("--wall-height", *args.wall_height);
    options.model_paths.assign(paths.model_paths.begin(), paths.model_paths.end());
    options.any_mesh = paths.any_mesh;
    options.strict = args.strict;
    options.allow_missing = args.allow_missing;
    return options;
}

}  // namespace spawnfield::cli

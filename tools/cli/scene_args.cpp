#include "scene_args.h"

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

}  // namespace

void add_scene_options(CLI::App& command, SceneArgs& args)
{
    command.add_option("--up", args.up, "Up axis of a bare mesh: y or z (default: what the format says, else z)")
        ->check(one_of({"y", "z"}));
    command.add_option("--scale", args.scale, "Metres per unit of a bare mesh (default 1)");
    command.add_option("--heightmap", args.heightmap, "Keys of a bare elevation model as in scene.yaml: 'size: [513, 513], z: [0, 75]'");
    command.add_option("--unknown", args.unknown, "What an OctoMap has not seen, within the box around what it has: free or blocked (default: free, or what scene.yaml says)")
        ->check(one_of({"free", "blocked"}));
    command.add_option("--wall-height", args.wall_height, "Of the walls of a 2D map (map.yaml of nav2 or ROS), m (default 2)");
    command.add_option("--label", args.labels,
                       "'GLOB=LABEL': label of the nodes, materials, parts, models, links or collisions whose name matches (repeatable; first match wins)");
    command.add_flag("--strict", args.strict, "Refuse a world of which a model or a mesh is missing");
}

SceneOptions scene_options(const SceneArgs& args, const ModelPathArgs& paths)
{
    SceneOptions options;
    for (const std::string& label : args.labels) options.labels.push_back(parse_label(label));
    options.up = args.up.empty() ? char{0} : args.up[0];
    options.scale = parse_positive("--scale", args.scale);
    if (!args.unknown.empty()) options.unknown = args.unknown == "blocked" ? Unknown::Blocked : Unknown::Free;
    options.heightmap = args.heightmap;
    if (args.wall_height) options.wall_height = parse_positive("--wall-height", *args.wall_height);
    options.model_paths.assign(paths.model_paths.begin(), paths.model_paths.end());
    options.strict = args.strict;
    return options;
}

}  // namespace spawnfield::cli

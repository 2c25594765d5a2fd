#include "cli.h"

#include <spawnfield/error.h>
#include <spawnfield/map.h>

#include <cstdio>

namespace spawnfield::cli {
namespace {

struct BakeArgs : CommonArgs {
    std::string scene, out, bounds, up, unknown;
    double resolution = 0, occupancy_resolution = 0, scale = 1;
    std::vector<std::string> labels;
    bool allow_no_terrain = false;
};

LabelRule parse_label(const std::string& text)
{
    const std::size_t equals = text.rfind('=');
    const std::string name = equals == std::string::npos ? "" : text.substr(equals + 1);
    for (const Label label : {Label::Terrain, Label::Obstacle, Label::Water, Label::Ignore})
        if (name == to_string(label) && equals > 0) return {text.substr(0, equals), label};
    throw ArgumentError("--label is \"" + text + "\", needs GLOB=terrain, GLOB=obstacle, GLOB=water or GLOB=ignore");
}

std::string words(const BakeReport& report)
{
    char megabytes[32];
    std::snprintf(megabytes, sizeof megabytes, "%.1f MB", double(report.bytes) / 1e6);
    return counted(std::uint64_t(report.layers), "layer") + ", " + std::to_string(report.occupancy_leaves) + " occupancy leaves, " + megabytes;
}

int run_bake(const BakeArgs& args, bool resolution_given, bool occupancy_given)
{
    Summary summary("bake", args);
    SceneOptions scene_options;
    for (const std::string& label : args.labels) scene_options.labels.push_back(parse_label(label));
    scene_options.up = args.up.empty() ? char{0} : args.up[0];
    scene_options.scale = parse_positive("--scale", args.scale);
    if (!args.unknown.empty()) scene_options.unknown = args.unknown == "blocked" ? Unknown::Blocked : Unknown::Free;
    BakeOptions options;
    if (resolution_given) options.resolution = parse_positive("--resolution", args.resolution);
    if (occupancy_given) options.occupancy_resolution = parse_positive("--occupancy-resolution", args.occupancy_resolution);
    if (!args.bounds.empty()) options.bounds = parse_bounds("--bounds", args.bounds, false);
    options.allow_no_terrain = args.allow_no_terrain;
    options.threads = args.threads;
    options.progress = progress_bar(args, "bake");

    Scene scene = load_scene(args.scene, scene_options);
    for (const std::string& text : scene.notices) notice(args, text);
    summary.lap("load");
    const BakeReport report = bake(std::move(scene), args.scene, args.out, options);
    for (const std::string& text : report.notices) notice(args, text);
    summary.lap("bake");
    summary.more_stages = report.seconds;
    summary.map_hash = report.hash;
    summary.extra = {args.out, words(report)};
    summary.finish();
    return done;
}

}  // namespace

void add_bake(CLI::App& app, Run& run)
{
    auto args = std::make_shared<BakeArgs>();
    CLI::App& command = *app.add_subcommand("bake", "Make a map from a scene");
    command.add_option("scene", args->scene, "scene.yaml, a mesh (any format assimp reads) or an OctoMap (.bt, .ot)")->required();
    command.add_option("--out,-o", args->out, "Map folder to write; an older map there is replaced")->required();
    auto* resolution = command.add_option("--resolution", args->resolution, "Side of a terrain cell, m (default 0.1)");
    auto* occupancy = command.add_option("--occupancy-resolution", args->occupancy_resolution, "Side of a voxel, m (default 2.5 cells)");
    command.add_option("--bounds", args->bounds, "x0,y0,z0,x1,y1,z1 in m (default: the scene's)");
    command.add_option("--up", args->up, "Up axis of a bare mesh: y or z (default: what the format says, else z)")->check(CLI::IsMember({"y", "z"}));
    command.add_option("--scale", args->scale, "Metres per unit of a bare mesh (default 1)");
    command.add_option("--label", args->labels, "'GLOB=LABEL': label of the nodes, materials or parts whose name matches (repeatable; first match wins)");
    command.add_option("--unknown", args->unknown, "What an OctoMap has not seen, within the box around what it has: free or blocked (default: free, or what scene.yaml says)")
        ->check(CLI::IsMember({"free", "blocked"}));
    command.add_flag("--allow-no-terrain", args->allow_no_terrain, "Bake a scene in which nothing is terrain");
    add_common(command, *args);
    command.footer("Example:\n  spawnfield bake maps/training/scene.yaml -o /tmp/training");
    command.callback([=, &run] {
        run = [=] { return run_bake(*args, resolution->count() > 0, occupancy->count() > 0); };
    });
}

}  // namespace spawnfield::cli

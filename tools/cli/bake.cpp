#include "command.h"
#include "host.h"
#include "ground_args.h"
#include "messages.h"
#include "numbers.h"
#include "scene_args.h"
#include "session.h"

#include <spawnfield/bake.h>
#include <spawnfield/error.h>

#include <cstdio>

namespace spawnfield::cli {
namespace {

struct BakeArgs : CommonArgs, SceneArgs, ModelPathArgs {
    std::string scene, out, bounds, z;
    std::vector<std::string> update;
    double resolution = 0, occupancy_resolution = 0;
    bool allow_no_terrain = false;
};

std::string words(const BakeReport& report)
{
    char megabytes[32];
    std::snprintf(megabytes, sizeof megabytes, "%.1f MB", double(report.bytes) / 1e6);
    return counted(std::uint64_t(report.layers), "layer") + ", " + std::to_string(report.occupancy_leaves) +
           " occupancy leaves, " + megabytes;
}

Ending run_bake(const BakeArgs& args, const CLI::App& command, Summary& summary)
{
    SceneOptions reading = scene_options(args, args);
    BakeOptions options;
    if (command.count("--resolution") > 0) options.resolution = parse_positive("--resolution", args.resolution);
    if (command.count("--occupancy-resolution") > 0)
        options.occupancy_resolution = parse_positive("--occupancy-resolution", args.occupancy_resolution);
    if (!args.bounds.empty()) options.bounds = parse_bounds("--bounds", args.bounds, false);
    if (!args.z.empty() && !args.bounds.empty())
        throw ArgumentError("--z and --bounds both limit heights; give one of them");
    if (!args.z.empty()) options.z = parse_z("--z", args.z);
    options.allow_no_terrain = args.allow_no_terrain;
    options.max_memory = memory_limit(args);
    options.threads = args.threads;
    options.progress = progress_bar(args, "bake");

    reading.bounds = options.bounds;
    Scene scene = open_scene(args, args.scene, reading);
    summary.lap("load");
    const bool is_in_memory = args.host->input<Scene>(args.scene) != nullptr;
    const std::filesystem::path file = is_in_memory ? std::filesystem::path() : scene_file_of(args.scene);
    const BakeReport report = args.update.empty() ? bake(std::move(scene), file, args.out, options)
                                                  : update_map(std::move(scene), file, args.out, args.update, options);
    for (const std::string& text : report.notices) notice(args, text);
    summary.lap("bake");
    summary.more_stages = report.seconds;
    summary.map_hash = report.hash;
    summary.extra = {args.out, words(report)};
    return {};
}

}  // namespace

void add_bake(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<BakeArgs>();
    CLI::App& command = *app.add_subcommand("bake", "Make a map from a scene");
    command
        .add_option(
            "scene", args->scene,
            "scene.yaml, a Gazebo world or model (.world, .sdf, a model's folder), a mesh (3ds, 3mf, dae, fbx, glb, "
            "gltf, obj, off, ply or stl; others with --any-mesh), an OctoMap (.bt), an elevation model (.tif, .asc, "
            ".png, .raw) or a 2D map (map.yaml of nav2 or ROS)")
        ->required();
    command.add_option("--out,-o", args->out, "Map folder to write; an older map there is replaced")
        ->required()
        ->check(not_empty());
    add_label_options(command, *args);
    add_model_path(command, *args);
    add_trusted(command, *args);
    command.add_option("--resolution", args->resolution, "Side of a terrain cell, m (default 0.1)");
    command.add_option("--occupancy-resolution", args->occupancy_resolution, "Side of a voxel, m (default 2.5 cells)");
    command.add_option("--bounds", args->bounds,
                       "x0,y0,z0,x1,y1,z1 in m (default: the scene's). z0 and z1 are z limits: layers beyond them are "
                       "not ground, and poses beyond them are outside");
    command.add_option("--z", args->z,
                       "LOW:HIGH in m: only z limits; x and y are the scene's (5: or :8 for one limit)");
    command
        .add_option("--update", args->update,
                    "Bake only the region of these parts again, which were moved, changed, added or removed since MAP "
                    "was baked: PART,... (globs; '*' finds all changes). Gives the same files as a full bake")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(not_empty());
    add_scene_options(command, *args);
    command.add_flag("--allow-no-terrain", args->allow_no_terrain, "Accept a scene without terrain");
    add_common(command, *args);
    command.footer(
        "Example:\n  spawnfield bake maps/training/scene.yaml -o /tmp/training\n"
        "  spawnfield bake maps/training/scene.yaml -o /tmp/training --update 'cube*,thin_wall'");
    set_work(command, args, chosen, run_bake);
}

}  // namespace spawnfield::cli

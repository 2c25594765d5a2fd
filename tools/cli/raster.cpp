#include "cli.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>

#include <cstdio>

namespace spawnfield::cli {
namespace {

struct RasterArgs : QueryArgs {
    int dims = 2;
    double step = 0, step_z = 0, offset = 0.1, yaw = 0;
    std::string bounds, layers = "all", out, heatmap;
    bool no_height_check = false, snap = false, write_aerial = false;
};

void tell_idle_options(const RasterArgs& args, const CLI::App& command)
{
    if (args.dims == 3 && !args.snap) tell_idle(args, command, {"--offset"}, "it is for --dims 2 and --snap; in 3D poses stand at heights of their own");
    if (args.dims == 2) tell_idle(args, command, {"--step-z", "--max-height"}, "it is for --dims 3; in 2D poses stand on their layers");
    if (args.no_height_check)
        tell_idle(args, command, {"--max-height", "--max-water-depth", "--max-slope", "--layers"}, "--no-height-check looks for collisions alone");
}

/// Poses on their layers, so that they stand there as in 2D.
void check_snap(const RasterArgs& args)
{
    if (args.no_height_check) throw ArgumentError("--snap needs the height check: --no-height-check looks for collisions alone");
    if (args.offset >= 0 && args.offset <= args.max_height) return;
    char limit[100];
    std::snprintf(limit, sizeof limit, "0 .. --max-height (%g m) with --snap: poses on their layers would be aerial", args.max_height);
    throw bad_value("--offset", args.offset, limit);
}

RasterOptions options_of(const RasterArgs& args, const CLI::App& command)
{
    if (args.dims == 2) refuse(command, {"--no-height-check", "--write-aerial", "--snap"}, "is for --dims 3: in 2D poses stand on their layers");
    tell_idle_options(args, command);
    RasterOptions options;
    fill(options, args, "raster");
    options.dims = args.dims;
    options.step = parse_positive("--step", args.step);
    if (command.count("--step-z") > 0) options.step_z = parse_positive("--step-z", args.step_z);
    options.offset = parse_finite("--offset", args.offset, "m");
    options.yaw = parse_finite("--yaw", args.yaw, "rad");
    options.layers = parse_layers(args.layers);
    options.height_check = !args.no_height_check;
    options.snap = args.snap;
    if (args.snap) check_snap(args);
    if (!args.bounds.empty()) options.bounds = parse_bounds("--bounds", args.bounds, args.dims == 2);
    if (args.write_aerial && options.layers.kind != LayerChoice::Kind::All)
        throw ArgumentError("--write-aerial needs --layers all: aerial poses are above no layer");
    return options;
}

int run_raster(const RasterArgs& args, const CLI::App& command)
{
    Summary summary("raster", args);
    RasterOptions options = options_of(args, command);
    options.exact_time = &summary.exact_time;
    const auto session = open_session(args);
    tell_if_off_map(args, session->map, "--bounds", options.bounds);
    tell_if_no_layer(args, session->map, options.layers);
    if (args.dims == 2 || args.snap) tell_if_in_ground(args, session->robot, options.offset);
    summary.lap("load");
    const RasterResult result = raster(session->map, *session->checker, options);
    summary.lap("query");
    const auto draw = [&] {
        if (args.heatmap.empty()) return;
        HeatmapOptions picture;
        picture.title = session->map.name + ", " + session->robot.name;
        write_heatmap(session->map, read_terrain(session->map), result, picture, args.heatmap);
    };
    if (args.out.empty() && !args.heatmap.empty()) draw();
    else write_output(args.out, [&](const auto& sink) { write_raster_csv(result, args.write_aerial, sink); }, draw);
    summary.lap("write");
    summary.set_counts(result.counts);
    summary.exact_checks = result.exact_checks;
    summary.map_hash = session->map.hash;
    summary.finish();
    return done;
}

}  // namespace

void add_raster(CLI::App& app, Run& run)
{
    auto args = std::make_shared<RasterArgs>();
    CLI::App& command = *app.add_subcommand("raster", "Verdict at every position of a 2D or 3D raster");
    add_query(command, *args);
    command.add_option("--dims", args->dims, "2: a pose per column and layer; 3: a pose per column and height")
        ->required()
        ->check(CLI::IsMember({2, 3}));
    command.add_option("--step", args->step, "Between columns, m")->required();
    command.add_option("--step-z", args->step_z, "Between heights, m (default: --step)");
    command.add_option("--offset", args->offset, "Of the robot's origin above its layer in 2D and with --snap, m (default 0.1)");
    command.add_option("--yaw", args->yaw, "Of all poses, rad (default 0)");
    command.add_option("--bounds", args->bounds, "x0,y0,z0,x1,y1,z1 in m; 2D takes x0,y0,x1,y1 too and leaves z aside (default: the map's)");
    command.add_option("--layers,--layer", args->layers, "all, top, bottom, or N from the top (0 first)");
    command.add_flag("--no-height-check", args->no_height_check, "3D: collisions alone, at every pose");
    command.add_flag("--snap", args->snap, "3D: a pose on every layer, --offset above it, in place of the lowest step at or above it");
    command.add_flag("--write-aerial", args->write_aerial, "3D: write aerial poses too");
    command.add_option("--out,-o", args->out, "CSV file to write (default: standard output, or none with --heatmap)");
    command.add_option("--heatmap", args->heatmap, "PNG file to draw");
    command.footer("Example:\n"
                   "  spawnfield raster /tmp/training --robot box:0.99,0.67,0.39 --dims 2 --step 0.5 --offset 0.5 -o /tmp/box_raster.csv");
    command.callback([=, &command, &run] { run = [=, &command] { return run_raster(*args, command); }; });
}

}  // namespace spawnfield::cli

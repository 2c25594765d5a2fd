#include "angle.h"
#include "area_args.h"
#include "streams.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>

#include <algorithm>

namespace spawnfield::cli {
namespace {

struct HeatmapArgs : QueryArgs {
    AreaArgs area;
    std::string out, quantity = "verdict", layers = "all", spawns, bounds, yaw = "0";
    double step = 0, offset = 0.1;
    int size = 1000;
};

/// About 300 columns along the longer side: fine enough to look at, and quick.
double default_step(const Map& map, const RasterOptions& options)
{
    const Bounds bounds = options.bounds.is_empty() ? map.bounds : options.bounds;
    const double longest = std::max(bounds.max.x() - bounds.min.x(), bounds.max.y() - bounds.min.y());
    return std::max(map.resolution, longest / 300);
}

HeatmapQuantity quantity_of(const std::string& name)
{
    if (name == "height") return HeatmapQuantity::Height;
    if (name == "clearance") return HeatmapQuantity::Clearance;
    return name == "slope" ? HeatmapQuantity::Slope : HeatmapQuantity::Verdict;
}

int run_heatmap(const HeatmapArgs& args, const CLI::App& command)
{
    Summary summary("heatmap", args);
    RasterOptions options;
    fill(options, args, "heatmap");
    options.exact_time = &summary.exact_time;
    tell_idle(args, command, {"--max-height"}, "the robot stands on each layer");
    options.offset = parse_finite("--offset", args.offset, "m");
    options.yaw = parse_yaw(args, args.yaw);
    options.layers = parse_layers(args.layers);
    if (!args.bounds.empty()) options.bounds = parse_bounds("--bounds", args.bounds, true);
    options.area = read_area(args, args.area);
    HeatmapOptions picture;
    picture.quantity = quantity_of(args.quantity);
    picture.pixels = args.size;
    if (!args.spawns.empty()) picture.spawns = spawns_of(open_poses(args, args.spawns));
    const auto session = open_session(args);
    options.step = command.count("--step") > 0 ? parse_positive("--step", args.step) : default_step(session->map, options);
    tell_if_off_map(args, session->map, "--bounds", options.bounds);
    tell_about_area(args, session->map, options.area);
    tell_if_no_layer(args, session->map, options.layers);
    tell_if_in_ground(args, session->robot, options.offset);
    const TerrainMap terrain = read_terrain(session->map);
    summary.lap("load");
    const RasterResult result = raster(session->map, *session->checker, options);
    summary.lap("query");
    picture.title = session->map.name + ", " + session->robot.name;
    write_heatmap(session->map, terrain, result, picture, output_name(args.out));
    summary.lap("write");
    summary.set_counts(result.counts);
    summary.exact_checks = result.exact_checks;
    summary.map_hash = session->map.hash;
    summary.extra = {args.out};
    summary.finish();
    return done;
}

}  // namespace

void add_heatmap(CLI::App& app, Run& run)
{
    auto args = std::make_shared<HeatmapArgs>();
    CLI::App& command = *app.add_subcommand("heatmap", "Picture of where the robot can stand");
    add_query(command, *args);
    command.add_option("--out,-o", args->out, "PNG file to draw (- for standard output)")
        ->required()
        ->check(not_empty());
    command.add_option("--quantity", args->quantity, "verdict, height, clearance or slope (default verdict)")
        ->check(one_of({"verdict", "height", "clearance", "slope"}));
    command.add_option("--spawns", args->spawns, "CSV file of spawns to draw as arrows (- for standard input)");
    add_allow_empty(command, *args);
    command.add_option("--layers,--layer", args->layers, "all (valid if one layer is), top, bottom, or N from the top (0 first)");
    command.add_option("--step", args->step, "Between columns, m (default: 300 columns along the longer side)");
    command.add_option("--offset", args->offset, "Of the robot's origin above its layer, m (default 0.1)");
    command.add_option("--yaw", args->yaw, "Of all poses, " + yaw_help + " (default 0)");
    command.add_option("--bounds", args->bounds, "x0,y0,x1,y1 in m (default: the map's)");
    add_area(command, args->area);
    command.add_option("--size", args->size, "Longer side of the picture, pixels (default 1000)")->check(CLI::Range(200, 16000));
    command.footer("Example:\n  spawnfield heatmap /tmp/training --robot box:0.99,0.67,0.39 -o /tmp/training.png");
    command.callback([=, &command, &run] { run = [=, &command] { return run_heatmap(*args, command); }; });
}

}  // namespace spawnfield::cli

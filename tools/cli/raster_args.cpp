#include "raster_args.h"

#include "angle.h"

namespace spawnfield::cli {
namespace {

void tell_idle_options(const RasterArgs& args, const CLI::App& command)
{
    if (args.dims == 3 && !args.snap)
        tell_idle(args, command, {"--offset"},
                  "it is for --dims 2 and --snap; in 3D poses stand at heights of their own");
    if (args.no_height_check)
        tell_idle(args, command, {"--max-height", "--max-water-depth", "--max-slope", "--layers"},
                  "--no-height-check looks for collisions alone");
}

/// Poses on their layers, so that they stand there as in 2D.
void check_snap(const RasterArgs& args)
{
    if (args.no_height_check)
        throw ArgumentError("--snap needs the height check: --no-height-check looks for collisions alone");
    const std::optional<double> offset = parse_offset(args.ground.offset);
    if (!offset || (*offset >= 0 && *offset <= args.max_height)) return;
    throw bad_value(
        "--offset", *offset,
        "0 .. --max-height (" + number(args.max_height) + " m) with --snap: poses on their layers would be aerial");
}

}  // namespace

void add_raster_query(CLI::App& command, RasterArgs& args)
{
    add_query(command, args);
    command.add_option("--dims", args.dims, "2: a pose per column and layer; 3: a pose per column and height")
        ->check(one_of({"2", "3"}));
    command.add_option("--yaw", args.yaw, "Of all poses, " + yaw_help + " (default 0)");
    command.add_option("--bounds", args.bounds,
                       "x0,y0,z0,x1,y1,z1 in m; or, in 2D and with --z, x0,y0,x1,y1. In 2D layers beyond z0 .. z1 are "
                       "no ground (default: the map's)");
    add_area(command, args.area);
    add_ground(command, args.ground, "all, top, bottom, or N from the top (0 first; default all)");
    command.add_flag("--no-height-check", args.no_height_check, "3D: collisions alone, at every pose");
    command.add_flag("--snap", args.snap,
                     "3D: a pose on every layer, --offset above it, in place of the lowest step at or above it");
}

RasterOptions raster_options(const RasterArgs& args, const CLI::App& command)
{
    if (args.dims == 2)
        refuse(command, {"--no-height-check", "--snap"}, "is for --dims 3: in 2D poses stand on their layers");
    if (args.dims == 3) refuse(command, {"--floor"}, "is for --dims 2: in 3D --z gives the heights of the poses");
    tell_idle_options(args, command);
    RasterOptions options{.dims = args.dims,
                          .offset = parse_offset(args.ground.offset),
                          .yaw = parse_yaw(args, args.yaw),
                          .layers = parse_layers(args.ground.layers),
                          .height_check = !args.no_height_check,
                          .snap = args.snap,
                          .threads = args.threads,
                          .progress = progress_bar(args, command.get_name())};
    if (args.snap) check_snap(args);
    if (!args.bounds.empty())
        options.bounds = parse_bounds("--bounds", args.bounds, args.dims == 2 || !args.ground.z.empty());
    options.z = heights_of(args.ground, options.bounds, "--bounds");
    options.area = read_area(args, args.area);
    return options;
}

void complete(RasterOptions& options, const RasterArgs& args, const Session& session, Summary& summary)
{
    options.z = with_floor(options.z, args.ground, session.map);
    if (options.dims == 3) options.bounds = with_heights(options.bounds, options.z, session.map);
    tell_if_off_map(args, session.map, "--bounds", options.bounds);
    tell_about_area(args, session.map, options.area);
    tell_if_no_layer(args, session.map, options.layers);
    if (options.dims == 3 && !options.snap) return;
    options.offset = choose_offset(args, options.offset, session.robot, summary);
    if (options.dims == 2)
        require_above_ground(session.robot, *options.offset);
    else if (const std::string why = flat_ground_complaint(session.robot, *options.offset); !why.empty())
        notice(args, why);
}

}  // namespace spawnfield::cli

#include "raster_args.h"

#include "angle.h"
#include "command.h"
#include "messages.h"
#include "numbers.h"
#include "spelling.h"

#include <spawnfield/memory.h>

#include <algorithm>

namespace spawnfield::cli {
namespace {

void notice_idle_options(const RasterArgs& args, const CLI::App& command)
{
    if (args.dims == 3 && !args.snap)
        notice_no_effect(args, command, {"--offset"},
                         "it is only for --dims 2 and --snap; in 3D the heights are those of the raster");
    if (args.no_height_check)
        notice_no_effect(args, command, {"--max-height", "--max-water-depth", "--max-slope", "--layers"},
                         "--no-height-check looks only for collisions");
}

/// Checks that snapped poses would stand on their layers as in 2D. Throws ArgumentError.
void check_snap(const RasterArgs& args)
{
    if (args.no_height_check)
        throw ArgumentError(
            "--snap and --no-height-check do not go together: without the height check there is no layer to snap to");
    const std::optional<double> offset = parse_offset(args.ground.offset);
    if (!offset || (*offset >= 0 && *offset <= args.max_height)) return;
    throw bad_value(
        "--offset", *offset,
        "0 .. --max-height (" + number(args.max_height) + " m) with --snap; otherwise poses on layers would be aerial");
}

}  // namespace

CLI::Option* add_dims(CLI::App& command, RasterArgs& args)
{
    return command
        .add_option("--dims", args.dims, "2: a pose for each column and layer; 3: for each column and height")
        ->check(one_of({"2", "3"}));
}

void add_raster_query(CLI::App& command, RasterArgs& args)
{
    add_ground(command, args.ground, "all, top, bottom, or N from the top (0 first; default all)");
    command.add_option("--yaw", args.yaw, "Yaw of all poses: " + yaw_help + "; for " + heading_help + " (default 0)");
    command.add_flag("--snap", args.snap,
                     "3D: each layer gets a pose --offset above it, in place of the lowest step at or above it");
    command.add_flag("--no-height-check", args.no_height_check, "3D: judge only collisions, at every pose");
    add_verdict_options(command, args);
    add_stance(command, args, Stance::Level);
    add_area(command, args.area);
    command.add_option("--bounds", args.bounds,
                       "x0,y0,z0,x1,y1,z1 in m; in 2D or with --z also x0,y0,x1,y1. In 2D layers beyond z0 .. z1 are "
                       "not ground (default: the map's)");
    add_robot_and_run(command, args);
}

RasterOptions raster_options(const RasterArgs& args, const CLI::App& command)
{
    if (args.is_settled() && args.dims == 3)
        throw ArgumentError(
            "--stance settled (--settle) is only for --dims 2: the robot is let down onto the layers of each column; "
            "give --dims 2");
    if (args.dims == 2)
        refuse(command, {"--no-height-check", "--snap"}, "is only for --dims 3: in 2D each pose stands on a layer");
    if (args.dims == 3)
        refuse(command, {"--floor"}, "is only for --dims 2; in 3D use --z for the heights of the poses");
    notice_idle_options(args, command);
    const YawChoice yaw = parse_yaw_choice(args, args.yaw, args.is_settled(), false);
    RasterOptions options{.dims = args.dims,
                          .yaw = yaw.yaw,
                          .heading = yaw.rule,
                          .layers = parse_layers(args.ground.layers),
                          .height_check = !args.no_height_check,
                          .snap = args.snap,
                          .threads = args.threads,
                          .progress = progress_bar(args, command.get_name())};
    set_stance(options, args, args.ground, command);
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
    notice_if_off_map(args, session.map, "--bounds", options.bounds);
    notice_about_area(args, session.map, options.area);
    notice_if_no_layer(args, session.map, options.layers);
    if (options.dims == 3 && !options.snap) return;
    options.offset = choose_offset(args, options.offset, session.robot, summary);
    if (options.dims == 2)
        require_above_ground(session.robot, options.offset);
    else if (const std::string why = flat_ground_complaint(session.robot, *options.offset); !why.empty())
        notice(args, why);
}

double default_step(const Map& map, const RasterOptions& options, int columns)
{
    const Bounds bounds = options.bounds.is_empty() ? map.bounds : options.bounds;
    const double longest = std::max(bounds.max.x() - bounds.min.x(), bounds.max.y() - bounds.min.y());
    return std::max(map.resolution, longest / columns);
}

void require_raster_memory(const CommonArgs& args, const Map& map, const RasterOptions& options,
                           const std::string& step_option, int rasters)
{
    if (options.dims != 2) return;  // of a 3D raster, only poses near the ground are held
    constexpr double growth = 1.5;  // of a vector that does not know its size yet
    const double per_pose = growth *
                            (sizeof(RasterPose) + (options.stance == Stance::Settled ? sizeof(RasterRest) : 0));
    const Bounds bounds = options.bounds.is_empty() ? map.bounds : options.bounds;
    const Vec3 size = bounds.max - bounds.min;
    require_cell_memory({.per_item = rasters * per_pose}, step_option, options.step, size.x() * size.y(),
                        memory_limit(args));
}

}  // namespace spawnfield::cli

#include "query_args.h"

#include "messages.h"
#include "numbers.h"
#include "spelling.h"

#include <numbers>

namespace spawnfield::cli {

void add_map_and_robot(CLI::App& command, QueryArgs& args)
{
    command.add_option("map", args.map, "Map folder that `spawnfield bake` made")->required();
    command.add_option("--robot,-r", args.robot, "robot.yaml, a .urdf, an SDF model, or box:LX,LY,LZ[@x,y,z] (m)")
        ->required()
        ->check(not_empty());
}

void add_verdict_options(CLI::App& command, QueryArgs& args)
{
    start_group(command, help_group::ground);
    command.add_option("--max-height", args.max_height,
                       "Largest height of the robot's origin above its ground, m (default 1)");
    command.add_option(
        "--max-water-depth", args.max_water_depth,
        "A water surface higher than this above the ground does not count, m (default: every one counts)");
    command.add_option("--max-slope", args.max_slope,
                       "Degrees. Valid poses on steeper ground become steep, and those over an edge unstable (default: "
                       "slopes do not count)");
    command
        .add_option("--collision", args.collision,
                    "What the robot must not touch: geometry (exact), or octree (the voxels of the map) (default "
                    "geometry)")
        ->check(one_of({"geometry", "octree"}));
}

void add_robot_and_run(CLI::App& command, QueryArgs& args)
{
    start_group(command, help_group::robot);
    add_model_path(command, args);
    add_robot_options(command, args);
    add_common(command, args);
    command.add_flag("--exhaustive", args.exhaustive,
                     "Check every pose exactly, without the free-space mask: the same answers, slowly");
}

JudgeOptions judge_options(const QueryArgs& args, ExactTime& exact_time)
{
    if (args.max_slope && !(*args.max_slope > 0 && *args.max_slope < 90))
        throw bad_value("--max-slope", *args.max_slope, "> 0 and < 90 degrees");
    if (!(args.max_height >= 0)) throw bad_value("--max-height", args.max_height, ">= 0 m");
    if (!(args.max_water_depth >= 0)) throw bad_value("--max-water-depth", args.max_water_depth, ">= 0 m");
    JudgeOptions options{.max_height = args.max_height,
                         .max_water_depth = args.max_water_depth,
                         .obstacles = args.collision == "octree" ? Obstacles::Voxels : Obstacles::Geometry,
                         .exhaustive = args.exhaustive,
                         .exact_time = &exact_time};
    if (args.max_slope) options.max_slope = *args.max_slope * std::numbers::pi / 180;
    return options;
}

}  // namespace spawnfield::cli

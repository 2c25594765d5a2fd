#include "query_args.h"

#include "messages.h"
#include "numbers.h"
#include "spelling.h"

#include <cmath>
#include <numbers>

namespace spawnfield::cli {
namespace {

const std::string level_max_slope = "valid poses on steeper ground become steep, and those over an edge unstable";

std::string name_of(Stance stance) { return stance == Stance::Settled ? "settled" : "level"; }

/// Accepts degrees: "20" or "20deg".
CLI::Validator in_degrees()
{
    return {[](std::string& text) {
                const std::string number = text.ends_with("deg") ? text.substr(0, text.size() - 3) : text;
                double value = 0;
                if (!CLI::detail::lexical_cast(number, value))
                    return "is \"" + text + "\", needs degrees, for example 20 or 20deg";
                text = number;
                return std::string();
            },
            ""};
}

}  // namespace

Stance QueryArgs::stance() const
{
    if (settle || given_stance == "settled") return Stance::Settled;
    return given_stance == "level" ? Stance::Level : default_stance;
}

std::string QueryArgs::how_to_level() const
{
    if (settle) return "give --stance level in place of --settle";
    return given_stance.empty() ? "add --stance level" : "give --stance level";
}

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
    command
        .add_option("--max-slope", args.max_slope, "Degrees: " + level_max_slope + " (default: slopes do not count)")
        ->transform(in_degrees());
    command
        .add_option("--collision", args.collision,
                    "What the robot must not touch: geometry (exact), or octree (the voxels of the map) (default "
                    "geometry)")
        ->check(one_of({"geometry", "octree"}));
}

void add_stance(CLI::App& command, QueryArgs& args, Stance standard)
{
    args.default_stance = standard;
    command.get_option("--max-slope")
        ->description(
            "Degrees. Settled robots: one that rests with a larger tilt is steep (default 30). Level robots: " +
            level_max_slope + " (default: slopes do not count)");
    start_group(command, help_group::rest);
    const auto has = [&](const char* option) { return command.get_option_no_throw(option) != nullptr; };
    const std::string level = has("--offset")  ? "the robot stands upright, --offset above its layer"
                              : has("--poses") ? "the robot is as given"
                                               : "the robot is upright, at the height of its draw";
    CLI::Option* stance = command
                              .add_option("--stance", args.given_stance,
                                          "settled: the robot is let down at x, y and yaw, and comes to rest on the "
                                          "ground; level: " +
                                              level + " (default " + name_of(standard) + ")")
                              ->check(one_of({"level", "settled"}));
    command.add_flag("--settle", args.settle, "Short for --stance settled")->excludes(stance);
    command.add_option("--lift", args.lift,
                       "m by which the settled robot is raised: there it must touch nothing (default 0.02)");
    command
        .add_option("--max-tilt", args.max_tilt,
                    "Degrees. A robot that tilts more on its way down tips over: unstable (default 45). --max-slope "
                    "limits its tilt at rest")
        ->transform(in_degrees());
    command.add_option("--min-stability", args.min_stability,
                       "m. A robot is unstable if its centre of mass is nearer to the edge of its support polygon "
                       "(default: 0.2 % of the robot's longer side, 2 mm for a robot of 1 m)");
    command.add_option("--friction", args.friction,
                       "Coefficient of friction of robot and ground. A robot that would slide is unstable (default "
                       "0.8)");
    command.add_option("--drop", args.drop,
                       "m. A robot is obstructed if it cannot fall freely from this height, level, onto its settled "
                       "pose (default: not examined)");
}

const std::vector<std::string>& stance_options()
{
    static const std::vector<std::string> options{"--stance",        "--settle",   "--lift", "--max-tilt",
                                                  "--min-stability", "--friction", "--drop"};
    return options;
}

void notices_about_stance(const QueryArgs& args, const CLI::App& command, const Robot& robot)
{
    if (!args.is_settled())
        return notice_no_effect(args, command, {"--lift", "--max-tilt", "--min-stability", "--friction", "--drop"},
                                "it is only for settled poses (--stance settled)");
    if (args.max_slope && *args.max_slope > args.max_tilt)
        notice(args, "--max-slope " + number(*args.max_slope) + " is above --max-tilt, " + number(args.max_tilt) +
                         " degrees: a robot that tilts by more than --max-tilt is unstable; give a larger --max-tilt, "
                         "too");
    if (args.drop && *args.drop < args.lift)
        notice(args, "--drop " + number(*args.drop) + " is below --lift, " + number(args.lift) +
                         " m: spawns fall from --lift, but only the last " + number(*args.drop) +
                         " m of it are examined; give a --drop of at least " + number(args.lift));
    if (args.lift < touch_tolerance)
        notice(args, "--lift " + number(args.lift) +
                         " m leaves the robots in contact with the ground, which check calls collision and a simulator "
                         "may push apart");
    notice_about_mass(args, robot);
}

void notice_about_mass(const CommonArgs& args, const Robot& robot)
{
    if (robot.mass_center) return;
    const Vec3 mass = mass_center_of(robot);
    notice(args, robot.name + " has no centre of mass; that of its parts' volume is used, " + rounded(mass.x()) + ", " +
                     rounded(mass.y()) + ", " + rounded(mass.z()) +
                     " m from its origin (mass_center in robot.yaml, <inertial> in URDF and SDF)");
}

void add_robot_and_run(CLI::App& command, QueryArgs& args)
{
    add_changes(command, args);
    start_group(command, help_group::robot);
    add_model_path(command, args);
    add_trusted(command, args);
    add_robot_options(command, args);
    add_common(command, args);
    command.add_flag("--exhaustive", args.exhaustive,
                     "Check every pose exactly, without the free-space mask: the same answers, slowly");
}

JudgeOptions judge_options(const QueryArgs& args, ExactTime* exact_time)
{
    if (args.max_slope && !(*args.max_slope > 0 && *args.max_slope < 90))
        throw bad_value("--max-slope", *args.max_slope, "> 0 and < 90 degrees");
    if (!(args.max_height >= 0)) throw bad_value("--max-height", args.max_height, ">= 0 m");
    if (!(args.max_water_depth >= 0)) throw bad_value("--max-water-depth", args.max_water_depth, ">= 0 m");
    if (args.is_settled() && args.collision == "octree")
        throw ArgumentError(
            "--collision is octree, but settled poses need geometry: the robot comes to rest on the scene's own "
            "geometry, not on its voxels; " +
            args.how_to_level());
    const auto is_angle = [](double degrees) { return degrees > 0 && degrees < 90; };
    const auto is_length = [](double value) { return value >= 0 && std::isfinite(value); };
    if (!is_length(args.lift)) throw bad_value("--lift", args.lift, ">= 0 m");
    if (!is_angle(args.max_tilt)) throw bad_value("--max-tilt", args.max_tilt, "> 0 and < 90 degrees");
    if (args.min_stability && !is_length(*args.min_stability))
        throw bad_value("--min-stability", *args.min_stability, ">= 0 m");
    if (!is_length(args.friction)) throw bad_value("--friction", args.friction, ">= 0");
    if (args.drop && !(is_length(*args.drop) && *args.drop > 0)) throw bad_value("--drop", *args.drop, "> 0 m");
    constexpr double degree = std::numbers::pi / 180;
    JudgeOptions options{.max_height = args.max_height,
                         .max_water_depth = args.max_water_depth,
                         .obstacles = args.collision == "octree" ? Obstacles::Voxels : Obstacles::Geometry,
                         .exhaustive = args.exhaustive,
                         .exact_time = exact_time};
    options.stand = {.lift = args.lift,
                     .max_tilt = args.max_tilt * degree,
                     .min_stability = args.min_stability,
                     .friction = args.friction,
                     .drop = args.drop};
    if (args.max_slope) (args.is_settled() ? options.stand.max_slope : options.max_slope) = *args.max_slope * degree;
    return options;
}

}  // namespace spawnfield::cli

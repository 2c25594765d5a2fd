#pragma once

#include "change_args.h"
#include "common_args.h"
#include "robot_args.h"

#include <spawnfield/query.h>

#include <limits>
#include <optional>
#include <string>

namespace spawnfield::cli {

/// Options of every command that judges poses in a map.
struct QueryArgs : CommonArgs, RobotArgs, ChangeArgs {
    std::string map, robot, collision = "geometry";
    double max_height = 1.0;
    bool exhaustive = false;
    double max_water_depth = std::numeric_limits<double>::infinity();
    std::optional<double> max_slope;            ///< degrees
    Stance default_stance = Stance::Level;      ///< without --stance and --settle; add_stance() sets it
    std::string given_stance;                   ///< --stance: "level", "settled", or empty
    bool settle = false;                        ///< --settle, short for --stance settled
    double lift = 0.02, max_tilt = 45;          ///< m, degrees
    std::optional<double> min_stability, drop;  ///< m
    double friction = 0.8;

    Stance stance() const;
    bool is_settled() const { return stance() == Stance::Settled; }
    bool has_default_stance() const { return given_stance.empty() && !settle; }
    /// Returns what to do for level poses, for messages: "add --stance level", or what replaces --settle.
    std::string how_to_level() const;
};

/// Adds, below the heading "Robot at rest", the options about settled poses. Without them, poses have the stance
/// `standard`. Call it after add_verdict_options().
void add_stance(CLI::App& command, QueryArgs& args, Stance standard);

/// Options that add_stance() adds.
const std::vector<std::string>& stance_options();

/// Prints notices about options of settled poses without effect, and about a robot whose centre of mass is not known.
void notices_about_stance(const QueryArgs& args, const CLI::App& command, const Robot& robot);

/// Prints a notice about a robot whose centre of mass is not known.
void notice_about_mass(const CommonArgs& args, const Robot& robot);

/// Adds the map and --robot.
void add_map_and_robot(CLI::App& command, QueryArgs& args);

/// Adds, below the heading "Poses and ground", the options on which every verdict depends.
void add_verdict_options(CLI::App& command, QueryArgs& args);

/// Adds the options on changes of the map, on how the robot is read, and those that every command has.
void add_robot_and_run(CLI::App& command, QueryArgs& args);

/// Returns the options of the Judge; `exact_time` is that of the Summary. Throws ArgumentError for limits out of range.
JudgeOptions judge_options(const QueryArgs& args, ExactTime* exact_time);

}  // namespace spawnfield::cli

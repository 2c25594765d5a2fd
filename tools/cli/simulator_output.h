#pragma once

#include "cli.h"

#include <spawnfield/output_folder.h>
#include <spawnfield/simulators.h>

#include <span>

namespace spawnfield::cli {

/// What --format may be besides thesis: lists of poses, and files that simulators load.
inline const std::vector<std::string> pose_formats = {
    "csv",    "json",     "ros1-launch", "ros2-launch-py", "ros2-launch-xml", "sdf",
    "mujoco", "isaaclab", "carla",       "carla-ros",      "unity",           "unreal"};

/// Options of these files and of robots' names.
struct SimulatorArgs {
    std::string name, name_space;                                 ///< patterns; empty: robot_{i}, and the name
    std::string robot_file, robot_uri, topic, world, world_name;  ///< what is spawned, and where
    std::string joint_qpos, keys = "each", quaternion = "wxyz", tiles = "1,1", blueprint = "vehicle.tesla.model3",
                            unity_axes = "ros";
};
void add_simulator_options(CLI::App& command, SimulatorArgs& args);

/// Those of these options that say something to the format.
std::vector<std::string> simulator_options_of(const std::string& format);

/// A notice for each of these options that was given and says nothing to the format.
void tell_idle_options(const CommonArgs& common, const CLI::App& command, const std::string& format);

/// Robots as a file or folder in one of `pose_formats`. All that can be wrong with the options is told when it is made,
/// before all work.
class SimulatorOutput {
public:
    struct Target {
        std::string format, out;    ///< `out` as -o has it
        std::string robot;          ///< as --robot has it
        std::size_t count = 1;      ///< of robots, at most
        RobotOptions reading = {};  ///< how the robot that was judged is read
    };
    /// Throws ArgumentError, FileError; OutputError where a folder may not be replaced. Tells of options without
    /// effect.
    SimulatorOutput(const CommonArgs& common, const CLI::App& command, const SimulatorArgs& args, Target target);

    /// Whether robots have names in it: all but a csv without --name.
    bool has_names() const { return !is("csv") || !args_.name.empty(); }

    /// Names and namespaces for the robots; their `own` names, if they have any, count where --name was not given.
    void give_names(std::vector<RobotStart>& robots, const std::vector<std::string>& own = {}) const;

    /// Whole or not at all. `json` gives what is written for --format json.
    void write(std::span<const RobotStart> robots, const Map& map, const std::function<std::string()>& json) const;

private:
    bool is(const char* format) const { return target_.format == format; }
    bool is_ros() const { return target_.format.starts_with("ros"); }
    void check_rules(const std::string& option, std::span<const std::string> names,
                     std::span<const std::string> name_spaces) const;
    void settle_launch();
    void settle_sdf();
    void tell_joints() const;
    std::string own_file() const;
    std::string robot_is_neither() const;
    std::string text_of(std::span<const RobotStart> robots) const;
    void write_isaac_lab(std::span<const RobotStart> robots, const Map& map) const;

    const CommonArgs& common_;
    SimulatorArgs args_;
    Target target_;
    LaunchOptions launch_;
    SdfWorldOptions sdf_;
    KeyframeOptions keys_;
    TileGrid tiles_;
    std::unique_ptr<OutputFolder> folder_;
};

/// Poses of a CSV file, as they are, in one of `pose_formats`: what `export MAP --poses FILE` does. Names are those of
/// --name, else of the file's column `name`, else robot_{i}. `target.count` is not asked for. Throws as SimulatorOutput
/// and read_poses do.
void export_poses(const CommonArgs& common, const CLI::App& command, const SimulatorArgs& args,
                  const std::string& poses, SimulatorOutput::Target target, const Session& session);

}  // namespace spawnfield::cli

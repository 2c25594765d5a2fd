#pragma once

#include "session.h"

#include <spawnfield/output_folder.h>
#include <spawnfield/simulators.h>

#include <span>

namespace spawnfield::cli {

/// Values of --format except thesis: lists of poses, and files that simulators load.
inline const std::vector<std::string> pose_formats = {
    "csv",    "json",     "ros1-launch", "ros2-launch-py", "ros2-launch-xml", "sdf",
    "mujoco", "isaaclab", "carla",       "carla-ros",      "unity",           "unreal"};

/// Options of the files for simulators and of the robots' names.
struct SimulatorArgs {
    std::string name, name_space;                                 ///< patterns; empty: robot_{i}, and the name
    std::string robot_file, robot_uri, topic, world, world_name;  ///< the robot that is spawned, and the world
    std::string joint_qpos, keys = "each", quaternion = "wxyz", tiles = "1,1", blueprint = "vehicle.tesla.model3",
                            unity_axes = "ros";
};
void add_simulator_options(CLI::App& command, SimulatorArgs& args);

/// Returns the names of those options that the format uses.
std::vector<std::string> simulator_options_of(const std::string& format);

/// Prints a notice for each of these options that was given although the format does not use it.
void notice_idle_options(const CommonArgs& common, const CLI::App& command, const std::string& format);

/// Robots as a file or folder in one of `pose_formats`. The constructor reports every wrong option, before all work.
class SimulatorOutput {
public:
    struct Target {
        std::string format, out;    ///< `out` is the value of -o
        std::string robot;          ///< the value of --robot
        std::size_t count = 1;      ///< largest number of robots
        RobotOptions reading = {};  ///< how the robot was read for its verdicts
    };
    /// Prints notices about options without effect. Throws ArgumentError, FileError, and OutputError for a folder that
    /// may not be replaced.
    SimulatorOutput(const CommonArgs& common, const CLI::App& command, const SimulatorArgs& args, Target target);

    /// Returns whether the robots have names: in every format except csv without --name.
    bool has_names() const { return !is("csv") || !args_.name.empty(); }

    /// Prints a notice if the model that the simulator loads can be read, and its lowest point is at another height
    /// than that of the robot whose poses are written: then it starts too high or too low.
    void notice_about_model(const Robot& robot) const;
    /// Prints a notice if robots are added to another world than the one from which the map was baked.
    void notice_about_world(const Map& map) const;

    /// Returns the file or URI of the robot's model in a launch file or an SDF world; empty if there is none.
    std::string model() const { return is("sdf") ? sdf_.uri : is_ros() ? launch_.file : ""; }

    /// Gives the robots names and namespaces. Without --name their `own` names are used, if there are any.
    void give_names(std::vector<RobotStart>& robots, const std::vector<std::string>& own = {}) const;

    /// Writes the file completely or not at all. `json` returns the text for --format json.
    void write(std::span<const RobotStart> robots, const Map& map, const std::function<std::string()>& json) const;

private:
    bool is(const char* format) const { return target_.format == format; }
    bool is_ros() const { return target_.format.starts_with("ros"); }
    void check_rules(const std::string& option, std::span<const std::string> names,
                     std::span<const std::string> name_spaces) const;
    void prepare_launch();
    void prepare_sdf();
    void notice_joints() const;
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

/// Prints a notice if a column `verdict` says that poses are not valid, because they are exported, too. Other texts in
/// the column do not count: it may be the user's own.
void notice_not_valid(const CommonArgs& common, const PoseTable& table, const std::string& file);

/// Writes the poses of a table in one of `pose_formats`. Names are those of --name, else of the table's column `name`,
/// else robot_{i}. Throws what SimulatorOutput throws.
void export_poses(const CommonArgs& common, const CLI::App& command, const SimulatorArgs& args, const PoseTable& table,
                  SimulatorOutput::Target target, const Session& session);

}  // namespace spawnfield::cli

#include "simulator_output.h"

#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "spelling.h"
#include "streams.h"

#include <spawnfield/input_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace spawnfield::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array isaac_files{"root_pose.npy", "flat_patches.npy", "terrain_origins.npy", "isaaclab.json"};

/// The formats that use an option, by the beginnings of their names.
struct OptionUse {
    const char* option;
    std::vector<std::string> formats;
};

const std::vector<OptionUse> option_uses = {{"--name", {pose_formats.begin(), pose_formats.end()}},
                                            {"--namespace", {"ros", "json"}},
                                            {"--robot-file", {"ros", "sdf"}},
                                            {"--robot-uri", {"sdf"}},
                                            {"--topic", {"ros"}},
                                            {"--world", {"sdf"}},
                                            {"--world-name", {"ros2", "sdf"}},
                                            {"--joint-qpos", {"mujoco"}},
                                            {"--keys", {"mujoco"}},
                                            {"--quaternion", {"isaaclab"}},
                                            {"--tiles", {"isaaclab"}},
                                            {"--blueprint", {"carla"}},
                                            {"--unity-axes", {"unity"}}};

bool is_for(const OptionUse& use, const std::string& format)
{
    return std::any_of(use.formats.begin(), use.formats.end(),
                       [&](const std::string& start) { return format.starts_with(start); });
}

TileGrid parse_tiles(const std::string& text)
{
    const std::vector<double> v = parse_numbers("--tiles", text);
    if (v.size() != 2) throw ArgumentError("--tiles is \"" + text + "\", needs ROWS,COLS: tiles along x and along y");
    for (const double n : v)
        if (!(n >= 1 && n <= 10000) || n != std::floor(n))
            throw bad_value("--tiles", n, "whole numbers from 1 to 10000");
    TileGrid grid;
    grid.rows = int(v[0]);
    grid.cols = int(v[1]);
    return grid;
}

/// Returns the absolute path. A path with $(…), which a launcher fills in, stays unchanged.
std::string lasting_path(const std::string& option, const std::string& file)
{
    if (file.find("$(") != std::string::npos) return file;
    if (is_missing(file)) throw FileError(file, "does not exist (" + option + ")");
    if (!is_folder(file)) require_file(file);
    return fs::absolute(file).lexically_normal().string();
}

fs::path folder_of(const std::string& file) { return fs::absolute(file).lexically_normal().parent_path(); }

/// Returns the file or folder that a URI names; an empty path if it is not found without a simulator.
fs::path model_on_disk(const std::string& uri, const std::vector<fs::path>& model_paths)
{
    const std::string file = "file://", model = "model://";
    if (!uri.starts_with(model)) {
        const fs::path path = uri.starts_with(file) ? uri.substr(file.size()) : uri;
        return does_exist(path) ? path : fs::path();
    }
    for (const fs::path& folder : model_paths)
        if (const fs::path path = folder / uri.substr(model.size()); does_exist(path)) return path;
    return {};
}

/// Returns the first relative <uri> of an SDF text; empty if there is none.
std::string first_relative_uri(const std::string& text)
{
    const std::string begin = "<uri>";
    for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
        const std::size_t start = text.find_first_not_of(" \t\r\n", at + begin.size());
        const std::string uri = start == std::string::npos
                                    ? ""
                                    : text.substr(start, text.find_first_of("< \t\r\n", start) - start);
        const bool is_file_uri = uri.starts_with("file://");
        const std::string path = is_file_uri ? uri.substr(7) : uri;
        if (!path.empty() && path[0] != '/' && (is_file_uri || uri.find("://") == std::string::npos)) return uri;
    }
    return "";
}

/// Returns the point on the ground below each robot. Throws ArgumentError if a robot has no ground.
std::vector<Vec3> points_on_ground(std::span<const RobotStart> robots, const Map& map)
{
    std::vector<Vec3> points;
    for (const RobotStart& robot : robots) {
        const Vec3& p = robot.position;
        const std::optional<Ground> ground = ground_below(column_at(map.geometry, p.x(), p.y()), p.z());
        if (!ground)
            throw ArgumentError("--format isaaclab: there is no ground below robot " + robot.name + " at " +
                                number(p.x()) + ", " + number(p.y()) + ", " + number(p.z()));
        points.push_back({p.x(), p.y(), ground->height});
    }
    return points;
}

}  // namespace

std::vector<std::string> simulator_options_of(const std::string& format)
{
    std::vector<std::string> options;
    for (const OptionUse& use : option_uses)
        if (is_for(use, format)) options.push_back(use.option);
    return options;
}

void notice_idle_options(const CommonArgs& common, const CLI::App& command, const std::string& format)
{
    for (const OptionUse& use : option_uses)
        if (!is_for(use, format))
            notice_no_effect(common, command, {use.option}, "--format " + format + " does not use it");
}

void add_simulator_options(CLI::App& command, SimulatorArgs& args)
{
    start_group(command, help_group::simulator);
    const auto add = [&](const char* option, std::string& value, const char* help) {
        return command.add_option(option, value, help);
    };
    add("--name", args.name,
        "Pattern of the robots' names: {i} is the number from 1 on, {i:03} has three digits (default robot_{i})");
    add("--namespace", args.name_space, "ROS, json: pattern of the robots' namespaces (default: their names)");
    add("--robot-file", args.robot_file,
        "ROS, sdf: URDF or SDF file of the robot to spawn (default: --robot, if it is such a file)");
    add("--robot-uri", args.robot_uri, "sdf: URI of the robot's model instead of a file, for example model://husky");
    add("--topic", args.topic,
        "ROS: topic (ROS 1: parameter) in each namespace that contains the robot's description, instead of a file");
    add("--world", args.world,
        "sdf: world file to which the robots are added (default: a new world without anything else)");
    add("--world-name", args.world_name,
        "ROS 2: Gazebo's name of the world (default: the running one). sdf: name of the new world, or of one world in "
        "--world");
    add("--joint-qpos", args.joint_qpos,
        "mujoco: q,q,... of the joints that follow each free joint (default: no further joints)");
    add("--keys", args.keys,
        "mujoco: each: a key for each spawn, for a model of one robot; together: one key for a model of all robots "
        "(default each)")
        ->check(one_of({"each", "together"}));
    add("--quaternion", args.quaternion, "isaaclab: wxyz for Isaac Lab 1 and 2, xyzw for 3 and later (default wxyz)")
        ->check(one_of({"wxyz", "xyzw"}));
    add("--tiles", args.tiles, "isaaclab: ROWS,COLS: number of terrain tiles along x and along y (default 1,1)");
    add("--blueprint", args.blueprint, "carla: blueprint to spawn (default vehicle.tesla.model3)");
    add("--unity-axes", args.unity_axes,
        "unity: ros: axes of Unity's ROS packages; gltf: for a world that Unity exported as glTF, FBX or OBJ (default "
        "ros)")
        ->check(one_of({"ros", "gltf"}));
}

SimulatorOutput::SimulatorOutput(const CommonArgs& common, const CLI::App& command, const SimulatorArgs& args,
                                 Target target)
    : common_(common), args_(args), target_(std::move(target))
{
    notice_idle_options(common, command, target_.format);
    notice_joints();
    constexpr std::size_t enough = 1000;  // this many names show whether the pattern gives different ones
    std::vector<RobotStart> some(std::min(target_.count, enough));
    give_names(some);
    if (is_ros()) prepare_launch();
    if (is("sdf")) prepare_sdf();
    if (is("mujoco") && !args_.joint_qpos.empty()) keys_.joints = parse_numbers("--joint-qpos", args_.joint_qpos);
    keys_.together = args_.keys == "together";
    if (!is("isaaclab")) return;
    tiles_ = parse_tiles(args_.tiles);
    if (target_.out.empty() || target_.out == "-") throw ArgumentError("--format isaaclab needs -o FOLDER");
    folder_ = std::make_unique<OutputFolder>(target_.out, holds_only(isaac_files, "Isaac Lab result"));
}

void SimulatorOutput::notice_about_model(const Robot& robot) const
{
    constexpr double noticeable = 0.005;  // m
    const std::string uri = model();
    const fs::path file = model_on_disk(uri, target_.reading.model_paths);
    std::error_code ignored;
    if (file.empty() || robot.parts.empty() || fs::equivalent(file, target_.robot, ignored)) return;
    double lowest = 0;
    try {
        lowest = read_robot(common_, file.string(), {.model_paths = target_.reading.model_paths}).bounds().min.z();
    } catch (const FileError&) {
        return;  // the simulator may still be able to read it
    }
    const double too_high = lowest - robot.bounds().min.z();
    if (std::abs(too_high) < noticeable) return;
    const auto words = [](double z) {
        return rounded(std::abs(z)) + " m " + (z > 0 ? "above" : "below") + " its origin";
    };
    notice(common_, uri + ": its lowest point is " + words(lowest) + ", but that of --robot " + target_.robot + " is " +
                        words(robot.bounds().min.z()) +
                        "; the simulator puts the model's origin at each pose, so the robots start " +
                        rounded(std::abs(too_high)) + " m too " + (too_high > 0 ? "high" : "low") +
                        "; give this model as --robot, or make the origins agree");
}

void SimulatorOutput::notice_about_world(const Map& map) const
{
    const fs::path baked = map.scene_file;
    const bool is_world = baked.extension() == ".world" || baked.extension() == ".sdf";
    if (args_.world.empty() || !is_world || fs::path(sdf_.world_file).filename() == baked) return;
    notice(common_, "the robots are added to " + fs::path(sdf_.world_file).string() + ", but the map was baked from " +
                        map.scene_file + "; are they the same world?");
}

void SimulatorOutput::give_names(std::vector<RobotStart>& robots, const std::vector<std::string>& own) const
{
    const bool has_own = args_.name.empty() && !own.empty();
    if (has_own) check_names("column name:", own);
    const std::string option = has_own ? "column name:" : "--name";
    const std::vector<std::string> names =
        has_own ? own : numbered_names("--name", args_.name.empty() ? "robot_{i}" : args_.name, robots.size());
    std::vector<std::string> name_spaces = names;
    if (!args_.name_space.empty()) name_spaces = numbered_names("--namespace", args_.name_space, robots.size());
    check_rules(option, names, name_spaces);
    if (is("csv") && args_.name.empty() && !has_own) return;
    for (std::size_t i = 0; i < robots.size(); ++i) {
        robots[i].name = names[i];
        if (is_ros() || is("json")) robots[i].name_space = name_spaces[i];
    }
}

void SimulatorOutput::check_rules(const std::string& option, std::span<const std::string> names,
                                  std::span<const std::string> name_spaces) const
{
    if (is_ros() || is("sdf")) check_model_names(option, names);
    if (!is_ros()) return;
    const std::string origin = args_.name_space.empty() ? option + " (as a namespace; --namespace gives others)"
                                                        : "--namespace";
    check_ros_names(origin, name_spaces, is("ros1-launch") ? 1 : 2);
}

/// Prints a notice if the file cannot contain the joint positions for which the poses were judged.
void SimulatorOutput::notice_joints() const
{
    const bool has_joints = is("ros1-launch") || is("json") || (is("mujoco") && !args_.joint_qpos.empty());
    if (target_.reading.joints.empty() || has_joints) return;
    notice(common_, "--format " + target_.format +
                        " does not contain joints: the robots start with joints at 0, not at the positions of "
                        "--joints; set them in the simulator" +
                        (is("mujoco") ? ", or with --joint-qpos" : ""));
}

std::string SimulatorOutput::own_file() const
{
    if (!args_.robot_file.empty()) return lasting_path("--robot-file", args_.robot_file);
    const bool is_model_file = target_.robot.ends_with(".urdf") || target_.robot.ends_with(".sdf");
    return is_model_file || is_file(fs::path(target_.robot) / "model.config") ? lasting_path("--robot", target_.robot)
                                                                              : "";
}

std::string SimulatorOutput::robot_is_neither() const
{
    return target_.robot.empty() ? "" : "; --robot " + target_.robot + " is not such a file";
}

void SimulatorOutput::prepare_launch()
{
    launch_.world = args_.world_name;
    launch_.topic = args_.topic;
    if (!args_.topic.empty() && !args_.robot_file.empty())
        throw ArgumentError("--topic and --robot-file are both given; give one of them");
    if (args_.topic.empty()) launch_.file = own_file();
    if (is_folder(launch_.file)) launch_.file = scene_file_of(launch_.file).string();  // ROS spawns files
    if (is("ros1-launch")) launch_.joints = target_.reading.joints;
    if (is("ros1-launch") && does_exist(launch_.file) && model_placement(launch_.file).has_pose)
        throw ArgumentError("--format ros1-launch: " + launch_.file +
                            " has a <pose> of its own, which gazebo_ros adds to the pose of each robot; remove it");
    if (launch_.topic.empty() && launch_.file.empty())
        throw ArgumentError("--format " + target_.format +
                            " needs --robot-file FILE, a URDF or SDF to spawn, or --topic robot_description" +
                            robot_is_neither());
    target_.format == "ros2-launch-py" ? ros2_launch_py({}, launch_)
                                       : ros1_launch({}, launch_);  // refuses a wrong file now
}

void SimulatorOutput::prepare_sdf()
{
    if (!args_.robot_uri.empty() && !args_.robot_file.empty())
        throw ArgumentError("--robot-uri and --robot-file are both given; give one of them");
    sdf_.uri = args_.robot_uri.empty() ? own_file() : args_.robot_uri;
    sdf_.world_name = args_.world_name;
    if (sdf_.uri.find("$(") != std::string::npos)
        throw ArgumentError(
            "--format sdf: " + sdf_.uri +
            " has a $(…), which only launch files can contain; give the path of the file, or --robot-uri");
    if (does_exist(sdf_.uri))
        if (const std::string frame = model_placement(sdf_.uri).frame; !frame.empty())
            throw ArgumentError("--format sdf: " + sdf_.uri + " has placement_frame=\"" + frame +
                                "\", so <include> would put that frame, not the model's own, at the pose; remove it");
    if (sdf_.uri.empty())
        throw ArgumentError(
            "--format sdf needs --robot-uri URI, for example model://husky, or --robot-file FILE, a URDF or SDF" +
            robot_is_neither());
    if (args_.world.empty()) return;
    sdf_.world_file = args_.world;
    sdf_.world_text = read_file(args_.world);
    sdf_.model_paths = target_.reading.model_paths;
    sdf_world({}, sdf_);  // refuses a wrong file now
    const std::string relative = first_relative_uri(sdf_.world_text);
    const bool is_beside = !target_.out.empty() && folder_of(target_.out) == folder_of(args_.world);
    if (!relative.empty() && !is_beside)
        notice(common_, args_.world + ": " + relative +
                            " and similar paths are relative to this file, but the new file is in another folder; " +
                            "write it beside this file");
}

std::string SimulatorOutput::text_of(std::span<const RobotStart> robots) const
{
    if (is("csv")) return robots_csv(robots);
    if (is("ros1-launch")) return ros1_launch(robots, launch_);
    if (is("ros2-launch-py")) return ros2_launch_py(robots, launch_);
    if (is("ros2-launch-xml")) return ros2_launch_xml(robots, launch_);
    if (is("sdf")) return sdf_world(robots, sdf_);
    if (is("mujoco")) return mujoco_keyframes(robots, keys_);
    if (is("carla")) return carla_json(robots, args_.blueprint);
    if (is("carla-ros")) return carla_objects_json(robots, args_.blueprint);
    if (is("unreal")) return unreal_csv(robots);
    return unity_csv(robots, args_.unity_axes == "gltf" ? Frame::UnityGltf : Frame::Unity);
}

void SimulatorOutput::write(std::span<const RobotStart> robots, const Map& map,
                            const std::function<std::string()>& json) const
{
    if (is("isaaclab")) return write_isaac_lab(robots, map);
    const std::string text = is("json") ? json() : text_of(robots);
    write_output(common_, target_.out, [&](const auto& sink) { sink(text); });
}

void SimulatorOutput::write_isaac_lab(std::span<const RobotStart> robots, const Map& map) const
{
    const bool has_w_first = args_.quaternion == "wxyz";
    TileGrid grid = tiles_;
    grid.bounds = map.bounds;
    const TerrainPatches patches = terrain_patches(points_on_ground(robots, map), grid);
    nlohmann::ordered_json about;
    about["format"] = "spawnfield-isaaclab/1";
    about["frame"] = "metres, right-handed, x forward, y left, z up";
    about["root_pose.npy"] = {{"shape", {robots.size(), 7}},
                              {"columns", has_w_first ? "x y z qw qx qy qz" : "x y z qx qy qz qw"},
                              {"for", has_w_first ? "Isaac Lab 1 and 2" : "Isaac Lab 3"}};
    about["flat_patches.npy"] = {{"shape", {grid.rows, grid.cols, patches.patches_per_tile, 3}},
                                 {"is", "ground below the spawns, by tile: rows along x, columns along y"}};
    about["terrain_origins.npy"] = {{"shape", {grid.rows, grid.cols, 3}}, {"is", "the first patch of each tile"}};
    about["map"] = {{"name", map.name}, {"hash", map.hash}};
    if (!map.changes.empty()) about["map"]["changes"] = map.changes;
    clear_progress_bar(common_);
    const fs::path& into = folder_->path();
    write_file_atomically(into / "root_pose.npy",
                          root_poses_npy(robots, has_w_first ? QuaternionOrder::Wxyz : QuaternionOrder::Xyzw));
    write_file_atomically(into / "flat_patches.npy", patches.flat_patches);
    write_file_atomically(into / "terrain_origins.npy", patches.terrain_origins);
    write_file_atomically(into / "isaaclab.json", about.dump(2) + "\n");
    stop_if_interrupted(common_);
    folder_->commit();
    notices(common_, folder_->notices());
}

void notice_not_valid(const CommonArgs& common, const PoseTable& table, const std::string& file)
{
    const auto is_against = [](const std::string& text) {
        return text != to_string(Verdict::Valid) &&
               std::any_of(all_verdicts.begin(), all_verdicts.end(), [&](Verdict v) { return text == to_string(v); });
    };
    const std::vector<std::string> texts = column_of(table, "verdict");
    const auto count = std::count_if(texts.begin(), texts.end(), is_against);
    if (count > 0)
        notice(common, input_name(file) + ": " + std::to_string(count) + " of " + counted(texts.size(), "pose") +
                           (count == 1 ? " is" : " are") +
                           " not valid according to the column verdict, but all poses are exported; to export only the "
                           "valid ones, remove the other rows from the file (docs/simulators.md has a command for it)");
}

void export_poses(const CommonArgs& common, const CLI::App& command, const SimulatorArgs& args, const PoseTable& table,
                  SimulatorOutput::Target target, const Session& session)
{
    const SimulatorOutput output(common, command, args, std::move(target));
    output.notice_about_model(session.robot);
    output.notice_about_world(session.map);
    std::vector<RobotStart> robots = robot_starts(table);
    output.give_names(robots, column_of(table, "name"));
    output.write(robots, session.map, [&] { return poses_json(robots, session.map, session.robot); });
}

}  // namespace spawnfield::cli

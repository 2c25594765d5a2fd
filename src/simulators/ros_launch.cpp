#include "base/number.h"
#include "base/text.h"
#include "simulators/text.h"

#include <spawnfield/error.h>

#include <algorithm>

namespace spawnfield {
namespace {

bool ends_with_any(const std::string& text, std::initializer_list<const char*> ends)
{
    for (const char* const end : ends)
        if (text.ends_with(end)) return true;
    return false;
}

void check(const char* function, const LaunchOptions& options)
{
    if (options.file.empty() && options.topic.empty())
        throw ArgumentError(function, "has neither a file nor a topic for the robots' model, needs one of them");
    if (ends_with_any(options.file, {".xacro"}))
        throw ArgumentError(function,
                            options.file + " is a template, needs a URDF; make one first (xacro FILE > robot.urdf)");
}

/// Returns the options for one robot, which may have a model of its own. Throws ArgumentError for a wrong model.
LaunchOptions options_for(const char* function, const RobotStart& robot, const LaunchOptions& options)
{
    LaunchOptions out = options;
    if (!robot.model.empty()) out.file = robot.model;
    check(function, out);
    return out;
}

bool have_models(std::span<const RobotStart> robots)
{
    return std::ranges::any_of(robots, [](const RobotStart& robot) { return !robot.model.empty(); });
}

/// Throws ArgumentError for a file that a launch file in Python cannot name.
void check_python_file(const std::string& file)
{
    if (file.find("$(") != std::string::npos)
        throw ArgumentError("ros2_launch_py",
                            file + " has a $(…), which is for launch files in XML; name the file itself");
}

/// Returns the arguments of a pose: "-x 1 -y 2 -z 0 -R 0 -P 0 -Y 0".
std::string pose_arguments(const RobotStart& robot)
{
    const Vec3& p = robot.position;
    return "-x " + plain_number(p.x()) + " -y " + plain_number(p.y()) + " -z " + plain_number(p.z()) + " -R " +
           plain_number(robot.rpy.roll) + " -P " + plain_number(robot.rpy.pitch) + " -Y " + plain_number(robot.rpy.yaw);
}

/// Returns a word as an argument in XML. A word with $(…) is not quoted for the shell, because the launcher must
/// replace it.
std::string argument(const std::string& word)
{
    const bool has_substitution = word.find("$(") != std::string::npos;
    return xml_escaped(has_substitution ? word : shell_quoted(word));
}

std::string attribute(const std::string& name, const std::string& value) { return " " + name + "=\"" + value + "\""; }

}  // namespace

std::string ros1_launch(std::span<const RobotStart> robots, const LaunchOptions& options)
{
    if (!have_models(robots)) check("ros1_launch", options);
    std::string joints;
    for (const auto& [joint, value] : options.joints) joints += " -J " + argument(joint) + " " + plain_number(value);
    std::string text = "<?xml version=\"1.0\"?>\n<!-- " + made_by(robots.size()) +
                       ": m, rad, x forward, y left, z up (REP-103) -->\n<launch>\n";
    for (const RobotStart& robot : robots) {
        const LaunchOptions own = options_for("ros1_launch", robot, options);
        const bool is_sdf = own.file.ends_with(".sdf"), has_parameter = !own.file.empty() && !is_sdf;
        const std::string source = is_sdf ? "-sdf -file " + argument(own.file)
                                          : "-urdf -param " + argument(has_parameter ? "robot_description" : own.topic);
        text += "  <group" + attribute("ns", xml_escaped(robot.name_space)) + ">\n";
        if (has_parameter)
            text += "    <param name=\"robot_description\"" + attribute("textfile", xml_escaped(own.file)) + "/>\n";
        text += "    <node name=\"spawn_model\" pkg=\"gazebo_ros\" type=\"spawn_model\" output=\"screen\"" +
                attribute("args", source + " -model " + argument(robot.name) + " " + pose_arguments(robot) + joints) +
                "/>\n  </group>\n";
    }
    return text + "</launch>\n";
}

std::string ros2_launch_xml(std::span<const RobotStart> robots, const LaunchOptions& options)
{
    if (!have_models(robots)) check("ros2_launch_xml", options);
    const std::string world = options.world.empty() ? "" : "-world " + argument(options.world) + " ";
    const auto source_of = [&](const RobotStart& robot) {
        const LaunchOptions own = options_for("ros2_launch_xml", robot, options);
        return own.file.empty() ? "-topic " + argument(own.topic) : "-file " + argument(own.file);
    };
    std::string text = "<?xml version=\"1.0\"?>\n<!-- " + made_by(robots.size()) +
                       ": m, rad, x forward, y left, z up (REP-103) -->\n<launch>\n";
    for (const RobotStart& robot : robots)
        text += "  <node pkg=\"ros_gz_sim\" exec=\"create\" name=\"create\" output=\"screen\"" +
                attribute("namespace", xml_escaped(robot.name_space)) + "\n        " +
                attribute("args",
                          world + source_of(robot) + " -name " + argument(robot.name) + " " + pose_arguments(robot))
                    .substr(1) +
                "/>\n";
    return text + "</launch>\n";
}

std::string ros2_launch_py(std::span<const RobotStart> robots, const LaunchOptions& options)
{
    const bool has_models = have_models(robots);
    if (!has_models) check("ros2_launch_py", options);
    check_python_file(options.file);
    std::string text = "\"\"\"" + made_by(robots.size()) +
                       ": m, rad, x forward, y left, z up (REP-103).\"\"\"\n"
                       "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n\n";
    const auto source_of = [](const LaunchOptions& from) {
        return from.file.empty() ? "'-topic', " + python_quoted(from.topic) : "'-file', " + python_quoted(from.file);
    };
    const std::string world = options.world.empty() ? "" : "'-world', " + python_quoted(options.world) + ", ";
    const std::string first = has_models ? "source, name" : "name";  // of a row: a model for each robot, or for all
    if (!has_models) text += "SOURCE = [" + world + source_of(options) + "]\n";
    text += "ROBOTS = [  # " + first + ", namespace, x, y, z, roll, pitch, yaw\n";
    for (const RobotStart& robot : robots) {
        text += "    (";
        if (has_models) {
            const LaunchOptions own = options_for("ros2_launch_py", robot, options);
            check_python_file(own.file);
            text += "[" + world + source_of(own) + "], ";
        }
        text += python_quoted(robot.name) + ", " + python_quoted(robot.name_space);
        for (const double value : {robot.position.x(), robot.position.y(), robot.position.z(), robot.rpy.roll,
                                   robot.rpy.pitch, robot.rpy.yaw}) {
            text += ", ";
            append_number(text, value);
        }
        text += "),\n";
    }
    return text +
           "]\n\n\ndef generate_launch_description():\n"
           "    return LaunchDescription([\n"
           "        Node(package='ros_gz_sim', executable='create', name='create', namespace=namespace, "
           "output='screen',\n"
           "             arguments=" +
           (has_models ? "source" : "SOURCE") +
           " + ['-name', name, '-x', str(x), '-y', str(y), '-z', str(z),\n"
           "                                 '-R', str(roll), '-P', str(pitch), '-Y', str(yaw)])\n"
           "        for " +
           first + ", namespace, x, y, z, roll, pitch, yaw in ROBOTS])\n";
}

}  // namespace spawnfield

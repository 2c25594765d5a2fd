#include "export.h"

namespace spawnfield::cli {
namespace {

void write(const ExportJob& job)
{
    const ExportArgs& args = job.args;
    export_poses(args, job.command, args.simulator, args.poses,
                 {args.format, args.out, args.robot, 1, robot_options(args)}, job.session);
}

ExportFormat row(const char* name, const char* about)
{
    std::vector<std::string> takes = simulator_options_of(name), needs = {"--poses"};
    takes.insert(takes.end(), {"--robot", "--model-path", "--joints", "--mesh-parts"});
    if (std::string_view(name) == "isaaclab") needs.push_back("--out");
    return {name, about, std::move(needs), std::move(takes), write};
}

}  // namespace

std::vector<ExportFormat> pose_export_formats()
{
    return {row("csv", "--poses as x,y,z,roll,pitch,yaw"),
            row("json", "--poses with names and quaternions"),
            row("ros1-launch", "--poses for roslaunch: a group with a spawn_model for each robot"),
            row("ros2-launch-py", "--poses for ros2 launch, in Python: a node ros_gz_sim create for each robot"),
            row("ros2-launch-xml", "the same in XML"),
            row("sdf", "--poses as robots in a Gazebo world"),
            row("mujoco", "--poses as MuJoCo's keyframes"),
            row("isaaclab", "--poses as Isaac Lab's arrays: a folder"),
            row("carla", "--poses as CARLA's transforms, JSON"),
            row("carla-ros", "--poses as objects.json of CARLA's ROS bridge"),
            row("unity", "--poses in Unity's frame, CSV"),
            row("unreal", "--poses in Unreal's frame, CSV")};
}

}  // namespace spawnfield::cli

#include "command.h"
#include "export.h"
#include "messages.h"
#include "streams.h"

#include <spawnfield/error.h>

namespace spawnfield::cli {
namespace {

/// Replaces the poses by the settled ones, raised by --lift. Throws FileError unless all of them are valid.
void let_down(const ExportJob& job, PoseTable& table)
{
    const std::vector<SettledPose> settled = settled_poses(job, table);
    std::vector<Judgement> judgements;
    for (const SettledPose& pose : settled) judgements.push_back(judgement_of(pose));
    const VerdictReport report{table, judgements, *job.session.judge, &settled};
    NotValid not_valid;
    not_valid.add(report);
    if (!not_valid.is_empty())
        throw FileError(input_name(job.args.poses),
                        "with --settle, " + not_valid.words() +
                            "\nLeave these out; `check --settle` has the verdict of each pose. Without --settle, poses "
                            "are written as they are given");
    for (std::size_t i = 0; i < settled.size(); ++i) table.poses[i] = settled[i].lifted(job.args.lift);
}

/// Prints a notice if `check --settle` wrote the file, because its poses are the places where robots were let down.
void notice_if_settled(const ExportArgs& args, const PoseTable& table)
{
    if (!column_of(table, "settled_z").empty())
        notice(args, input_name(args.poses) +
                         ": the columns x, y, z, roll, pitch and yaw are written, and not where `check --settle` found "
                         "that the robots rest; --settle writes that");
}

void write(const ExportJob& job)
{
    const ExportArgs& args = job.args;
    PoseTable table = open_poses(args, args.poses);
    if (lets_down_poses(job)) {
        let_down(job, table);
    } else {
        notice_not_valid(args, table, args.poses);
        notice_if_settled(args, table);
    }
    export_poses(args, job.command, args.simulator, table,
                 {args.format, args.out, args.robot, table.poses.size(), robot_options(args)}, job.session);
}

ExportFormat row(const char* name, const char* about)
{
    std::vector<std::string> takes = simulator_options_of(name), needs = {"--poses"};
    takes.insert(takes.end(), {"--robot", "--model-path", "--joints", "--mesh-parts", "--max-slope"});
    takes.insert(takes.end(), stance_options().begin(), stance_options().end());
    if (std::string_view(name) == "isaaclab") needs.push_back("--out");
    return {name, about, std::move(needs), std::move(takes), write};
}

}  // namespace

bool lets_down_poses(const ExportJob& job)
{
    if (job.args.is_settled() && !job.args.has_default_stance()) return true;
    notice_no_effect(job.args, job.command,
                     {"--max-slope", "--lift", "--max-tilt", "--min-stability", "--friction", "--drop"},
                     "the poses are written as they are given; --settle lets the robot down");
    return false;
}

std::vector<SettledPose> settled_poses(const ExportJob& job, const PoseTable& table)
{
    notice_about_tilted(job.args, job.args.poses, count_tilted(table));
    notices_about_stance(job.args, job.command, job.session.robot);
    return job.session.judge->settle(table.poses,
                                     {.threads = job.args.threads, .progress = progress_bar(job.args, "export")});
}

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

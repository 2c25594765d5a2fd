#include "session.h"

#include "host.h"
#include "messages.h"
#include "numbers.h"
#include "streams.h"

#include <spawnfield/input_file.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace spawnfield::cli {
namespace {

namespace fs = std::filesystem;

/// Prints a notice if the robot is larger than the map: most likely one of them is in wrong units.
void notice_if_larger_than_map(const CommonArgs& args, const Robot& robot, const Map& map)
{
    const Bounds box = robot.bounds();
    const Vec3 size = box.max - box.min, room = map.bounds.max - map.bounds.min;
    if (size.head<2>().maxCoeff() <= room.head<2>().maxCoeff()) return;
    char text[300];
    std::snprintf(
        text, sizeof text,
        "the robot is %.6g x %.6g m, larger than the map (%.6g x %.6g m); is one of them not in metres? Correct the "
        "robot's lengths, or bake the scene again with --scale or with `scale` for its meshes in scene.yaml",
        size.x(), size.y(), room.x(), room.y());
    notice(args, text);
}

void notice_if_old(const CommonArgs& args, const Map& map)
{
    constexpr int oldest_with_tree = 5;  // geometry.bin of older versions is converted each time
    if (map.format_version < oldest_with_tree)
        notice(args, map.folder.string() + " has format " + std::to_string(map.format_version) +
                         ", which is slow to open; bake the map again to get format " +
                         std::to_string(map_format_version));
}

/// Returns the process that reads this scene or robot; nothing if it is read in this process. The process adds files
/// outside of its folder to the host's list. Throws ArgumentError for --confine without such a process.
std::optional<ReaderProcess> reader_for(const CommonArgs& args, const std::string& file,
                                        const std::vector<fs::path>& model_paths)
{
    std::optional<ReaderProcess> reader = args.trusted ? std::nullopt : args.host->reader;
    if (!args.confine.empty() && !reader)
        throw ArgumentError(
            "--confine needs the process that reads files apart from the program; leave out --trusted, "
            "and use the program in place of the library");
    if (!reader) return reader;
    reader->max_memory = memory_limit(args);
    reader->confine.assign(args.confine.begin(), args.confine.end());
    if (args.confine.empty() && args.confines_usually) reader->confine = usual_folders(file, model_paths);
    if (!reader->confine.empty()) reader->confine.push_back(file);  // what the user names is allowed
    reader->report = [host = args.host, file](const std::vector<fs::path>& files) {
        std::error_code unreachable;
        fs::path folder = fs::weakly_canonical(file, unreachable);
        if (!is_folder(folder)) folder = folder.parent_path();
        for (const fs::path& read : files)
            if (!is_in_folder(read, folder)) host->outside_files.insert(read.string());
    };
    return reader;
}

}  // namespace

Session open_session(const QueryArgs& args, Summary& summary)
{
    const JudgeOptions options = judge_options(args, summary.exact_time());
    Session session;
    std::optional<CollisionPreload> preload;
    if (!args.robot.empty()) {
        preload.emplace(args.threads);
        session.robot = open_robot(args, args.robot, robot_options(args));
    }
    const Map* const in_memory = args.host->input<Map>(args.map);
    session.map = in_memory != nullptr ? *in_memory : read_map(args.map);
    notice_if_old(args, session.map);
    if (args.has_changes()) session.map = changed_map(args, args, args, std::move(session.map));
    summary.map_hash = session.map.hash;
    summary.changes = session.map.changes;
    if (args.robot.empty()) return session;
    notice_if_larger_than_map(args, session.robot, session.map);
    session.judge.emplace(session.map, session.robot, options);
    return session;
}

Robot read_robot(const CommonArgs& args, const std::string& file, const RobotOptions& options)
{
    const std::optional<ReaderProcess> reader = reader_for(args, file, options.model_paths);
    return reader ? load_robot_apart(file, options, *reader) : load_robot(file, options);
}

Scene read_scene(const CommonArgs& args, const std::string& file, const SceneOptions& options)
{
    const std::optional<ReaderProcess> reader = reader_for(args, file, options.model_paths);
    return reader ? load_scene_apart(file, options, *reader) : load_scene(file, options);
}

Robot open_robot(const CommonArgs& args, const std::string& file, const RobotOptions& options)
{
    if (const Robot* const robot = args.host->input<Robot>(file)) return *robot;
    Robot robot = read_robot(args, file, options);
    notices(args, robot.notices);
    return robot;
}

Scene open_scene(const CommonArgs& args, const std::string& file, const SceneOptions& options)
{
    if (const Scene* const scene = args.host->input<Scene>(file)) return *scene;
    Scene scene = read_scene(args, file, options);
    notices(args, scene.notices);
    return scene;
}

PoseTable open_poses(const CommonArgs& args, const std::string& file)
{
    return PoseParts(args, file, PoseStream::all).next();
}

PoseParts::PoseParts(const CommonArgs& args, const std::string& file, std::size_t poses_of_part)
    : args_(args), in_memory_(args.host->input<PoseTable>(file)), poses_of_part_(poses_of_part)
{
    if (in_memory_ != nullptr) return;
    if (is_standard(file))
        stream_.emplace([&args](char* to, std::size_t size) { return read_standard_input(args, to, size); },
                        input_name(file), args.allow_empty);
    else
        stream_.emplace(file, args.allow_empty);
}

PoseTable PoseParts::next()
{
    if (in_memory_ != nullptr) {
        has_ended_ = true;
        return *in_memory_;
    }
    PoseTable part = stream_->next(poses_of_part_, args_.threads);
    has_ended_ = stream_->has_ended();
    for (const std::string& text : part.notices) notice(args_, text);
    return part;
}

double PoseParts::share() const { return stream_ ? stream_->share() : 1; }

void notice_if_off_map(const CommonArgs& args, const Map& map, const std::string& option, const Bounds& bounds)
{
    if (!bounds.is_empty() && !bounds.meets(map.bounds, 2))
        notice(args, option + " " + to_string(bounds, 2) + " lies off the map, which is " + to_string(map.bounds, 2));
}

void notice_if_no_layer(const CommonArgs& args, const Map& map, const LayerChoice& layers)
{
    if (layers.kind == LayerChoice::Kind::Index && layers.index >= map.layers)
        notice(args, "--layers " + std::to_string(layers.index) + " does not exist: a cell of the map has at most " +
                         counted(std::uint64_t(map.layers), "layer") + " (0 is the highest)");
}

void notice_about_heading(const CommonArgs& args, const Map& map, const std::optional<HeadingRule>& rule)
{
    if (!rule || rule->kind != HeadingRule::Kind::Clearest) return;
    const LabelCount& obstacles = map.geometry.labels()[std::size_t(Label::Obstacle)];
    if (obstacles.triangles + obstacles.primitives == 0)
        notice(args, "--yaw " + to_string(*rule) +
                         " measures the distance to obstacles, but the map has none, so the first valid heading is "
                         "used; `bake --auto-label slope=30` makes steep faces obstacles");
}

std::uint64_t count_tilted(const PoseTable& table)
{
    const auto is_tilted = [](const Pose& pose) { return pose.rotation(2, 2) < 1 - 1e-12; };
    return std::uint64_t(std::count_if(table.poses.begin(), table.poses.end(), is_tilted));
}

void notice_about_tilted(const CommonArgs& args, const std::string& file, std::uint64_t tilted)
{
    if (tilted > 0)
        notice(args, input_name(file) + ": roll and pitch of " + counted(tilted, "pose") +
                         " are not used, because the robot is let down level");
}

void NotValid::add(const VerdictReport& report)
{
    std::optional<std::vector<std::string>> names;  // made only if they are needed
    with_repairs_ = report.repairs != nullptr;
    all_ += report.judgements.size();
    for (std::size_t i = 0; i < report.judgements.size(); ++i) {
        if (!remains_invalid(report, i) || ++count_ > shown) continue;
        if (!names) names = pose_names(report.table, report.first);
        first_ += "\n  " + (*names)[i] + ": " + reason(report, i);
    }
}

std::string NotValid::words() const
{
    return std::to_string(count_) + " of " + counted(all_, "pose") + (count_ == 1 ? " is " : " are ") +
           (with_repairs_ ? "neither valid nor repaired:" : "not valid:") + first_ +
           (count_ > shown ? "\n  and " + std::to_string(count_ - shown) + " more" : "");
}

}  // namespace spawnfield::cli

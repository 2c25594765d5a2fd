#include "base/deflate.h"
#include "base/number.h"
#include "pairs/pair_ground.h"
#include "pairs/pair_json.h"
#include "poses/pose_json.h"

#include <spawnfield/pair_files.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <optional>

namespace spawnfield {
namespace {

void append_pose(std::string& text, const SettledPose& pose, double lift)
{
    for (const double value : {pose.position.x(), pose.position.y(), pose.position.z() + lift, pose.roll, pose.pitch}) {
        append_number(text, value);
        text += ',';
    }
    append_number(text, pose.yaw);
}

RobotStart start_of(const SettledPose& pose, double lift)
{
    return {"", "", pose.position + lift * Vec3::UnitZ(), {pose.roll, pose.pitch, pose.yaw}};
}

Json settled_json(const SettledPose& pose, double lift)
{
    Json out = pose_json(start_of(pose, lift));
    out["tilt"] = pose.tilt;
    out["margin"] = pose.margin;
    return out;
}

/// Returns a point in the frame of Habitat: x to the right, y up, z backwards.
Json habitat_point(const Vec3& point) { return {point.x(), point.z(), -point.y()}; }

/// Returns a pose of geometry_msgs, on the ground.
std::string pose_yaml(const SettledPose& pose)
{
    const Vec3 at = ground_of(pose);
    return "{header: {frame_id: map}, pose: {position: {x: " + number(at.x()) + ", y: " + number(at.y()) +
           ", z: " + number(at.z()) + "}, orientation: {x: 0, y: 0, z: " + number(std::sin(pose.yaw / 2)) +
           ", w: " + number(std::cos(pose.yaw / 2)) + "}}}";
}

}  // namespace

std::string pairs_csv(const PairList& list, double lift)
{
    std::string text =
        "start_x,start_y,start_z,start_roll,start_pitch,start_yaw,goal_x,goal_y,goal_z,goal_roll,"
        "goal_pitch,goal_yaw,path_length,straight,detour,island\n";
    for (const StartGoal& pair : list.pairs) {
        append_pose(text, pair.start, lift);
        text += ',';
        append_pose(text, pair.goal, lift);
        for (const double value : {pair.path_length, pair.straight, pair.detour()}) {
            text += ',';
            append_number(text, value);
        }
        text += ',' + std::to_string(pair.island) + '\n';
    }
    return text;
}

std::string paths_csv(const PairList& list, double lift)
{
    std::string text = "pair,pose,x,y,z,roll,pitch,yaw\n";
    for (std::size_t i = 0; i < list.pairs.size(); ++i)
        for (std::size_t k = 0; k < list.pairs[i].path.size(); ++k) {
            text += std::to_string(i) + ',' + std::to_string(k) + ',';
            append_pose(text, list.pairs[i].path[k], lift);
            text += '\n';
        }
    return text;
}

PairTable parse_pairs(std::string_view text, const std::string& name, bool allow_empty)
{
    return {parse_poses(text, name, allow_empty, "start_"), parse_poses(text, name, allow_empty, "goal_")};
}

void add_path_limits(Json& settings, const PairOptions& options)
{
    settings["min_path"] = options.min_path;
    if (std::isfinite(options.max_path)) settings["max_path"] = options.max_path;
    settings["detour"] = options.min_detour;
    settings["fast_paths"] = !options.shorten;
}

std::string pairs_json(const PairList& list, const Judge& judge, const PairOptions& options)
{
    Json settings = sample_settings_json(options.spawns, judge);
    add_path_limits(settings, options);
    Json out = json_head("sample", judge.map(), judge.robot(), std::move(settings), "spawnfield-pairs/1");
    if (list.is_stopped) out["interrupted"] = true;
    const double lift = judge.options().stand.lift;
    out["pairs"] = Json::array();
    for (const StartGoal& pair : list.pairs) {
        Json& row = out["pairs"].emplace_back();
        row["start"] = settled_json(pair.start, lift);
        row["goal"] = settled_json(pair.goal, lift);
        row["path_length"] = pair.path_length;
        row["straight"] = pair.straight;
        row["detour"] = pair.detour();
        row["island"] = pair.island;
    }
    return json_text(out, 2) + "\n";
}

std::string habitat_episodes(const PairList& list, const std::string& scene_id)
{
    Json episodes = Json::array();
    for (std::size_t k = 0; k < list.pairs.size(); ++k) {
        const StartGoal& pair = list.pairs[k];
        const double turn = pair.start.yaw - std::numbers::pi / 2;  // an agent that is not turned looks along our y
        Json& episode = episodes.emplace_back();
        episode["episode_id"] = std::to_string(k);
        episode["scene_id"] = scene_id;
        episode["start_position"] = habitat_point(ground_of(pair.start));
        episode["start_rotation"] = {0, std::sin(turn / 2), 0, std::cos(turn / 2)};
        episode["info"] = {{"geodesic_distance", pair.path_length}};
        episode["goals"] = {{{"position", habitat_point(ground_of(pair.goal))}, {"radius", nullptr}}};
        episode["start_room"] = nullptr;
        episode["shortest_paths"] = nullptr;
    }
    return gzip_bytes(json_text({{"episodes", std::move(episodes)}}, -1));
}

std::string nav2_goals(const PairList& list)
{
    std::string text = list.pairs.empty() ? "[]\n" : "";
    for (const StartGoal& pair : list.pairs)
        text += "- start: " + pose_yaml(pair.start) + "\n  goal: " + pose_yaml(pair.goal) +
                "\n  path_length: " + number(pair.path_length) + "\n";
    return text;
}

}  // namespace spawnfield

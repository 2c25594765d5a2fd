#include "change_args.h"

#include "angle.h"
#include "messages.h"
#include "numbers.h"
#include "session.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>
#include <spawnfield/frames.h>
#include <spawnfield/input_file.h>
#include <spawnfield/judge.h>
#include <spawnfield/place_rules.h>

#include <algorithm>
#include <filesystem>
#include <optional>

namespace spawnfield::cli {
namespace {

namespace fs = std::filesystem;

/// A robot of --with: ROBOT@x,y,yaw stands at rest on the highest layer, ROBOT@x,y,z,yaw is level at height z.
struct PlacedRobot {
    std::string robot;
    double x, y;  ///< m
    std::optional<double> z;
    double yaw;
};

/// Returns the robot of a value such as "husky.yaml@3,4,90deg"; nothing if it is a scene. Throws ArgumentError.
std::optional<PlacedRobot> parse_robot(const CommonArgs& common, const std::string& text)
{
    const std::size_t at = text.rfind('@');
    if (does_exist(text) || (at == std::string::npos && !text.starts_with("box:"))) return std::nullopt;
    const std::size_t comma = at == std::string::npos ? at : text.rfind(',');
    const std::string advice =
        "; write ROBOT@x,y,yaw for a robot at rest, or ROBOT@x,y,z,yaw for a level one (m, and "
        "radians or degrees such as 90deg)";
    if (comma == std::string::npos || comma < at)
        throw ArgumentError("--with \"" + text + "\" is a robot without a pose" + advice);
    const std::vector<double> place = parse_numbers("--with " + text, text.substr(at + 1, comma - at - 1), ',', advice);
    if (place.size() != 2 && place.size() != 3)
        throw ArgumentError("--with \"" + text + "\" has " + std::to_string(place.size() + 1) +
                            " numbers after the @, needs 3 or 4" + advice);
    return PlacedRobot{text.substr(0, at), place[0], place[1],
                       place.size() == 3 ? std::optional(place[2]) : std::nullopt,
                       parse_yaw(common, text.substr(comma + 1))};
}

/// Returns where the robot stands: level at its z, or at rest on the highest layer. Throws ArgumentError.
Pose pose_of(const PlacedRobot& placed, const Robot& robot, const Map& map, const std::string& text)
{
    if (placed.z) return {{placed.x, placed.y, *placed.z}, rotation_from_rpy(0, 0, placed.yaw)};
    const std::vector<double> layers = column_at(map.geometry, placed.x, placed.y).layers;
    if (layers.empty())
        throw ArgumentError("--with " + text + ": there is no terrain at x " + number(placed.x) + ", y " +
                            number(placed.y) + " for the robot; write ROBOT@x,y,z,yaw to give its height");
    const Judge judge(map, robot);
    const SettledPose rest = judge.settle({placed.x, placed.y, layers.front()}, placed.yaw);
    if (rest.verdict != Verdict::Valid)
        throw ArgumentError("--with " + text + ": the robot cannot stand there: " + judge.describe(rest) +
                            "; choose another place, or write ROBOT@x,y,z,yaw for a level robot at a given height");
    return rest.lifted(0);
}

/// Returns a name that no robot in the map has: husky, husky_2, …
std::string free_name(const std::string& name, const Map& map)
{
    const auto is_taken = [&](const std::string& candidate) {
        const std::vector<Part>& parts = map.geometry.parts();
        return std::any_of(parts.begin(), parts.end(),
                           [&](const Part& part) { return part.name.starts_with(candidate + "::"); });
    };
    std::string out = name.empty() ? "robot" : name;
    for (int count = 2; is_taken(out); ++count) out = (name.empty() ? "robot" : name) + "_" + std::to_string(count);
    return out;
}

Map with_robot(const CommonArgs& common, const PlacedRobot& placed, const RobotOptions& options,
               const std::string& text, const Map& map)
{
    const Robot robot = read_robot(common, placed.robot, options);
    notices(common, robot.notices);
    const std::string name = placed.robot.starts_with("box:") ? "box" : robot.name;
    Scene obstacle = robot_as_obstacle(robot, pose_of(placed, robot, map, text), free_name(name, map));
    obstacle.name = fs::path(placed.robot).filename().string() + text.substr(text.rfind('@'));
    return with_parts(map, obstacle, common.threads);
}

/// Reads a scene of --with.
Scene read_extra(const CommonArgs& common, const SceneOptions& options, const std::string& file)
{
    Scene extra = read_scene(common, file, options);
    notices(common, extra.notices);
    return extra;
}

/// `when` is the text of --time in the name of the change; empty if the scene has no moving parts.
Map with_scene(const CommonArgs& common, Scene extra, const std::string& file, const std::string& when, const Map& map)
{
    if (extra.origin)
        notice(common,
               file + ": its survey coordinates are not used; its parts are where the file's own frame has them");
    for (const std::string& part : parts_off_map(extra, map))
        notice(common, file + ": part \"" + part + "\" lies off the map, which is " + to_string(map.bounds, 2) +
                           "; only robots that reach over the map's edge can touch it");
    extra.name = fs::path(file).filename().string() + when;
    try {
        return with_parts(map, extra, common.threads);
    } catch (const ArgumentError& error) {
        throw FileError(file, error.message());
    }
}

/// Returns the globs of --without. Commas separate globs, unless a name matches the text as a whole.
std::vector<std::string> globs_of(const std::vector<std::string>& texts, const Map& map)
{
    std::vector<std::string> out;
    for (const std::string& text : texts) {
        if (text.find(',') == std::string::npos || !parts_that_match(map.geometry, text).empty()) {
            out.push_back(text);
            continue;
        }
        for (std::size_t from = 0, end = 0; end != std::string::npos; from = end + 1) {
            end = text.find(',', from);
            out.push_back(text.substr(from, end == std::string::npos ? end : end - from));
        }
    }
    return out;
}

TimeWindow parse_time(const std::string& text)
{
    const auto [from, to] = parse_limits("--time", text, "LOW:HIGH in s, for example 2:5 or 2:", "earlier time");
    return {from, to};
}

}  // namespace

void add_changes(CLI::App& command, ChangeArgs& args)
{
    start_group(command, help_group::changes);
    command
        .add_option("--with", args.with,
                    "Add the parts of a scene file (scene.yaml, or any other scene), or a robot as an obstacle: "
                    "ROBOT@x,y,yaw at rest, ROBOT@x,y,z,yaw level (m; radians, or degrees such as 90deg). Repeatable")
        ->allow_extra_args(false)
        ->check(not_empty());
    command
        .add_option("--without", args.without,
                    "Remove the parts whose names match this glob, before parts are added, for example 'crate*' or "
                    "'crate*,pallet' (repeatable; `info MAP` lists the names)")
        ->allow_extra_args(false)
        ->check(not_empty());
    command
        .add_option("--time", args.time,
                    "LOW:HIGH in s: parts of --with that have a path count with all their places in this time (2: or "
                    ":5 for one limit; default: with their whole path)")
        ->check(not_empty());
}

Map changed_map(const CommonArgs& common, const ChangeArgs& args, const ModelPathArgs& models, Map map)
{
    try {
        map = without_parts(map, globs_of(args.without, map), common.threads);
    } catch (const ArgumentError& error) {
        throw ArgumentError(std::string("--without ") + error.message());
    }
    const std::vector<fs::path> folders(models.model_paths.begin(), models.model_paths.end());
    const TimeWindow time = args.time.empty() ? TimeWindow{} : parse_time(args.time);
    bool has_moving_parts = false;
    for (const std::string& text : args.with) {
        const std::optional<PlacedRobot> robot = parse_robot(common, text);
        if (robot) {
            map = with_robot(common, *robot, {.model_paths = folders, .any_mesh = models.any_mesh}, text, map);
            continue;
        }
        Scene extra = read_extra(
            common, {.model_paths = folders, .any_mesh = models.any_mesh, .bounds = map.bounds, .time = time}, text);
        has_moving_parts |= extra.has_moving_parts;
        const std::string when = extra.has_moving_parts && !args.time.empty() ? " at " + args.time + " s" : "";
        map = with_scene(common, std::move(extra), text, when, map);
    }
    if (!args.time.empty() && !has_moving_parts)
        throw ArgumentError("--time is \"" + args.time +
                            "\", but no part of --with has a path; add one (docs/changing-worlds.md), or leave --time "
                            "out");
    const LabelCount& terrain = map.geometry.labels()[std::size_t(Label::Terrain)];
    if (args.has_changes() && terrain.triangles + terrain.primitives == 0)
        notice(common, "the changed map has no terrain, so no robot can stand anywhere");
    return map;
}

}  // namespace spawnfield::cli

#include "avoid_args.h"

#include "messages.h"
#include "numbers.h"
#include "session.h"
#include "streams.h"

#include <algorithm>

namespace spawnfield::cli {
namespace {

/// Returns the distance for each file. Throws ArgumentError.
std::vector<double> distances_of(const AvoidArgs& args, double min_distance)
{
    if (args.files.empty() && !args.distances.empty()) throw ArgumentError("--avoid-distance needs --avoid FILE");
    for (const double distance : args.distances)
        if (parse_finite("--avoid-distance", distance, "m") < 0)
            throw bad_value("--avoid-distance", distance, ">= 0 m");
    if (args.distances.size() == args.files.size()) return args.distances;
    if (args.distances.size() == 1) return std::vector<double>(args.files.size(), args.distances[0]);
    if (!args.distances.empty())
        throw ArgumentError("--avoid-distance is given " + std::to_string(args.distances.size()) +
                            " times, needs once or once for each --avoid (" + std::to_string(args.files.size()) + ")");
    if (!(min_distance > 0))
        throw ArgumentError(
            "--avoid needs --avoid-distance M, or --min-distance > 0 (the default of --avoid-distance)");
    return std::vector<double>(args.files.size(), min_distance);
}

}  // namespace

void add_avoid(CLI::App& command, AvoidArgs& args)
{
    start_group(command, help_group::region);
    command
        .add_option("--avoid", args.files,
                    "CSV file of poses, for example of robots that are placed already. No spawn is nearer to one of "
                    "them than --avoid-distance (repeatable; - for standard input)")
        ->allow_extra_args(false);
    command
        .add_option("--avoid-distance", args.distances,
                    "Smallest distance between a spawn and each pose of --avoid, from origin to origin in 3D, m "
                    "(default: --min-distance; given once for all files, or once for each file)")
        ->allow_extra_args(false);
}

std::vector<AvoidedPoints> read_avoided(const CommonArgs& common, const AvoidArgs& args, double min_distance)
{
    const std::vector<double> distances = distances_of(args, min_distance);
    std::vector<AvoidedPoints> out;
    for (std::size_t i = 0; i < args.files.size(); ++i) {
        AvoidedPoints& group = out.emplace_back();
        group.name = input_name(args.files[i]);
        group.distance = distances[i];
        for (const Pose& pose : open_poses(common, args.files[i]).poses) group.points.push_back(pose.position);
        if (group.distance == 0) notice(common, "--avoid " + group.name + " has no effect: its --avoid-distance is 0");
    }
    return out;
}

void notice_about_avoided(const CommonArgs& common, const Map& map, const std::vector<AvoidedPoints>& avoid)
{
    for (const AvoidedPoints& group : avoid) {
        const auto is_off = [&](const Vec3& p) { return !map.bounds.contains_xy(p.x(), p.y(), group.distance); };
        if (!group.points.empty() && std::all_of(group.points.begin(), group.points.end(), is_off))
            notice(common, "--avoid " + group.name + ": all of its " + counted(group.points.size(), "pose") +
                               " lie off the map, which is " + to_string(map.bounds, 2));
    }
}

std::string words_of(const AvoidedPoints& group)
{
    return group.name + ": " + counted(group.points.size(), "pose") + ", " + number(group.distance) + " m";
}

}  // namespace spawnfield::cli

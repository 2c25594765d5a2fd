#include "heatmap_marks.h"

#include "check_pairs.h"
#include "messages.h"
#include "numbers.h"
#include "spelling.h"
#include "streams.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>
#include <spawnfield/fleet_file.h>
#include <spawnfield/pair_files.h>

#include <algorithm>

namespace spawnfield::cli {
namespace {

/// Returns the column `name` of a table, or the numbers of its rows, from 1 on.
std::vector<std::string> names_of(const PoseTable& table)
{
    std::vector<std::string> out = column_of(table, "name");
    if (!out.empty()) return out;
    for (std::size_t row = 1; row <= table.poses.size(); ++row) out.push_back(std::to_string(row));
    return out;
}

std::vector<Vec3> places_of(const PoseTable& table)
{
    std::vector<Vec3> out;
    for (const Pose& pose : table.poses) out.push_back(pose.position);
    return out;
}

/// Returns the kind of each spawn: the index of the text in its column `kind` among the kinds of the fleet file.
std::vector<std::size_t> kinds_of(const PoseTable& table, const HeatmapMarkArgs& args, const FleetFile& fleet)
{
    const std::string file = input_name(args.spawns);
    const std::vector<std::string> texts = column_of(table, "kind");
    if (texts.size() != table.poses.size())
        throw FileError(file, "column kind is missing, but --fleet needs it; `sample --fleet` writes it");
    std::string known;
    for (const FleetFileKind& kind : fleet.kinds) known += (known.empty() ? "" : ", ") + kind.name;
    std::vector<std::size_t> out;
    for (const std::string& text : texts) {
        const auto found = std::ranges::find(fleet.kinds, text, &FleetFileKind::name);
        if (found == fleet.kinds.end())
            throw FileError(file, "pose " + std::to_string(out.size() + 1) + ": column kind is \"" + text +
                                      "\", needs a kind of " + args.fleet + ": " + known);
        out.push_back(std::size_t(found - fleet.kinds.begin()));
    }
    return out;
}

/// Returns the paths of a file that `sample --pairs --path` writes. A row begins a path if its column `pair` differs
/// from that of the row before.
std::vector<std::vector<Vec3>> paths_of(const PoseTable& table, const std::string& file)
{
    const std::vector<std::string> pairs = column_of(table, "pair");
    if (pairs.size() != table.poses.size())
        throw FileError(input_name(file), "column pair is missing; `sample --pairs N --path FILE` writes it");
    std::vector<std::vector<Vec3>> out;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (i == 0 || pairs[i] != pairs[i - 1]) out.emplace_back();
        out.back().push_back(table.poses[i].position);
    }
    return out;
}

/// Returns whether what is at a place stands on ground in a range of heights: the highest layer at or below the place,
/// or, if there is none, the lowest one above.
bool stands_within(const Map& map, const ZRange& z, const Vec3& place)
{
    const std::vector<double> layers = column_at(map.geometry, place.x(), place.y()).layers;
    const auto below = std::ranges::find_if(layers, [&](double layer) { return layer <= place.z() + touch_tolerance; });
    if (layers.empty()) return false;
    return z.contains(below == layers.end() ? layers.back() : *below, touch_tolerance);
}

/// Keeps the items whose flag is 1. A list of another size, which is empty, stays as it is.
template <class Item>
void keep_flagged(std::vector<Item>& items, const std::vector<std::uint8_t>& flags)
{
    if (items.size() != flags.size()) return;
    std::size_t next = 0;
    std::erase_if(items, [&](const Item&) { return flags[next++] == 0; });
}

/// Returns the parts of paths whose places have a flag. A part has at least two places.
std::vector<std::vector<Vec3>> parts_of(const std::vector<std::vector<Vec3>>& paths,
                                        const std::function<bool(const Vec3&)>& is_kept)
{
    std::vector<std::vector<Vec3>> out;
    for (const std::vector<Vec3>& path : paths) {
        std::vector<Vec3> part;
        const auto end_part = [&] {
            if (part.size() > 1) out.push_back(part);
            part.clear();
        };
        for (const Vec3& place : path)
            if (is_kept(place))
                part.push_back(place);
            else
                end_part();
        end_part();
    }
    return out;
}

KindRobots read_spawns(const QueryArgs& query, const HeatmapMarkArgs& args, HeatmapOptions& picture)
{
    const PoseTable table = open_poses(query, args.spawns);
    picture.spawns = spawns_of(table);
    if (args.names) picture.spawn_names = names_of(table);
    if (args.fleet.empty()) {
        picture.spawn_verdicts = verdicts_of(table, args.spawns);
        return {};
    }
    const FleetFile fleet = read_fleet(args.fleet);
    picture.spawn_kinds = kinds_of(table, args, fleet);
    KindRobots robots;
    for (const FleetFileKind& kind : fleet.kinds) {
        robots.push_back(std::make_unique<const Robot>(read_robot(query, kind.robot, robot_options(query))));
        picture.kinds.push_back({kind.name, robots.back().get()});
    }
    return robots;
}

}  // namespace

void add_heatmap_marks(CLI::App& command, HeatmapMarkArgs& args)
{
    command.add_option("--spawns", args.spawns,
                       "CSV file of spawns to draw, as footprints of the robot or as arrows. A column verdict (from "
                       "`check`) gives their colours (- for standard input)");
    command
        .add_option("--fleet", args.fleet,
                    "Fleet file of --spawns: each spawn gets the outline and the colour of its kind (column kind)")
        ->check(not_empty());
    command.add_option("--pairs", args.pairs,
                       "CSV file of pairs to draw, from `sample --pairs` or `check --pairs`: starts as discs, goals as "
                       "diamonds (- for standard input)");
    command.add_option(
        "--paths", args.paths,
        "CSV file of paths to draw as lines, from `sample --pairs N --path FILE` (- for standard input)");
}

void add_heatmap_names(CLI::App& command, HeatmapMarkArgs& args)
{
    command.add_flag("--names", args.names,
                     "Write the name of each spawn or pair beside it: its column name, or the number of its row, from "
                     "1");
}

KindRobots read_marks(const QueryArgs& query, const HeatmapMarkArgs& args, HeatmapOptions& picture)
{
    if (args.names && args.spawns.empty() && args.pairs.empty())
        throw ArgumentError("--names needs --spawns or --pairs, because it writes their names");
    if (!args.fleet.empty() && args.spawns.empty())
        throw ArgumentError("--fleet needs --spawns, the file that `sample --fleet` has written");
    KindRobots robots;
    if (!args.spawns.empty()) robots = read_spawns(query, args, picture);
    if (!args.pairs.empty()) {
        const PairTable table = open_pairs(query, args.pairs);
        picture.starts = places_of(table.starts);
        picture.goals = places_of(table.goals);
        if (args.names) picture.start_names = picture.goal_names = names_of(table.starts);
    }
    if (!args.paths.empty()) picture.paths = paths_of(open_poses(query, args.paths), args.paths);
    return robots;
}

void keep_heights(const CommonArgs& common, const Map& map, const ZRange& z, HeatmapOptions& picture)
{
    if (z.is_unlimited()) return;
    const auto is_kept = [&](const Vec3& place) { return stands_within(map, z, place); };
    const auto flags_of = [&](const std::vector<Vec3>& places, const std::string& noun) {
        std::vector<std::uint8_t> flags;
        for (const Vec3& place : places) flags.push_back(is_kept(place));
        const auto left_out = std::uint64_t(std::ranges::count(flags, 0));
        if (left_out > 0)
            notice(common, std::to_string(left_out) + " of " + counted(flags.size(), noun) +
                               (left_out == 1 ? " stands on ground at another height, and is not drawn"
                                              : " stand on ground at other heights, and are not drawn"));
        return flags;
    };
    std::vector<Vec3> positions;
    for (const Spawn& spawn : picture.spawns) positions.push_back(spawn.position);
    const std::vector<std::uint8_t> spawns = flags_of(positions, "spawn"), starts = flags_of(picture.starts, "start"),
                                    goals = flags_of(picture.goals, "goal");
    keep_flagged(picture.spawns, spawns);
    keep_flagged(picture.spawn_verdicts, spawns);
    keep_flagged(picture.spawn_names, spawns);
    keep_flagged(picture.spawn_kinds, spawns);
    keep_flagged(picture.starts, starts);
    keep_flagged(picture.start_names, starts);
    keep_flagged(picture.goals, goals);
    keep_flagged(picture.goal_names, goals);
    picture.paths = parts_of(picture.paths, is_kept);
}

}  // namespace spawnfield::cli

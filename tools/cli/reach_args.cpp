#include "reach_args.h"

#include "messages.h"
#include "numbers.h"
#include "spelling.h"

#include <spawnfield/input_file.h>
#include <spawnfield/kept_graph.h>
#include <spawnfield/memory.h>
#include <spawnfield/room.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

namespace spawnfield::cli {
namespace {

const std::string place_help = "x,y or x,y,z in m";

StartPlace parse_place(const std::string& option, const std::string& text)
{
    const std::vector<double> values = parse_numbers(option, text);
    if (values.size() != 2 && values.size() != 3)
        throw ArgumentError(option + " is \"" + text + "\", needs " + place_help + ", for example 1.5,-2");
    StartPlace out{values[0], values[1]};
    if (values.size() == 3) out.z = values[2];
    return out;
}

/// Reads the value of --island.
void parse_island(const std::string& text, IslandChoice& choice)
{
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (text == "largest")
        choice.largest = true;
    else if (text == "all")
        choice.largest = false;
    else if (text.starts_with("at:"))
        choice.at = parse_place("the place of --island", text.substr(3));
    else if (!text.empty() && text.size() < 10 && std::all_of(text.begin(), text.end(), is_digit))
        choice.number = std::stoul(text);
    else
        throw ArgumentError(
            "--island is \"" + text +
            "\", needs largest, all, the number of an island (`spawnfield info MAP --robot R --islands` "
            "lists them), or at:x,y or at:x,y,z in m");
}

/// Returns "only island 3", "only islands 0, 2, 5", "12 islands selected" or "no island selected".
std::string island_words(const std::vector<std::size_t>& chosen)
{
    constexpr std::size_t most_listed = 5;
    if (chosen.empty()) return "no island selected";
    if (chosen.size() > most_listed) return std::to_string(chosen.size()) + " islands selected";
    std::string list;
    for (const std::size_t island : chosen) list += (list.empty() ? "" : ", ") + std::to_string(island);
    return (chosen.size() == 1 ? "only island " : "only islands ") + list;
}

/// Returns why a choice selects no island.
std::string why_none(const IslandChoice& choice, const ReachGraph& graph)
{
    if (graph.islands().empty()) return "no island is selected: there is none, because the robot can stand nowhere";
    const double largest = graph.islands()[0].area;
    if (choice.min_area > largest)
        return "no island is selected: --min-island is " + number(choice.min_area) +
               " m2, but the largest island has " + rounded(largest) + " m2; give a smaller --min-island";
    return "no island is selected: none fulfils --island, --min-island and --reachable-from together; leave one of "
           "them out";
}

}  // namespace

void add_reach(CLI::App& command, ReachArgs& args)
{
    start_group(command, help_group::reach);
    command
        .add_option("--drive", args.drive,
                    "How the robot moves: differential (ahead, back, and turns on the spot), omni (also to the sides), "
                    "legged (as omni) or car (ahead and back, in curves) (default: that of robot.yaml, or "
                    "differential)")
        ->check(one_of({drive_names.begin(), drive_names.end()}).description(""));
    command.add_option("--turning-radius", args.turning_radius,
                       "m: smallest radius of the curves of a car (default: that of robot.yaml)");
    command.add_option("--max-step", args.max_step,
                       "m: largest step up or down in the ground that the robot overcomes (default: that of "
                       "robot.yaml, or a quarter of the wheel radius, or 0.03)");
    command.add_option("--reach-step", args.reach_step,
                       "m between the places whose ways are examined (default: a quarter of the robot's smallest "
                       "width)");
}

void add_islands(CLI::App& command, IslandArgs& args)
{
    start_group(command, help_group::reach);
    command.add_option("--island", args.island,
                       "Only poses on this island (ground within which the robot can drive): largest, its number in "
                       "`spawnfield info MAP --robot R --islands`, or at:x,y or at:x,y,z in m. Other poses are "
                       "unreachable (default all; largest if no label was given for the scene)");
    command.add_option("--min-island", args.min_island, "m2: only poses on islands of at least this area");
    command
        .add_option("--reachable-from", args.reachable_from,
                    "Only poses to which the robot can drive from this place, " + place_help +
                        ". Repeatable: from one of these places or more")
        ->allow_extra_args(false);
    add_reach(command, args);
}

ReachOptions reach_options(const QueryArgs& query, const ReachArgs& args)
{
    return {.drive = args.drive.empty() ? std::nullopt : std::optional(drive_called(args.drive)),
            .max_step = args.max_step,
            .turning_radius = args.turning_radius,
            .step = args.reach_step,
            .threads = query.threads};
}

namespace {

/// Prints a notice if a graph that is not kept has very many columns.
void notice_if_long(const QueryArgs& query, const ReachOptions& options, const Session& session)
{
    constexpr double many = 100000;
    const Vec3 size = session.map.bounds.max - session.map.bounds.min;
    const double columns = size.x() * size.y() / (*options.step * *options.step);
    if (columns < many || does_exist(kept_graph_file(*session.judge, options))) return;
    notice(query, "islands: about " + rounded(columns / 1e6) + " million places are examined, " +
                      rounded(*options.step) +
                      " m apart, which may take long; a larger --reach-step takes less time, but misses narrow "
                      "passages");
}

void require_memory_for(const QueryArgs& query, const ReachOptions& options, const Session& session)
{
    constexpr double per_place = 32;  // bytes; measured with 25 million places
    const Vec3 size = session.map.bounds.max - session.map.bounds.min;
    require_cell_memory({.per_item = per_place}, "--reach-step", *options.step, size.x() * size.y(),
                        memory_limit(query));
}

}  // namespace

ReachGraph find_islands(const QueryArgs& query, const ReachArgs& args, const Session& session, Summary& summary,
                        const std::string& command, bool keep_ways)
{
    ReachOptions options = with_defaults(reach_options(query, args), session.robot);
    options.keep_ways = keep_ways;
    require_memory_for(query, options, session);
    notice_if_long(query, options, session);
    options.progress = progress_bar(query, command + ", islands");
    const KeptGraph kept = kept_graph(*session.judge, options);
    if (!kept.notice.empty()) notice(query, kept.notice);
    char seconds[40];
    std::snprintf(seconds, sizeof seconds, kept.is_read ? " read in %.3f s" : " found in %.2f s",
                  summary.lap("islands"));
    summary.extra.push_back(counted(kept.graph.islands().size(), "island") + seconds + ", reach step " +
                            rounded(*options.step) + " m");
    return kept.graph;
}

IslandChoice island_choice(const QueryArgs& query, const IslandArgs& args, const CLI::App& command)
{
    if (!query.is_settled())
        refuse(command, island_option_names,
               "is only for settled robots, because islands are where they can drive; leave --stance level out");
    IslandChoice out{.min_area = args.min_island};
    if (command.count("--min-island") > 0) parse_positive("--min-island", args.min_island);
    if (command.count("--island") > 0 || !args.island.empty()) parse_island(args.island, out);
    for (const std::string& text : args.reachable_from)
        out.reachable_from.push_back(parse_place("--reachable-from", text));
    return out;
}

IslandChoice choice_for(const Map& map, const QueryArgs& query, const IslandArgs& args, const CLI::App& command,
                        const IslandChoice& choice, bool needs_graph)
{
    IslandChoice out = choice;
    if (map.is_unlabelled && query.is_settled() && args.island.empty() && choice.selects_all()) {
        out.largest = true;
        notice(query, "no label was given for the scene of " + map.name +
                          ", so everything is terrain, also desks and wall tops; only the largest island is used "
                          "(--island all uses all ground)");
    }
    if (out.selects_all() && !needs_graph)
        refuse(command, reach_option_names,
               "is only for --island, --min-island and --reachable-from; give one of them");
    return out;
}

std::string words_of(const IslandChoice& choice)
{
    std::string places, out;
    for (const StartPlace& place : choice.reachable_from) places += (places.empty() ? "" : " or ") + to_string(place);
    const auto add = [&](bool is_given, const std::string& text) {
        if (is_given) out += (out.empty() ? "" : ", ") + text;
    };
    add(choice.largest, "island largest");
    if (choice.number) add(true, "island " + std::to_string(*choice.number));
    if (choice.at) add(true, "island at:" + to_string(*choice.at));
    add(choice.min_area > 0, "islands from " + number(choice.min_area) + " m2");
    add(!places.empty(), "reachable from " + places);
    return out;
}

bool are_islands_quick(const QueryArgs& query, const ReachArgs& args, const Session& session)
{
    // A graph of so many columns, and with so few triangles and primitives, mostly takes a fraction of a second.
    constexpr double small_map = 5000;
    constexpr std::uint64_t few_elements = 20000;
    const ReachOptions options = reach_options(query, args);
    if (does_exist(kept_graph_file(*session.judge, options))) return true;
    const double step = *with_defaults(options, session.robot).step;
    const Vec3 size = session.map.bounds.max - session.map.bounds.min;
    std::uint64_t elements = 0;
    for (const LabelCount& label : session.map.geometry.labels()) elements += label.triangles + label.primitives;
    return size.x() * size.y() <= small_map * step * step && elements <= few_elements;
}

void notice_about_islands(const QueryArgs& query, const IslandArgs& args, const Session& session, const SpawnList& list)
{
    constexpr std::size_t examined = 1000;  // spawns
    constexpr double small_island = 5;      // m2
    if (!are_islands_quick(query, args, session)) return;
    const ReachOptions options = reach_options(query, args);
    const ReachGraph graph = kept_graph(*session.judge, options).graph;
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < std::min(examined, list.spawns.size()); ++i)
        poses.push_back({list.spawns[i].position, rotation_from_rpy(0, 0, list.spawns[i].yaw)});
    std::map<std::size_t, std::size_t> counts;  // by island; the number of islands: none
    std::size_t on_small = 0;
    for (const SettledPose& pose : session.judge->settle(poses, {.threads = query.threads})) {
        if (pose.verdict != Verdict::Valid) continue;  // it has other ground below its origin
        const std::size_t island = graph.island_of(pose).value_or(graph.islands().size());
        ++counts[island];
        on_small += island == graph.islands().size() || graph.islands()[island].area < small_island;
    }
    if (counts.size() < 2) return;
    const auto share = [&](std::size_t count) {
        return std::to_string(std::lround(100 * double(count) / double(poses.size()))) + " %";
    };
    const auto most = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
    notice(query, "the spawns stand on " + std::to_string(counts.size()) + " islands, between which " +
                      session.robot.name + " cannot drive: " + share(most->second) + " on one, " + share(on_small) +
                      " on islands smaller than " + number(small_island) +
                      " m2; --island largest excludes all but the largest (--island all: no notice)");
}

ChosenIslands choose_islands(const QueryArgs& query, const IslandArgs& args, const IslandChoice& choice,
                             const Session& session, Summary& summary, const std::string& command, bool needs_ways)
{
    if (choice.selects_all() && !needs_ways) return {};
    const ReachGraph graph = find_islands(query, args, session, summary, command, needs_ways);
    if (choice.selects_all()) return {.graph = graph};
    const std::vector<std::size_t> islands = chosen_islands(graph, *session.judge, choice);
    summary.extra.push_back(island_words(islands));
    return {graph, on_islands(graph, islands), islands.empty() ? why_none(choice, graph) : ""};
}

void set_room(PlaceMeasures& measures, const ChosenIslands& chosen)
{
    if (asks_for(measures, PlaceQuantity::Room)) measures.room = room_on(*chosen.graph, measures.room_range);
}

}  // namespace spawnfield::cli

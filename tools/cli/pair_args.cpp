#include "pair_args.h"

#include "messages.h"
#include "numbers.h"
#include "output.h"

#include <spawnfield/error.h>
#include <spawnfield/pair_files.h>

#include <algorithm>

namespace spawnfield::cli {
namespace {

bool is_pair_format(const std::string& format)
{
    return std::find(pair_formats.begin(), pair_formats.end(), format) != pair_formats.end();
}

std::string text_of(const PairArgs& args, const std::string& format, const Session& session, const PairList& list,
                    const PairOptions& options)
{
    if (format == "json") return pairs_json(list, *session.judge, options);
    if (format == "habitat") return habitat_episodes(list, args.scene_id.empty() ? session.map.name : args.scene_id);
    if (format == "nav2-goals") return nav2_goals(list);
    return pairs_csv(list, session.judge->options().stand.lift);
}

}  // namespace

void add_pair_limits(CLI::App& command, PairArgs& args)
{
    command.add_option("--min-path", args.min_path, "m: shortest path of a pair (default 0)");
    command.add_option("--max-path", args.max_path, "m: longest path of a pair (default: any)");
    command.add_option("--detour", args.detour,
                       "Smallest ratio of the path's length to the straight line, >= 1 (default 1)");
    command.add_flag("--fast-paths", args.fast_paths,
                     "Paths of pairs have 16 headings only: in the open they are up to 2.8 % longer, but are found in "
                     "less time");
}

PairOptions pair_limits(const PairArgs& args)
{
    parse_finite("--min-path", args.min_path, "m");
    parse_finite("--detour", args.detour, "");
    if (args.min_path < 0) throw bad_value("--min-path", args.min_path, ">= 0 m");
    if (!(args.max_path >= args.min_path) || args.max_path <= 0)
        throw bad_value("--max-path", args.max_path, "> 0 m, and not below --min-path");
    if (args.detour < 1) throw bad_value("--detour", args.detour, ">= 1");
    return {
        .min_path = args.min_path, .max_path = args.max_path, .min_detour = args.detour, .shorten = !args.fast_paths};
}

void add_pairs(CLI::App& command, PairArgs& args)
{
    command.add_option("--pairs", args.count,
                       "Write this number of pairs of a start and a goal on one island, in place of spawns, with the "
                       "length of the path between them");
    add_pair_limits(command, args);
    command.add_option("--path", args.path, "CSV file to write: the poses on the path of each pair");
    command.add_option("--scene-id", args.scene_id,
                       "With --format habitat: name of the scene in the episodes (default: the map's name)");
}

void refuse_pair_options(const CLI::App& command, const std::string& format)
{
    std::vector<std::string> names = pair_limit_names;
    names.insert(names.end(), {"--path", "--scene-id"});
    refuse(command, names, "is only for --pairs; give it, or leave this option out");
    if (is_pair_format(format)) throw ArgumentError("--format " + format + " is only for --pairs; give it, too");
}

PairOptions pair_options(const PairArgs& args, const CLI::App& command, bool is_settled, const std::string& format)
{
    refuse(command, {"--count", "--min-distance", "--columns"}, "has no effect with --pairs; leave it out");
    if (!is_settled)
        throw ArgumentError(
            "--pairs is only for settled robots, because paths lead between settled poses; leave --stance level out");
    if (format != "csv" && format != "json" && !is_pair_format(format))
        throw ArgumentError("--format is " + format + ", but --pairs writes csv, json, habitat or nav2-goals");
    if (format != "habitat") refuse(command, {"--scene-id"}, "is only for --format habitat; leave it out");
    if (args.count < 1 || args.count > static_cast<long long>(max_spawns))
        throw bad_value("--pairs", double(args.count), "1 to " + std::to_string(max_spawns));
    PairOptions out = pair_limits(args);
    out.keep_paths = !args.path.empty();
    return out;
}

void write_pairs(const CommonArgs& common, const PairArgs& args, const std::string& format, const std::string& out,
                 const Session& session, const PairList& list, const PairOptions& options)
{
    const auto write_paths = [&] {
        const double lift = session.judge->options().stand.lift;
        if (!args.path.empty()) write_output(common, args.path, [&](const auto& sink) { sink(paths_csv(list, lift)); });
    };
    write_output(
        common, out, [&](const auto& sink) { sink(text_of(args, format, session, list, options)); }, write_paths);
}

std::string shortfall_of_pairs(const PairList& list, std::size_t wanted)
{
    return "only " + std::to_string(list.pairs.size()) + " of " + std::to_string(wanted) +
           " pairs were found: " + std::to_string(list.without_goal) + " of " + counted(list.starts, "drawn start") +
           " have no goal that was found (" + counted(list.searches, "path") +
           " searched); a smaller --min-path or --detour, a larger --max-path or region, or other islands may give "
           "more";
}

}  // namespace spawnfield::cli

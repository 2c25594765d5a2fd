#include "angle.h"
#include "area_args.h"
#include "avoid_args.h"
#include "command.h"
#include "fleet_args.h"
#include "ground_args.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "pair_args.h"
#include "place_args.h"
#include "reach_args.h"
#include "results.h"
#include "simulator_output.h"
#include "spawn_advice.h"
#include "spawn_args.h"
#include "spelling.h"
#include "thesis_output.h"

#include <spawnfield/error.h>
#include <spawnfield/spawn_file.h>

#include <cctype>
#include <cstdio>
#include <limits>

namespace spawnfield::cli {
namespace {

struct SpawnArgs : QueryArgs {
    DrawArgs draws;
    SimulatorArgs simulator;
    AreaArgs area;
    AvoidArgs avoid;
    GroundArgs ground;
    IslandArgs islands;  ///< only for `sample`
    PairArgs pairs;      ///< only for `sample`
    FleetArgs fleet;     ///< only for `sample`
    PlaceArgs places;    ///< only for `sample`
    std::string bounds, yaw = "0", format = "csv", out;

    bool is_thesis() const { return format == "thesis"; }
};

std::string upper_first(std::string text)
{
    if (!text.empty()) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

bool has_place_rules(const SearchOptions&) { return false; }
bool has_place_rules(const SampleOptions& options)
{
    return options.place.has_limits() || !options.measures.prefer.empty();
}

/// Returns why fewer spawns than wanted were found, and what may give more. Here and below, `Options` is SearchOptions
/// or SampleOptions.
template <class Options>
std::string shortfall(const Options& options, const SpawnArgs& args, const SpawnList& list, const std::string& command)
{
    const std::string found = std::to_string(list.spawns.size()), wanted = std::to_string(options.count),
                      only = list.spawns.empty() ? "none of " + wanted + " spawns was found"
                                                 : "only " + found + " of " + wanted + " spawns were found";
    const std::string advice = spawn_advice(args, args.ground,
                                            {.is_search = command == "search",
                                             .min_distance = options.min_distance,
                                             .has_region = !options.area.is_everywhere(),
                                             .is_near_avoided = list.near_avoided > 0,
                                             .has_place_rules = has_place_rules(options),
                                             .counts = list.counts});
    if (list.is_full && list.spawns.empty())
        return std::string("no spawn fits: it is proven that no pose is valid") +
               (list.near_avoided > 0 ? " and far enough from the avoided poses; " : "; ") + advice + " may give some";
    if (list.is_full)
        return "only " + found + " of " + wanted + " spawns fit: it is proven that none can be added to these " +
               found + "; " + advice + " may give more";
    if (command == "search" || args.is_settled() || has_place_rules(options))
        return only + "; " + advice + " may give " + (list.spawns.empty() ? "some" : "more");
    char area[32];
    std::snprintf(area, sizeof area, "%.3g", list.undecided_area);
    return only + ". Another one may fit in " + area + " m2 of the region; it is proven that none fits elsewhere. " +
           upper_first(advice) + " may give more";
}

/// Returns where the draws lie that SpawnList::off_area counts. Without a region, they are draws of a search whose
/// ground is beyond the heights of the box.
template <class Options>
std::string off_area_words(const Options& options)
{
    return options.area.is_everywhere() ? "above ground beyond the heights of --z or --bounds" : "off the region";
}

/// Returns the options, then those that only this command has (`own`), then what was found.
template <class Options>
Settings settings_of(const SpawnArgs& args, const Session& session, const Options& options, const SpawnList& list,
                     const std::string& command, const Settings& own)
{
    Settings out = query_settings(command, args, session);
    const auto add = [&](const std::string& name, const std::string& value) { out.emplace_back(name, value); };
    add("Seed", std::to_string(options.seed));
    add("Count", std::to_string(options.count));
    add("Min distance (m)", number(options.min_distance));
    add("Yaw (rad)", yaw_text(options.heading, options.random_yaw, options.yaw));
    add("Bounds (m, z up)",
        bounds_text(options.bounds.is_empty() ? session.map.bounds : options.bounds, command == "sample" ? 2 : 3));
    for (const Region& region : options.area.within) add("Region", region.name);
    for (const Region& region : options.area.keep_out) add("Keep out", region.name);
    for (const AvoidedPoints& group : options.avoid) add("Avoid", words_of(group));
    const JudgeOptions& limits = session.judge->options();
    add("Max water depth (m)", number(limits.max_water_depth));
    if (std::isfinite(limits.max_slope)) add("Max slope (rad)", number(limits.max_slope));
    out.insert(out.end(), own.begin(), own.end());
    add("Spawns", std::to_string(list.spawns.size()));
    add("Draws", std::to_string(list.draws));
    if (!options.area.is_everywhere() || list.off_area > 0)
        add(upper_first("draws " + off_area_words(options)), std::to_string(list.off_area));
    if (!options.avoid.empty()) add("Draws near avoided poses", std::to_string(list.near_avoided));
    add("Draws too close", std::to_string(list.too_close));
    add("Positions that are not valid", "counted, not written");
    if (list.is_stopped) add("Interrupted", "yes");
    return out;
}

template <class Options>
void write(const SpawnArgs& args, const SimulatorOutput& output, const Session& session, const Options& options,
           const SpawnList& list)
{
    std::vector<RobotStart> robots;
    std::vector<std::string> names;
    if (output.has_names() || args.format != "csv") robots = robot_starts(list);
    if (output.has_names()) {
        output.give_names(robots);
        for (const RobotStart& robot : robots) names.push_back(robot.name);
    }
    if (args.format == "csv")
        return write_output(args, args.out, [&](const auto& sink) { write_spawns_csv(list, names, sink); });
    output.write(robots, session.map, [&] { return spawns_json(robots, list, *session.judge, options); });
}

template <class Options>
void fill(Summary& summary, const Options& options, const SpawnList& list)
{
    summary.set_verdicts(list.counts, list.exact_checks);
    summary.seed = options.seed;
    summary.extra.insert(summary.extra.begin(),
                         std::to_string(list.spawns.size()) + " of " + std::to_string(options.count) + " spawns");
    summary.extra.push_back(
        counted(list.draws, "draw") + ", " + std::to_string(list.too_close) + " too close" +
        (options.avoid.empty() ? "" : ", " + std::to_string(list.near_avoided) + " near avoided poses") +
        (options.area.is_everywhere() && list.off_area == 0
             ? ""
             : ", " + std::to_string(list.off_area) + " " + off_area_words(options)) +
        (has_place_rules(options) ? ", " + std::to_string(list.off_rules) + " against the rules of place" : "") +
        (list.not_preferred > 0 ? ", " + std::to_string(list.not_preferred) + " not preferred" : ""));
    summary.draws = {{"all", list.draws},
                     {"too_close", list.too_close},
                     {"near_avoided", list.near_avoided},
                     {"off_region", list.off_area}};
    if (!has_place_rules(options)) return;
    summary.draws.emplace_back("off_rules", list.off_rules);
    summary.draws.emplace_back("not_preferred", list.not_preferred);
}

/// The part of run_spawn() that differs between the commands.
template <class Options>
struct SpawnQuery {
    /// Completes the options when the map and the robot are known. Returns the settings that only this command has.
    std::function<Settings(const Session&, Options&)> prepare;
    SpawnList (*run)(const Judge&, const Options&);
    /// Does the work before the first draw. Returns why no pose can be valid, or an empty text.
    std::function<std::string(const Session&, Options&)> before_draws = [](const auto&, auto&) { return ""; };
    /// Prints notices about the result.
    std::function<void(const Session&, const SpawnList&)> after_draws = [](const auto&, const auto&) {};
};

/// Returns the result without any draw: nothing is proven about the region.
SpawnList nothing_drawn()
{
    SpawnList out;
    out.undecided_area = std::numeric_limits<double>::quiet_NaN();
    return out;
}

/// Prints a notice if many samples were judged where the scene seems to have the same ground twice.
void notice_about_double_ground(const CommonArgs& args, const SpawnList& list)
{
    constexpr double noticeable = 0.1;  // share of the judged poses
    const std::uint64_t all = list.counts.total();
    if (list.on_double_ground == 0 || double(list.on_double_ground) < noticeable * double(all)) return;
    notice(args, std::to_string(list.on_double_ground) + " of " + counted(all, "judged pose") +
                     " are on a layer with another layer at most " + number(double_ground) +
                     " m above it (ground twice in one place); there a robot collides" +
                     (list.stance == Stance::Settled ? "" : ", or is less than --offset above the ground") +
                     "; --layers top uses only the highest layer of each place, which takes less time");
}

/// Runs `search` or `sample` with its options.
template <class Options>
Ending run_spawn(const SpawnQuery<Options>& query, Summary& summary, const SpawnArgs& args, const CLI::App& app,
                 Options options)
{
    const std::string command = app.get_name();
    const YawChoice yaw = parse_yaw_choice(args, args.yaw, args.is_settled(), true);
    options.random_yaw = yaw.is_random;
    options.yaw = yaw.yaw;
    options.heading = yaw.rule;
    options.avoid = read_avoided(args, args.avoid, options.min_distance);
    const auto folder = args.is_thesis() ? thesis_folder(args.out) : nullptr;
    if (folder) notice_idle_options(args, app, args.format);
    std::optional<SimulatorOutput> output;
    if (!folder)
        output.emplace(args, app, args.simulator,
                       SimulatorOutput::Target{args.format, args.out, args.robot, options.count, robot_options(args)});
    const Session session = open_session(args, summary);
    if (output) {
        output->notice_about_model(session.robot);
        output->notice_about_world(session.map);
    }
    const Settings own = query.prepare(session, options);
    notice_about_avoided(args, session.map, options.avoid);
    summary.lap("load");
    const std::string hopeless = query.before_draws(session, options);
    options.progress = progress_bar(args, command, false);
    options.stop = stop_request(args);
    SpawnList list = hopeless.empty() ? query.run(*session.judge, options) : nothing_drawn();
    summary.is_interrupted = end_interruptible_work(args, !list.spawns.empty());
    if (command == "sample") summary.fullness = {list.is_full, list.undecided_area};
    summary.lap("query");
    notice_about_double_ground(args, list);
    if (!summary.is_interrupted) query.after_draws(session, list);
    if (folder)
        write_thesis(args, *folder, settings_of(args, session, options, list, command, own), list.counts, summary,
                     [&](const auto& into) { return write_thesis_locations(into, list); });
    else
        write(args, *output, session, options, list);
    fill(summary, options, list);
    Ending ending;
    if (summary.is_interrupted)
        ending = interrupted_ending(list.spawns.size(), "spawn", options.count);
    else if (list.spawns.size() < options.count)
        ending = {.status = fewer_found,
                  .notice = hopeless.empty() ? shortfall(options, args, list, command) : hopeless};
    keep(args, FoundSpawns{std::move(list)});
    return ending;
}

Ending run_search(const SpawnArgs& args, const CLI::App& command, Summary& summary)
{
    SearchOptions options = search_options(args, args.draws, args.bounds, "search", !args.ground.z.empty());
    options.stance = args.stance();
    options.area = read_area(args, args.area);
    const ZRange heights = heights_of(args.ground, options.bounds, "--bounds");
    const auto prepare = [&](const Session& session, SearchOptions& asked) {
        asked.bounds = with_heights(asked.bounds, heights, session.map);
        if (args.is_settled()) choose_offset(args, std::nullopt, session.robot, summary);
        notice_if_off_map(args, session.map, "--bounds", asked.bounds);
        notice_about_area(args, session.map, asked.area);
        notices_about_stance(args, command, session.robot);
        notice_about_heading(args, session.map, asked.heading);
        return Settings{{"Max failures", std::to_string(asked.max_failures)},
                        {"Max height (m)", number(session.judge->options().max_height)}};
    };
    return run_spawn<SearchOptions>({prepare, search}, summary, args, command, options);
}

/// Returns the options of `sample` without the yaw.
SampleOptions sample_options(const SpawnArgs& args, const CLI::App& command)
{
    SampleOptions options{.count = std::size_t(args.draws.count),
                          .min_distance = args.draws.min_distance,
                          .seed = args.draws.seed,
                          .layers = parse_layers(args.ground.layers),
                          .area = read_area(args, args.area),
                          .threads = args.threads,
                          .progress = progress_bar(args, "sample")};
    options.place = place_rules(args.places, command);
    options.measures = place_measures(args.places, command);
    set_stance(options, args, args.ground, command);
    if (const auto box = lone_box(args.area)) {  // as bounds, so that every draw is within the region
        options.bounds = *box;
        options.area.within.clear();
    }
    return options;
}

/// Completes the options of `sample` when the map and the robot are known, and prints the notices about them.
/// `heights`: heights_of() the ground.
void complete(SampleOptions& asked, const ZRange& heights, const SpawnArgs& args, const CLI::App& command,
              const Session& session, Summary& summary)
{
    asked.z = with_floor(heights, args.ground, session.map);
    asked.offset = choose_offset(args, asked.offset, session.robot, summary);
    notice_if_off_map(args, session.map, "--region", asked.bounds);
    notice_about_area(args, session.map, asked.area);
    notice_if_no_layer(args, session.map, asked.layers);
    check_places(args, asked.place, session.map);
    notices_about_stance(args, command, session.robot);
    notice_about_heading(args, session.map, asked.heading);
}

Ending run_pairs(const SpawnArgs& args, const CLI::App& command, Summary& summary)
{
    PairOptions options = pair_options(args.pairs, command, args.is_settled(), args.format);
    const IslandChoice asked_islands = island_choice(args, args.islands, command);
    options.spawns = sample_options(args, command);
    options.spawns.count = std::size_t(args.pairs.count);
    const ZRange heights = heights_of(args.ground, options.spawns.bounds, "--region");
    const YawChoice yaw = parse_yaw_choice(args, args.yaw, args.is_settled(), true);
    options.spawns.random_yaw = yaw.is_random;
    options.spawns.yaw = yaw.yaw;
    options.spawns.heading = yaw.rule;
    options.spawns.avoid = read_avoided(args, args.avoid, 0);
    const Session session = open_session(args, summary);
    complete(options.spawns, heights, args, command, session, summary);
    notice_about_avoided(args, session.map, options.spawns.avoid);
    summary.lap("load");
    const IslandChoice islands = choice_for(session.map, args, args.islands, command, asked_islands, true);
    const ReachGraph graph = find_islands(args, args.islands, session, summary, "sample", true);
    if (!islands.selects_all()) {
        options.spawns.is_reachable = on_islands(graph, chosen_islands(graph, *session.judge, islands));
        options.spawns.reachable_name = words_of(islands);
    }
    options.spawns.progress = progress_bar(args, "sample", false);
    options.spawns.stop = stop_request(args);
    PairList list = sample_pairs(*session.judge, graph, options);
    summary.is_interrupted = end_interruptible_work(args, !list.pairs.empty());
    summary.lap("query");
    write_pairs(args, args.pairs, args.format, args.out, session, list, options);
    summary.seed = options.spawns.seed;
    summary.extra.push_back(std::to_string(list.pairs.size()) + " of " + std::to_string(options.spawns.count) +
                            " pairs, " + counted(list.searches, "path") + " searched");
    Ending ending;
    if (summary.is_interrupted)
        ending = interrupted_ending(list.pairs.size(), "pair", options.spawns.count);
    else if (list.pairs.size() < options.spawns.count)
        ending = {.status = fewer_found, .notice = shortfall_of_pairs(list, options.spawns.count)};
    keep(args, FoundPairs{std::move(list), session.judge->options().stand.lift});
    return ending;
}

Ending run_sample(const SpawnArgs& args, const CLI::App& command, Summary& summary)
{
    if (asks_for_fleet(command))
        return run_fleet({args.fleet, args, args.draws, args.simulator, args.area, args.avoid, args.ground,
                          args.islands, args.yaw, args.format, args.out},
                         command, summary);
    if (args.robot.empty()) throw ArgumentError("--robot is required, or --fleet");
    if (command.count("--pairs") > 0) return run_pairs(args, command, summary);
    if (command.count("--count") == 0) throw ArgumentError("--count is required, or --pairs, --fill or --fleet");
    refuse_pair_options(command, args.format);
    check_draws(args.draws);
    IslandChoice islands = island_choice(args, args.islands, command);
    SampleOptions options = sample_options(args, command);
    const ZRange heights = heights_of(args.ground, options.bounds, "--region");
    const auto prepare = [&](const Session& session, SampleOptions& asked) {
        complete(asked, heights, args, command, session, summary);
        islands = choice_for(session.map, args, args.islands, command, islands,
                             asks_for(asked.measures, PlaceQuantity::Room));
        Settings own{{"Layers", args.ground.layers}};
        if (asked.offset) own.insert(own.begin(), {"Offset (m)", number(*asked.offset)});
        if (!asked.z.is_unlimited()) own.emplace_back("Heights of layers (m)", z_text(asked.z));
        if (const std::string rules = to_string(asked.place); !rules.empty()) own.emplace_back("Place", rules);
        if (!asked.measures.prefer.empty()) own.emplace_back("Prefer", words_of(asked.measures));
        if (!islands.selects_all()) own.emplace_back("Islands", words_of(islands));
        return own;
    };
    const auto before_draws = [&](const Session& session, SampleOptions& asked) {
        if (asked.offset) return flat_ground_complaint(session.robot, *asked.offset);
        const ChosenIslands chosen = choose_islands(args, args.islands, islands, session, summary, "sample",
                                                    asks_for(asked.measures, PlaceQuantity::Room));
        set_room(asked.measures, chosen);
        asked.is_reachable = chosen.filter;
        asked.reachable_name = words_of(islands);
        return chosen.why_none;
    };
    const auto after_draws = [&](const Session& session, const SpawnList& list) {
        if (args.is_settled() && args.islands.island.empty() && islands.selects_all())
            notice_about_islands(args, args.islands, session, list);
    };
    return run_spawn<SampleOptions>({prepare, sample, before_draws, after_draws}, summary, args, command, options);
}

/// Adds the most common options.
/// `more_formats`: values of --format besides those of poses.
void add_common_spawn_options(CLI::App& command, SpawnArgs& args, const std::vector<std::string>& more_formats = {})
{
    add_map_and_robot(command, args);
    add_draws(command, args.draws);
    command.add_option("--yaw", args.yaw,
                       "Yaw of all spawns: " + yaw_help + ", or random; for " + heading_help + " (default 0)");
    command.add_option("--out,-o", args.out, "File, or folder, to write (default: standard output)");
    std::vector<std::string> formats = pose_formats;
    formats.push_back("thesis");
    formats.insert(formats.end(), more_formats.begin(), more_formats.end());
    command
        .add_option(
            "--format", args.format,
            "csv, json, thesis (a folder of Valid_Locations.txt and similar files), or a file for a simulator: " +
                CLI::detail::join(std::vector(pose_formats.begin() + 2, pose_formats.end()), ", ") +
                (more_formats.empty() ? "" : "; with --pairs: csv, json, " + CLI::detail::join(more_formats, ", ")) +
                " (default csv)")
        ->check(one_of(formats).description(""));
}

/// Adds the groups that both commands have.
void add_spawn_groups(CLI::App& command, SpawnArgs& args)
{
    add_area(command, args.area);
    add_avoid(command, args.avoid);
    add_simulator_options(command, args.simulator);
    add_robot_and_run(command, args);
    add_allow_empty(command, args);
}

}  // namespace

void add_search(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<SpawnArgs>();
    CLI::App& command = *app.add_subcommand(
        "search", "N spawns by random search in a box, at a distance from all positions checked before");
    add_common_spawn_options(command, *args);
    command.get_option("--count")->required();
    add_max_failures(command, args->draws);
    add_verdict_options(command, *args);
    add_stance(command, *args, Stance::Level);
    start_group(command, help_group::region);
    command.add_option("--bounds", args->bounds,
                       "Box of the draws: x0,y0,z0,x1,y1,z1 in m, or with --z x0,y0,x1,y1 (default: the map's)");
    command.add_option("--z", args->ground.z,
                       "LOW:HIGH in m: heights of the draws, and of the ground of settled robots, in place of those of "
                       "--bounds (5: or :8 for one limit)");
    add_spawn_groups(command, *args);
    command.footer(
        "Example:\n  spawnfield search /tmp/training --robot box:0.99,0.67,0.39 -n 20 --min-distance 1.5 "
        "--max-failures 10000");
    set_work(command, args, chosen, run_search);
}

void add_sample(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<SpawnArgs>();
    CLI::App& command = *app.add_subcommand("sample", "N valid spawns, uniform by area");
    add_common_spawn_options(command, *args, pair_formats);
    add_ground(command, args->ground, "all, top, bottom, or N from the top (0 first; default all)");
    add_verdict_options(command, *args);
    add_stance(command, *args, Stance::Settled);
    add_islands(command, args->islands);
    add_pairs(command, args->pairs);
    add_fleet(command, args->fleet);
    command.get_option("--robot")->required(false);  // not for --fleet
    add_place_rules(command, args->places);
    add_quantity_settings(command, args->places);
    add_measures(command, args->places);
    add_spawn_groups(command, *args);
    command.footer(
        "Example:\n  spawnfield sample /tmp/training --robot box:0.99,0.67,0.39 -n 50 --min-distance 1 --yaw random\n"
        "  spawnfield sample /tmp/training --robot box:0.99,0.67,0.39 -n 50 --island largest --reach-step 0.4\n"
        "  spawnfield sample /tmp/training --robot box:0.99,0.67,0.39 --pairs 20 --min-path 5 --reach-step 0.4\n"
        "  spawnfield sample /tmp/training --robot box:0.99,0.67,0.39 -n 50 --near 'cube*' 0.5:1 --facing 'cube*'\n"
        "  spawnfield sample /tmp/training --robot box:0.99,0.67,0.39 --fill --min-distance 3\n"
        "  spawnfield sample /tmp/training --fleet maps/training/fleet.yaml -o /tmp/fleet.csv");
    set_work(command, args, chosen, run_sample);
}

}  // namespace spawnfield::cli

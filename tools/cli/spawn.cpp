#include "cli.h"

#include <spawnfield/error.h>

#include <charconv>
#include <cstdio>

namespace spawnfield::cli {
namespace {

struct SpawnArgs : QueryArgs {
    long long count = 0, max_failures = 100000;
    std::uint64_t seed = 0;
    double min_distance = 0, offset = 0.1;
    std::string bounds, region, layers = "all", yaw = "0", format = "csv", out;
};

void fill_spawn(SpawnOptions& options, const SpawnArgs& args, const std::string& label)
{
    fill(options, args, label);
    if (args.count < 1) throw bad_value("-n", double(args.count), ">= 1");
    if (args.count > static_cast<long long>(max_spawns)) throw bad_value("-n", double(args.count), "at most " + std::to_string(max_spawns));
    options.count = std::size_t(args.count);
    options.min_distance = parse_finite("--min-distance", args.min_distance, "m");
    if (options.min_distance < 0) throw bad_value("--min-distance", options.min_distance, ">= 0 m");
    options.seed = args.seed;
    options.random_yaw = !parse_yaw(args.yaw, options.yaw);
    if (!args.bounds.empty()) options.bounds = parse_bounds("--bounds", args.bounds, false);
    if (!args.region.empty()) options.bounds = parse_bounds("--region", args.region, true);
}

std::string shortfall(const SpawnOptions& options, const SpawnList& list, const std::string& command)
{
    const std::string found = std::to_string(list.spawns.size()), of_count = found + " of " + std::to_string(options.count) + " spawns ";
    const std::string advice = "a smaller --min-distance, " + std::string(command == "sample" ? "another --offset or a wider --region" : "more --max-failures or wider --bounds");
    if (list.is_full && list.spawns.empty()) return "no spawn fits: it is proven that no pose is valid; " + advice + " may give some";
    if (list.is_full) return "only " + of_count + "fit: it is proven that none can be added to these " + found + "; " + advice + " may give more";
    if (command == "search") return "only " + of_count + "were found; " + advice + " may give more";
    char area[32];
    std::snprintf(area, sizeof area, "%.3g", list.undecided_area);
    return "only " + of_count + "were found; one more may fit within " + area + " m2 that are neither proven full nor blocked, and nowhere else; " + advice + " may give more";
}

int finish(Summary& summary, const SpawnArgs& args, const Session& session, const SpawnOptions& options, const SpawnList& list,
           const std::string& command)
{
    summary.lap("query");
    write_output(args.out, [&](const auto& sink) {
        sink(args.format == "json" ? spawns_json(list, session.map, session.robot, options, command) : spawns_csv(list));
    });
    summary.lap("write");
    summary.set_counts(list.counts);
    summary.exact_checks = list.exact_checks;
    summary.map_hash = session.map.hash;
    summary.seed = args.seed;
    summary.extra = {std::to_string(list.spawns.size()) + " of " + std::to_string(options.count) + " spawns",
                     counted(list.draws, "draw") + ", " + std::to_string(list.too_close) + " too close"};
    summary.finish();
    if (list.spawns.size() == options.count) return done;
    notice(args, shortfall(options, list, command));
    return fewer_found;
}

int run_search(const SpawnArgs& args)
{
    Summary summary("search", args);
    SearchOptions options;
    fill_spawn(options, args, "search");
    if (args.max_failures < 1) throw bad_value("--max-failures", double(args.max_failures), ">= 1");
    options.max_failures = std::uint64_t(args.max_failures);
    options.exact_time = &summary.exact_time;
    const auto session = open_session(args);
    tell_if_off_map(args, session->map, "--bounds", options.bounds);
    summary.lap("load");
    const SpawnList list = search(session->map, *session->checker, options);
    return finish(summary, args, *session, options, list, "search");
}

int run_sample(const SpawnArgs& args, const CLI::App& command)
{
    Summary summary("sample", args);
    SampleOptions options;
    fill_spawn(options, args, "sample");
    options.offset = parse_finite("--offset", args.offset, "m");
    options.layers = parse_layers(args.layers);
    options.exact_time = &summary.exact_time;
    tell_idle(args, command, {"--max-height"}, "samples stand on their layers");
    const auto session = open_session(args);
    tell_if_off_map(args, session->map, "--region", options.bounds);
    tell_if_no_layer(args, session->map, options.layers);
    tell_if_in_ground(args, session->robot, options.offset);
    summary.lap("load");
    const SpawnList list = sample(session->map, *session->checker, options);
    summary.fullness = {list.is_full, list.undecided_area};
    return finish(summary, args, *session, options, list, "sample");
}

/// CLI11's own words for -1 are a range of 309 digits.
std::string seed_complaint(const std::string& text)
{
    std::uint64_t seed = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error == std::errc{} && stop == text.data() + text.size()) return "";
    return text + " is no whole number from 0 to " + std::to_string(std::numeric_limits<std::uint64_t>::max());
}

void add_spawn_options(CLI::App& command, SpawnArgs& args)
{
    add_query(command, args);
    command.add_option("-n,--count", args.count, "Spawns wanted")->required();
    command.add_option("--min-distance", args.min_distance, "Between positions, m (default 0)");
    command.add_option("--yaw", args.yaw, "rad, or random (default 0)");
    command.add_option("--seed", args.seed, "The same seed gives the same spawns (default 0)")->check(seed_complaint);
    command.add_option("--format", args.format, "csv or json (default csv)")->check(CLI::IsMember({"csv", "json"}));
    command.add_option("--out,-o", args.out, "File to write (default: standard output)");
}

}  // namespace

void add_search(CLI::App& app, Run& run)
{
    auto args = std::make_shared<SpawnArgs>();
    CLI::App& command = *app.add_subcommand("search", "N spawns by random search in a box, away from all positions checked before");
    add_spawn_options(command, *args);
    command.add_option("--max-failures", args->max_failures, "Draws in a row that gave nothing, after which it stops (default 100000)");
    command.add_option("--bounds", args->bounds, "Box of the draws: x0,y0,z0,x1,y1,z1 in m (default: the map's)");
    command.footer("Example:\n  spawnfield search /tmp/training --robot box:0.99,0.67,0.39 -n 20 --min-distance 1.5 --max-failures 10000");
    command.callback([=, &run] { run = [=] { return run_search(*args); }; });
}

void add_sample(CLI::App& app, Run& run)
{
    auto args = std::make_shared<SpawnArgs>();
    CLI::App& command = *app.add_subcommand("sample", "N valid spawns, uniform by area");
    add_spawn_options(command, *args);
    command.add_option("--offset", args->offset, "Of the robot's origin above its layer, m (default 0.1)");
    command.add_option("--region", args->region, "x0,y0,x1,y1 in m (default: the map's bounds)");
    command.add_option("--layers,--layer", args->layers, "all, top, bottom, or N from the top (0 first)");
    command.footer("Example:\n  spawnfield sample /tmp/training --robot box:0.99,0.67,0.39 -n 50 --min-distance 1 --yaw random");
    command.callback([=, &command, &run] { run = [=, &command] { return run_sample(*args, command); }; });
}

}  // namespace spawnfield::cli

#include "angle.h"
#include "area_args.h"
#include "check_pairs.h"
#include "command.h"
#include "ground_args.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "place_args.h"
#include "raster_args.h"
#include "reach_args.h"
#include "results.h"
#include "review_live.h"
#include "session.h"
#include "spelling.h"
#include "streams.h"

#include <spawnfield/error.h>
#include <spawnfield/review.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield::cli {
namespace {

constexpr int most_headings = 16;

struct ReviewArgs : QueryArgs {
    AreaArgs area;
    GroundArgs ground;
    ReachArgs reach;
    PlaceArgs places;
    std::vector<std::string> spawns, pairs;
    std::string command_line, out, bounds, yaw = "0", quantities = "clearance";
    double step = 0;
    int headings = 1;
    std::optional<bool> islands;  ///< no value: if they are found quickly
    bool serve = false;
    int port = 0;
    std::size_t most_triangles = 1000000;
};

RasterOptions raster_options(const ReviewArgs& args, const CLI::App& command)
{
    const YawChoice yaw = parse_yaw_choice(args, args.yaw, false, false);
    RasterOptions options{.yaw = yaw.yaw,
                          .layers = parse_layers(args.ground.layers),
                          .threads = args.threads,
                          .progress = progress_bar(args, "raster")};
    set_stance(options, args, args.ground, command);
    if (!args.bounds.empty()) options.bounds = parse_bounds("--bounds", args.bounds, true);
    options.z = heights_of(args.ground, options.bounds, "--bounds");
    options.area = read_area(args, args.area);
    return options;
}

/// Returns the quantities of --quantity. Throws ArgumentError for names that it does not know.
std::vector<PlaceQuantity> measured_quantities(const ReviewArgs& args, const PlaceMeasures& measures)
{
    std::vector<PlaceQuantity> out = measures.columns;
    // The page has these of all settled poses.
    std::erase(out, PlaceQuantity::Tilt);
    std::erase(out, PlaceQuantity::Margin);
    if (std::ranges::count(out, PlaceQuantity::Room) > 0)
        throw ArgumentError("--quantity " + args.quantities +
                            " has room, which a page does not show; `heatmap --quantity room` does");
    return out;
}

/// Reads the files of poses and pairs.
void read_lists(const ReviewArgs& args, ReviewContents& contents)
{
    for (const std::string& file : args.spawns) contents.spawns.push_back({input_name(file), open_poses(args, file)});
    for (const std::string& file : args.pairs) {
        ReviewPairs pairs{input_name(file), open_pairs(args, file)};
        pairs.options.spawns.threads = args.threads;
        contents.pairs.push_back(std::move(pairs));
    }
}

/// Adds a raster for each heading.
void add_rasters(const ReviewArgs& args, const Session& session, RasterOptions options, ReviewContents& contents)
{
    const double first = options.yaw;
    for (int k = 0; k < args.headings; ++k) {
        const double turn = 2 * std::numbers::pi * k / args.headings;
        options.yaw = args.headings == 1 ? first : std::remainder(first + turn, 2 * std::numbers::pi);
        contents.rasters.push_back(raster(*session.judge, options));
    }
}

/// Throws ArgumentError for options that do not go together.
void check_options(const ReviewArgs& args, const CLI::App& command)
{
    const bool makes_file = !args.serve && !args.host->wants_update;
    if (makes_file && args.out.empty()) throw ArgumentError("--out is required, or --serve");
    if (args.serve) refuse(command, {"--out"}, "and --serve do not go together: the page is in the browser then");
    if (!args.serve) refuse(command, {"--port"}, "is only for --serve");
    if (args.is_settled()) return;
    refuse(command, {"--pairs", "--islands"}, "is only for settled robots; leave --stance level out");
    refuse(command, reach_option_names, "is only for settled robots; leave --stance level out");
}

bool wants_islands(const ReviewArgs& args, const Session& session)
{
    if (!args.is_settled()) return false;
    if (!args.pairs.empty()) return true;
    if (args.islands) return *args.islands;
    const bool are_quick = are_islands_quick(args, args.reach, session);
    if (!are_quick)
        notice(args,
               "the page shows no islands, because finding them may take minutes; --islands finds and keeps them, and "
               "--no-islands silences this notice");
    return are_quick;
}

/// Returns all that the page shows. An update has either rasters or poses.
ReviewContents contents_of(const ReviewArgs& args, const CLI::App& command, const Session& session,
                           RasterOptions options, Summary& summary)
{
    const bool is_update = args.host->wants_update;
    ReviewContents contents{.command = args.command_line,
                            .stance = args.stance(),
                            .is_update = is_update,
                            .most_triangles = args.most_triangles};
    contents.measures = place_measures(args.places, command, "--quantity", args.quantities);
    if (!is_update || command.count("--quantity") > 0)  // measuring takes longer than all else
        contents.quantities = measured_quantities(args, contents.measures);
    read_lists(args, contents);
    summary.lap("load");
    if (!is_update) {
        contents.floors = floors_of(session.map);
        if (wants_islands(args, session))
            contents.graph = find_islands(args, args.reach, session, summary, "review", !contents.pairs.empty());
    }
    if (is_update && !args.spawns.empty()) return contents;
    options.step = command.count("--raster") > 0 ? parse_positive("--raster", args.step)
                                                 : default_step(session.map, options, 500);
    require_raster_memory(args, session.map, options, "--raster", args.headings);
    add_rasters(args, session, options, contents);
    summary.lap("query");
    return contents;
}

void summarize(const ReviewContents& contents, Summary& summary)
{
    VerdictCounts counts;
    std::uint64_t exact_checks = 0;
    for (const RasterResult& result : contents.rasters) {
        counts += result.counts;
        exact_checks += result.exact_checks;
    }
    summary.set_verdicts(counts, exact_checks);
}

/// Serves the page until Ctrl-C.
void serve(const ReviewArgs& args, const CLI::App& command, const Session& session, ReviewContents& contents)
{
    const RunOptions options{.threads = args.threads};
    const auto page = [&](const std::string& live) {
        contents.live = live;
        std::string out;
        write_review(
            *session.judge, contents, [&](std::string_view piece) { out += piece; }, options);
        return out;
    };
    serve_review({args, command, std::make_shared<const Map>(session.map), std::make_shared<const Robot>(session.robot),
                  page, args.port});
}

Ending run_review(const ReviewArgs& args, const CLI::App& command, Summary& summary)
{
    require_review_page();
    check_options(args, command);
    RasterOptions options = raster_options(args, command);
    const Session session = open_session(args, summary);
    notice_if_off_map(args, session.map, "--bounds", options.bounds);
    notice_about_area(args, session.map, options.area);
    notice_if_no_layer(args, session.map, options.layers);
    options.z = with_floor(options.z, args.ground, session.map);
    notices_about_stance(args, command, session.robot);
    options.offset = choose_offset(args, options.offset, session.robot, summary);
    require_above_ground(session.robot, options.offset);
    ReviewContents contents = contents_of(args, command, session, options, summary);
    const RunOptions run{.threads = args.threads, .progress = progress_bar(args, "review")};
    if (args.host->wants_update) {
        keep(args, FoundUpdate{review_pack(*session.judge, contents, run)});
    } else if (args.serve) {
        serve(args, command, session, contents);
    } else {
        write_output(args, args.out, [&](const auto& sink) { write_review(*session.judge, contents, sink, run); });
    }
    summary.lap("write");
    summarize(contents, summary);
    if (!args.out.empty()) summary.extra.insert(summary.extra.begin(), args.out);
    return {};
}

}  // namespace

void add_review(CLI::App& app, const std::string& command_line, ChosenCommand& chosen)
{
    auto args = std::make_shared<ReviewArgs>();
    args->command_line = command_line;
    CLI::App& command = *app.add_subcommand("review",
                                            "A page that shows the world, the verdicts and their reasons in 3D");
    add_map_and_robot(command, *args);
    command.add_option("--out,-o", args->out, "HTML file to write; a browser opens it (- for standard output)")
        ->check(not_empty());
    command.add_flag("--serve", args->serve,
                     "Serve the page on this machine, in place of a file: limits and regions can be changed there");
    command.add_option("--port", args->port, "Port of --serve (default: any free one)")->check(CLI::Range(1, 65535));
    command.add_option("--spawns", args->spawns,
                       "CSV file of poses to show; may be given several times (- for standard input)");
    command.add_option(
        "--pairs", args->pairs,
        "CSV file of pairs of a start and a goal to show with their paths, from `sample --pairs`; may be "
        "given several times (- for standard input)");
    command.add_option(
        "--raster", args->step,
        "Distance between the columns of the verdicts, m (default: 500 columns along the longer side, but not "
        "less than the cells of the map)");
    command.add_option("--yaw", args->yaw, "Yaw of the verdicts: " + yaw_help + " (default 0)");
    command
        .add_option("--headings", args->headings,
                    "Number of yaws of the verdicts, evenly around; the page has a slider for them (default 1)")
        ->check(CLI::Range(1, most_headings));
    command.add_option(
        "--quantity", args->quantities,
        "What is measured of each valid pose: clearance, head_room, roughness, view, with commas between "
        "them; or an empty text. Settled poses also have tilt and margin (default clearance)");
    command.add_flag("--islands,!--no-islands", args->islands,
                     "Show where the robot can drive, also if finding that out takes long; or never");
    command
        .add_option("--triangles", args->most_triangles,
                    "A world with more triangles is simplified; verdicts stay exact (default 1000000)")
        ->check(CLI::Range(std::size_t(1000), std::size_t(100000000)));
    add_ground(command, args->ground, "all, top, bottom, or N from the top (0 first; default all)");
    add_verdict_options(command, *args);
    add_stance(command, *args, Stance::Settled);
    start_group(command, help_group::reach);
    add_reach(command, args->reach);
    add_quantity_settings(command, args->places);
    add_area(command, args->area);
    command.add_option("--bounds", args->bounds,
                       "x0,y0,x1,y1 in m, or x0,y0,z0,x1,y1,z1: layers beyond z0 .. z1 are not ground (default: the "
                       "map's)");
    add_robot_and_run(command, *args);
    add_allow_empty(command, *args);
    command.footer(
        "Example:\n  spawnfield review /tmp/training --robot box:0.99,0.67,0.39 -o /tmp/review.html\n"
        "  spawnfield review /tmp/training --robot box:0.99,0.67,0.39 --serve");
    set_work(command, args, chosen, run_review);
}

}  // namespace spawnfield::cli

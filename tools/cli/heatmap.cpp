#include "angle.h"
#include "area_args.h"
#include "check_pairs.h"
#include "command.h"
#include "ground_args.h"
#include "heatmap_marks.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "picture_args.h"
#include "place_args.h"
#include "raster_args.h"
#include "reach_args.h"
#include "session.h"
#include "spelling.h"
#include "streams.h"

#include <spawnfield/error.h>
#include <spawnfield/headings.h>
#include <spawnfield/heatmap.h>
#include <spawnfield/raster_islands.h>
#include <spawnfield/raster_quantities.h>
#include <spawnfield/review.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace spawnfield::cli {
namespace {

namespace fs = std::filesystem;

struct HeatmapArgs : QueryArgs {
    AreaArgs area;
    GroundArgs ground;
    IslandArgs islands;
    PlaceArgs places;
    HeatmapMarkArgs marks;
    std::string command_line, out, format, quantity = "verdict", bounds, yaw;
    double step = 0;
    int size = 1000;
};

/// The values of --quantity, in the order of HeatmapQuantity.
const std::vector<std::string> quantities{"verdict",   "height", "slope", "clearance", "head_room",
                                          "roughness", "view",   "room",  "tilt",      "roll",
                                          "pitch",     "margin", "belly", "island"};

HeatmapQuantity quantity_of(const std::string& name)
{
    return HeatmapQuantity(std::find(quantities.begin(), quantities.end(), name) - quantities.begin());
}

/// Yaws that the picture is made for: one, or 16 headings all around.
struct Facing {
    bool is_any = false;
    double yaw = 0;                        ///< rad, unless it is any or there is a rule
    std::optional<HeadingRule> rule = {};  ///< of robots at rest
};

bool is_same_yaw(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)) <= 1e-6; }

/// Returns --yaw; nothing if it is not given.
std::optional<Facing> given_facing(const HeatmapArgs& args)
{
    if (args.yaw.empty()) return std::nullopt;
    const YawChoice yaw = parse_yaw_choice(args, args.yaw, args.is_settled(), true);
    return Facing{yaw.is_random, yaw.yaw, yaw.rule};
}

/// Returns the yaw of the spawns.
Facing facing_of(const HeatmapArgs& args, const std::vector<Spawn>& spawns)
{
    Facing facing;
    if (spawns.empty()) return facing;
    facing.yaw = spawns[0].yaw;
    facing.is_any = std::any_of(spawns.begin(), spawns.end(),
                                [&](const Spawn& spawn) { return !is_same_yaw(spawn.yaw, facing.yaw); });
    if (facing.is_any)
        notice(args, "the spawns have different yaws: the ground shows at how many of 16 headings the robot fits" +
                         std::string(args.is_settled() ? ", which takes 16 times as long" : "") +
                         " (--yaw RAD shows one)");
    else if (!is_same_yaw(facing.yaw, 0))
        notice(args, "the ground is shown for yaw " + number(facing.yaw) +
                         " rad, which all spawns have (--yaw RAD shows another)");
    return facing;
}

RasterOptions raster_options(const HeatmapArgs& args, const CLI::App& command)
{
    RasterOptions options{
        .layers = parse_layers(args.ground.layers), .threads = args.threads, .progress = progress_bar(args, "heatmap")};
    set_stance(options, args, args.ground, command);
    if (!args.bounds.empty()) options.bounds = parse_bounds("--bounds", args.bounds, true);
    options.z = heights_of(args.ground, options.bounds, "--bounds");
    options.area = read_area(args, args.area);
    return options;
}

/// Returns the raster that the picture shows. With several headings, fills the picture's options about them.
RasterResult shown_raster(const Session& session, const RasterOptions& options, bool any_heading,
                          HeatmapOptions& picture)
{
    if (!any_heading) return raster(*session.judge, options);
    HeadingRaster result = raster_at_headings(*session.judge, options);
    picture.headings = result.headings;
    picture.valid_headings = std::move(result.valid_headings);
    return std::move(result.raster);
}

/// Returns the part of the map that has ground at these heights, with 2 m around it. Returns nothing if that is the
/// whole map, or if it has no ground at these heights.
std::optional<Bounds> ground_bounds(const Map& map, const TerrainMap& terrain, const ZRange& z)
{
    constexpr double around = 2;  // m
    const HeightImage heights = highest_within(terrain, z);
    Bounds ground;
    for (int row = 0; row < terrain.frame.rows; ++row)
        for (int col = 0; col < terrain.frame.cols; ++col)
            if (!std::isnan(heights(row, col))) ground.extend({terrain.frame.x_of(col), terrain.frame.y_of(row), 0});
    if (ground.is_empty()) return std::nullopt;
    Bounds out = map.bounds;
    for (int axis = 0; axis < 2; ++axis) {
        out.min[axis] = std::max(out.min[axis], ground.min[axis] - around);
        out.max[axis] = std::min(out.max[axis], ground.max[axis] + around);
    }
    if (out.min == map.bounds.min && out.max == map.bounds.max) return std::nullopt;
    return out;
}

/// If the heights are limited, shows only the part of the map that has ground there, unless --bounds selects a part.
void crop_to_ground(const HeatmapArgs& args, const Map& map, const TerrainMap& terrain, RasterOptions& options)
{
    if (options.z.is_unlimited() || !options.bounds.is_empty()) return;
    const std::optional<Bounds> ground = ground_bounds(map, terrain, options.z);
    if (!ground) return;
    options.bounds = *ground;
    notice(args, "the picture shows " + to_string(*ground, 2) +
                     ", where there is ground at these heights (--bounds shows another part)");
}

/// Fills the picture's options about islands.
void add_islands_to(HeatmapOptions& picture, const HeatmapArgs& args, const Session& session,
                    const ChosenIslands& chosen, const RasterResult& result, Summary& summary)
{
    const ReachGraph graph = chosen.graph ? *chosen.graph
                                          : find_islands(args, args.islands, session, summary, "heatmap");
    picture.islands = islands_of(graph, *session.judge, result,
                                 {.threads = args.threads, .progress = progress_bar(args, "heatmap")});
    for (const Island& island : graph.islands()) picture.island_areas.push_back(island.area);
    summary.lap("query");
}

bool is_page(const HeatmapArgs& args)
{
    return args.format == "html" || (args.format.empty() && fs::path(args.out).extension() == ".html");
}

/// Throws unless a review page can show what is asked for.
void check_page(const HeatmapArgs& args, const CLI::App& command)
{
    require_review_page();
    const std::vector<std::string> shown{"verdict", "height", "clearance", "head_room", "roughness",
                                         "view",    "tilt",   "margin",    "island"};
    if (std::ranges::count(shown, args.quantity) == 0)
        throw ArgumentError("--quantity " + args.quantity + " is only for pictures, not for a page (--html)");
    refuse(command, {"--size", "--names", "--fleet", "--paths"}, "is only for pictures, not for a page (--html)");
    refuse(command, island_option_names, "is only for pictures; a page shows all islands (--html --quantity island)");
    if (args.quantity != "island" && args.marks.pairs.empty())
        refuse(command, reach_option_names, "is only for --quantity island and for --pairs");
}

/// Writes the review page with the layer.
void write_page(const HeatmapArgs& args, const Session& session, const RasterResult& result,
                const PlaceMeasures& measures, Summary& summary)
{
    ReviewContents contents;
    contents.command = args.command_line;
    contents.colors = args.quantity;
    contents.rasters = {result};
    contents.quantities = measures.columns;
    contents.measures = measures;
    contents.floors = floors_of(session.map);
    contents.stance = args.stance();
    if (!args.marks.spawns.empty())
        contents.spawns = {{input_name(args.marks.spawns), open_poses(args, args.marks.spawns)}};
    if (!args.marks.pairs.empty())
        contents.pairs = {{input_name(args.marks.pairs), open_pairs(args, args.marks.pairs)}};
    if (args.quantity == "island" || !contents.pairs.empty())
        contents.graph = find_islands(args, args.islands, session, summary, "heatmap", !contents.pairs.empty());
    const RunOptions run{.threads = args.threads, .progress = progress_bar(args, "review")};
    write_output(args, args.out, [&](const auto& sink) { write_review(*session.judge, contents, sink, run); });
}

Ending run_heatmap(const HeatmapArgs& args, const CLI::App& command, Summary& summary)
{
    const bool wants_page = is_page(args);
    if (wants_page) check_page(args, command);
    const PictureFile file = wants_page ? PictureFile() : picture_file(args.out, args.format);
    const bool shows_islands = args.quantity == "island", shows_room = args.quantity == "room";
    const IslandChoice asked_islands = island_choice(args, args.islands, command);
    RasterOptions options = raster_options(args, command);
    HeatmapOptions picture{.quantity = quantity_of(args.quantity), .pixels = args.size, .threads = args.threads};
    const std::optional<Facing> asked_facing = given_facing(args);
    const KindRobots kind_robots = wants_page ? KindRobots() : read_marks(args, args.marks, picture);
    if ((is_of_rest(picture.quantity) || shows_room) && !args.is_settled())
        throw ArgumentError("--quantity " + args.quantity +
                            " is about the robot at rest; leave --stance level out, or choose another quantity");
    PlaceMeasures measures = place_measures(args.places, command, "--quantity",
                                            is_measured(picture.quantity) ? args.quantity : "");
    const Session session = open_session(args, summary);
    notice_if_off_map(args, session.map, "--bounds", options.bounds);
    notice_about_area(args, session.map, options.area);
    notice_if_no_layer(args, session.map, options.layers);
    options.z = with_floor(options.z, args.ground, session.map);
    keep_heights(args, session.map, options.z, picture);
    const Facing facing = asked_facing ? *asked_facing : facing_of(args, picture.spawns);
    if ((is_of_rest(picture.quantity) || is_measured(picture.quantity)) && facing.is_any)
        throw ArgumentError("--quantity " + args.quantity +
                            " needs one heading at each place; give --yaw an angle, for example 90deg" +
                            (args.is_settled() ? ", or a rule that chooses one, for example best:16" : ""));
    options.yaw = facing.yaw;
    options.heading = facing.rule;
    notices_about_stance(args, command, session.robot);
    if (picture.quantity == HeatmapQuantity::Clearance)
        notice_if_no_obstacles(args, "--quantity clearance", session.map);
    notice_about_heading(args, session.map, options.heading);
    options.offset = choose_offset(args, options.offset, session.robot, summary);
    require_above_ground(session.robot, options.offset);
    const TerrainMap terrain = read_terrain(session.map);
    crop_to_ground(args, session.map, terrain, options);
    options.step = command.count("--step") > 0 ? parse_positive("--step", args.step)
                                               : default_step(session.map, options, 300);
    require_raster_memory(args, session.map, options);
    summary.lap("load");
    const IslandChoice islands = wants_page ? IslandChoice()
                                            : choice_for(session.map, args, args.islands, command, asked_islands,
                                                         shows_islands || shows_room);
    const ChosenIslands chosen = choose_islands(args, args.islands, islands, session, summary, "heatmap", shows_room);
    set_room(measures, chosen);
    if (!chosen.why_none.empty()) notice(args, chosen.why_none);
    options.is_reachable = chosen.filter;
    const RasterResult result = shown_raster(session, options, facing.is_any, picture);
    summary.set_verdicts(result.counts, result.exact_checks);
    summary.extra.insert(summary.extra.begin(), args.out);
    if (wants_page) {
        write_page(args, session, result, measures, summary);
        return {};
    }
    if (is_measured(picture.quantity))
        picture.values = raster_quantity(*session.judge, result, measures.columns[0], measures,
                                         {.threads = args.threads, .progress = progress_bar(args, "measuring")});
    summary.lap("query");
    if (shows_islands) add_islands_to(picture, args, session, chosen, result, summary);
    picture.title = session.map.name + ", " + session.robot.name;
    const std::string headings = facing.is_any ? std::to_string(picture.headings) + " headings" : "";
    picture.caption = heatmap_caption(options, args.ground, *session.judge, headings);
    if (!islands.selects_all()) picture.caption += ", " + words_of(islands);
    picture.robot = &session.robot;
    picture.format = file.format;
    write_heatmap(session.map, terrain, result, picture, file.path);
    if (facing.is_any) summary.extra.push_back(headings + " at each pose, each with its own exact checks");
    return {};
}

}  // namespace

void add_heatmap(CLI::App& app, const std::string& command_line, ChosenCommand& chosen)
{
    auto args = std::make_shared<HeatmapArgs>();
    args->command_line = command_line;
    CLI::App& command = *app.add_subcommand("heatmap", "Picture of where the robot can stand");
    add_map_and_robot(command, *args);
    command
        .add_option("--out,-o", args->out,
                    "Picture to write: .png, .svg or .pdf; or .html, see --html (- for standard output)")
        ->required()
        ->check(not_empty());
    command
        .add_option("--quantity", args->quantity,
                    "verdict, height, slope, clearance, head_room, roughness or view; for settled robots also room, "
                    "tilt, roll, pitch, margin, belly or island: ground within which the robot can drive (default "
                    "verdict)")
        ->check(one_of(quantities));
    add_heatmap_marks(command, args->marks);
    command.add_option("--yaw", args->yaw,
                       "Yaw of all poses: " + yaw_help +
                           "; or random: at how many of 16 headings the robot fits; for " + heading_help +
                           " (default: that of the spawns, or 0)");
    start_group(command, help_group::picture);
    add_heatmap_names(command, args->marks);
    command.add_option(
        "--step", args->step,
        "Distance between columns, m (default: 300 columns along the longer side, but not less than the cells of "
        "the map)");
    command
        .add_option("--size", args->size,
                    "Longer side of the picture, pixels (default 1000; texts are legible from about 500 on)")
        ->check(CLI::Range(200, 16000));
    command.add_option("--format", args->format, "png, svg, pdf or html (default: the ending of -o, else png)")
        ->check(one_of({"png", "svg", "pdf", "html"}));
    command.add_flag_callback(
        "--html", [args] { args->format = "html"; },
        "Write a page that shows this layer and the world in 3D, as `review` does, in place of a picture");
    add_ground(
        command, args->ground,
        "all (a column is valid if one of its layers is), top, bottom, or N from the top (0 first; default all)");
    add_verdict_options(command, *args);
    add_stance(command, *args, Stance::Settled);
    add_islands(command, args->islands);
    add_quantity_settings(command, args->places);
    add_area(command, args->area);
    command.add_option(
        "--bounds", args->bounds,
        "x0,y0,x1,y1 in m, or x0,y0,z0,x1,y1,z1: layers beyond z0 .. z1 are not ground (default: the map's)");
    add_robot_and_run(command, *args);
    add_allow_empty(command, *args);
    command.footer(
        "Example:\n  spawnfield heatmap /tmp/training --robot box:0.99,0.67,0.39 -o /tmp/training.png\n"
        "  spawnfield heatmap /tmp/training --robot box:0.99,0.67,0.39 --quantity island -o /tmp/islands.png");
    set_work(command, args, chosen, run_heatmap);
}

}  // namespace spawnfield::cli

#include "angle.h"
#include "command.h"
#include "export.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "streams.h"

#include <spawnfield/map_export.h>

namespace spawnfield::cli {
namespace {

std::vector<std::string> with(std::vector<std::string> names, const std::vector<std::string>& more)
{
    names.insert(names.end(), more.begin(), more.end());
    return names;
}

/// `measures`: what is measured of the poses.
RasterOptions raster_options(const ExportJob& job, const std::string& layers, PlaceMeasures* measures = nullptr)
{
    const ExportArgs& args = job.args;
    RasterOptions options{.yaw = parse_yaw(args, args.yaw),
                          .layers = parse_layers(args.ground.layers.empty() ? layers : args.ground.layers),
                          .threads = args.threads,
                          .progress = progress_bar(args, "export")};
    if (!args.bounds.empty()) options.bounds = parse_bounds("--bounds", args.bounds, true);
    options.z = with_floor(heights_of(args.ground, options.bounds, "--bounds"), args.ground, job.session.map);
    set_stance(options, args, args.ground, job.command);
    options.offset = choose_offset(args, options.offset, job.session.robot, job.summary);
    notice_if_no_layer(args, job.session.map, options.layers);
    require_above_ground(job.session.robot, options.offset);
    const bool has_room = measures != nullptr && asks_for(*measures, PlaceQuantity::Room);
    const ChosenIslands chosen = choose_islands(args, args.islands, job.islands, job.session, job.summary, "export",
                                                has_room);
    if (has_room) set_room(*measures, chosen);
    if (!chosen.why_none.empty()) notice(args, chosen.why_none);
    options.is_reachable = chosen.filter;
    return options;
}

/// Returns a comment for the file: the map and the poses that its verdicts are for.
std::vector<std::string> comment_of(const ExportJob& job, const RasterOptions& options, const std::string& layers)
{
    const Session& session = job.session;
    std::string heights = height_words(job.args.ground, options.z, session.map);
    if (!heights.empty()) heights = ", " + heights;
    const std::string robot = session.robot.name,
                      layer = "layer (" + (job.args.ground.layers.empty() ? layers : job.args.ground.layers) + heights +
                              "), yaw " + number(options.yaw) + " rad",
                      lift = number(session.judge->options().stand.lift), islands = words_of(job.islands);
    return {"spawnfield " + version() + ", map " + session.map.name + " (" + session.map.hash + "): " +
            (options.offset
                 ? "where the origin of " + robot + " can be, " + number(*options.offset) + " m above its " + layer
                 : "where " + robot + " can stand, let down onto its " + layer + ", raised by " + lift + " m") +
            (islands.empty() ? "" : ", " + islands)};
}

void check_one_layer(const ExportJob& job, const LayerChoice& layers)
{
    if (layers.kind == LayerChoice::Kind::All)
        throw ArgumentError(
            "--layers is all, needs top, bottom or a number (0 is the highest layer), because a pixel of " +
            job.args.format + " has one value");
}

/// Returns the options for one layer, because a pixel has one value.
RasterOptions image_options(const ExportJob& job, PlaceMeasures* measures = nullptr)
{
    const RasterOptions options = raster_options(job, "top", measures);
    check_one_layer(job, options.layers);
    return options;
}

GridFrame image_frame(const ExportJob& job)
{
    const Map& map = job.session.map;
    return frame_around(map.bounds, job.was_given("--resolution") ? parse_positive("--resolution", job.args.resolution)
                                                                  : map.resolution);
}

/// Returns the quantities of --bands. Throws ArgumentError for those that the file has anyway.
PlaceMeasures band_measures(const ExportJob& job)
{
    PlaceMeasures out = place_measures(job.args.places, job.command, "--bands", job.args.bands);
    if (asks_for(out, PlaceQuantity::Room) && !job.args.is_settled())
        throw ArgumentError("--bands room is only for settled robots; leave --stance level out");
    for (const PlaceQuantity quantity : out.columns) {
        if (quantity == PlaceQuantity::Clearance)
            notice_if_no_obstacles(job.args, "--bands clearance", job.session.map);
        if (quantity == PlaceQuantity::Tilt || quantity == PlaceQuantity::Margin)
            throw ArgumentError(std::string("--bands has \"") + to_string(quantity) +
                                "\", but the file of a settled robot has this band anyway; leave it out");
    }
    return out;
}

VerdictImage ask(const ExportJob& job, const RasterOptions& options, const GridFrame& frame,
                 const PlaceMeasures& measures = {})
{
    notices_about_stance(job.args, job.command, job.session.robot);
    VerdictImage image = verdict_image(*job.session.judge, frame, options, measures);
    job.summary.lap("query");
    job.summary.set_verdicts(image.counts, image.exact_checks);
    return image;
}

void write_nav2(const ExportJob& job)
{
    nav2_image_of(job.args.out);  // refuses a wrong name before all work
    const RasterOptions options = image_options(job);
    const VerdictImage image = ask(job, options, image_frame(job));
    clear_progress_bar(job.args);
    notices(job.args, write_nav2_map(image, job.args.out, comment_of(job, options, "top")));
}

/// Returns the layer of an image without a robot.
LayerChoice image_layers(const ExportJob& job)
{
    const LayerChoice layers = parse_layers(job.args.ground.layers.empty() ? "top" : job.args.ground.layers);
    check_one_layer(job, layers);
    notice_if_no_layer(job.args, job.session.map, layers);
    return layers;
}

void write_geotiff(const ExportJob& job)
{
    GeoTiffOptions options;
    const GridFrame frame = image_frame(job);
    std::optional<VerdictImage> verdicts;
    if (job.has_robot()) {
        PlaceMeasures measures = band_measures(job);
        const RasterOptions asked = image_options(job, &measures);
        verdicts = ask(job, asked, frame, measures);
        options.layers = asked.layers;
        options.z = asked.z;
    } else {
        options.layers = image_layers(job);
        options.z = with_floor(heights_of(job.args.ground, {}, ""), job.args.ground, job.session.map);
    }
    options.survey = !job.args.local;
    options.threads = job.args.threads;
    options.progress = progress_bar(job.args, "writing");
    spawnfield::write_geotiff(job.session.map, frame, verdicts ? &*verdicts : nullptr, options, job.args.out);
    clear_progress_bar(job.args);
}

void write_ply(const ExportJob& job)
{
    RasterOptions options = raster_options(job, "all");
    options.step = parse_positive("--step", job.args.step);
    notice_if_off_map(job.args, job.session.map, "--bounds", options.bounds);
    notices_about_stance(job.args, job.command, job.session.robot);
    const RasterResult result = raster(*job.session.judge, options);
    job.summary.lap("query");
    job.summary.set_verdicts(result.counts, result.exact_checks);
    write_output(job.args, job.args.out,
                 [&](const auto& sink) { spawnfield::write_ply(result, comment_of(job, options, "all"), sink); });
}

/// Marks where the robot rests, and its verdict there. Without room, the robot stays where the file has it.
void mark_settled(const ExportJob& job, const PoseTable& table, GlbMarkers& markers)
{
    const std::vector<SettledPose> settled = settled_poses(job, table);
    for (std::size_t i = 0; i < settled.size(); ++i) {
        markers.verdicts.push_back(settled[i].verdict);
        if (settled[i].has_pose) markers.poses[i] = settled[i].lifted(0);
    }
}

void write_glb(const ExportJob& job)
{
    GlbMarkers markers;
    if (job.has_robot()) markers.robot = &job.session.robot;
    if (job.args.poses.empty()) {
        notice_no_effect(job.args, job.command, {"--robot"}, "without --poses there is no place to draw it");
    } else {
        const PoseTable table = open_poses(job.args, job.args.poses);
        markers.poses = table.poses;
        if (lets_down_poses(job))
            mark_settled(job, table, markers);
        else
            markers.verdicts = verdicts_of(table, input_name(job.args.poses));
        markers.names = column_of(table, "name");
    }
    const Progress progress = progress_bar(job.args, "export");
    write_output(job.args, job.args.out, [&](const auto& sink) {
        spawnfield::write_glb(job.session.map, markers, sink, job.args.threads, progress);
    });
}

}  // namespace

std::vector<ExportFormat> map_formats()
{
    return {
        {"nav2",
         "map for map_server of ROS and nav2: FILE.yaml with FILE.pgm; free where --robot can stand",
         {"--robot", "--out"},
         with(pose_options(), {"--layers", "--z", "--floor", "--resolution"}),
         write_nav2},
        {"geotiff",
         "bands of elevation, layers, free height, slope, water and obstacle; with --robot also of verdicts",
         {"--out"},
         with(pose_options(), with(quantity_setting_names,
                                   {"--robot", "--layers", "--z", "--floor", "--resolution", "--local", "--bands"})),
         write_geotiff},
        {"ply",
         "a point for each pose of --robot, every --step metres, coloured by verdict",
         {"--robot", "--step"},
         with(pose_options(), {"--layers", "--z", "--floor", "--bounds"}),
         write_ply},
        {"glb",
         "the scene by labels, with a marker at each of --poses: --robot, in the colour of a column verdict",
         {},
         with(stance_options(), {"--robot", "--model-path", "--joints", "--mesh-parts", "--poses", "--max-slope"}),
         write_glb},
    };
}

}  // namespace spawnfield::cli

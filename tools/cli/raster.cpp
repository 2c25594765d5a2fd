#include "command.h"
#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "picture_args.h"
#include "raster_args.h"
#include "results.h"
#include "spelling.h"
#include "streams.h"
#include "thesis_output.h"

#include <spawnfield/error.h>
#include <spawnfield/heatmap.h>
#include <spawnfield/raster_cells.h>

#include <malloc.h>

#include <cmath>

namespace spawnfield::cli {
namespace {

struct RasterCommandArgs : RasterArgs {
    double step = 0, step_z = 0;
    bool write_aerial = false, adaptive = false;
    std::string format = "csv", out, heatmap;

    bool is_thesis() const { return format == "thesis"; }
};

/// For the thesis, poses off the terrain are aerial, too, and a 2D raster may have such poses.
void check_write_aerial(const RasterCommandArgs& args, const CLI::App& command, const RasterOptions& options)
{
    if (args.dims == 2 && !args.is_thesis())
        refuse(command, {"--write-aerial"}, "is only for --dims 3: in 2D each pose stands on a layer");
    if (args.write_aerial && args.dims == 3 && options.layers.kind != LayerChoice::Kind::All)
        throw ArgumentError("--write-aerial needs --layers all: aerial poses do not belong to a layer");
}

void check_adaptive(const RasterCommandArgs& args)
{
    if (!args.adaptive) return;
    if (args.dims != 2)
        throw ArgumentError("--adaptive is only for --dims 2: its cells are squares of columns; give --dims 2");
    if (args.is_thesis())
        throw ArgumentError("--adaptive and --format thesis do not go together: the thesis's files list single poses");
    if (args.out.empty() && !args.heatmap.empty())
        throw ArgumentError("--adaptive needs -o FILE if --heatmap is given: a picture shows all poses, not cells");
}

RasterOptions options_of(const RasterCommandArgs& args, const CLI::App& command)
{
    RasterOptions options = raster_options(args, command);
    if (args.dims == 2)
        notice_no_effect(args, command, {"--step-z"}, "it is only for --dims 3; in 2D each pose stands on a layer");
    options.step = parse_positive("--step", args.step);
    if (command.count("--step-z") > 0) options.step_z = parse_positive("--step-z", args.step_z);
    check_write_aerial(args, command, options);
    check_adaptive(args);
    return options;
}

Settings settings_of(const RasterCommandArgs& args, const Session& session, const RasterOptions& options,
                     const RasterGrid& grid)
{
    Settings out = query_settings("raster", args, session);
    const auto add = [&](const std::string& name, const std::string& value) { out.emplace_back(name, value); };
    const bool is_3d = options.dims == 3;
    add("Dimensions", std::to_string(options.dims));
    add("Step (m)", number(grid.step));
    if (is_3d) add("Step z (m)", number(grid.step_z));
    if (is_3d) add("Snap", options.snap ? "yes" : "no");
    if (options.offset) add("Offset (m)", number(*options.offset));
    add("Yaw (rad)", yaw_text(options.heading, false, options.yaw));
    add("Bounds (m, z up)", bounds_text(options.bounds.is_empty() ? session.map.bounds : options.bounds, options.dims));
    for (const Region& region : options.area.within) add("Region", region.name);
    for (const Region& region : options.area.keep_out) add("Keep out", region.name);
    add("Layers", args.ground.layers);
    if (!is_3d && !options.z.is_unlimited()) add("Heights of layers (m)", z_text(options.z));
    if (is_3d) add("Height check", options.height_check ? "yes" : "no");
    const JudgeOptions& limits = session.judge->options();
    if (is_3d && options.height_check) add("Max height (m)", number(limits.max_height));
    if (options.height_check) add("Max water depth (m)", number(limits.max_water_depth));
    if (options.height_check && std::isfinite(limits.max_slope)) add("Max slope (rad)", number(limits.max_slope));
    return out;
}

/// Writes the poses, or with --adaptive the cells.
void write_table(const RasterCommandArgs& args, const RasterResult& result,
                 const std::function<void(std::string_view)>& sink, Summary& summary)
{
    if (!args.adaptive) {
        write_raster_csv(result, args.write_aerial, sink, args.threads);
        return;
    }
    const std::vector<RasterCell> cells = raster_cells(result);
    write_raster_cells_csv(result, cells, sink, args.threads);
    summary.cells = cells.size();
}

/// Writes the poses of a large raster part by part. Returns the result without poses.
RasterResult write_in_parts(const RasterCommandArgs& args, const Judge& judge, const RasterOptions& options,
                            Summary& summary)
{
    RasterResult result;
    write_output(args, args.out, [&](const auto& sink) {
        result = raster_in_parts(judge, options, [&](const RasterResult& part) {
            summary.lap("query");
            write_raster_csv(part, args.write_aerial, sink, args.threads);
            summary.lap("write");
            malloc_trim(0);  // glibc has kept 300 MB of freed memory while other programs used the processors
        });
    });
    return result;
}

Ending run_raster(const RasterCommandArgs& args, const CLI::App& command, Summary& summary)
{
    RasterOptions options = options_of(args, command);
    const std::optional<PictureFile> picture_to = args.heatmap.empty() ? std::nullopt
                                                                       : std::optional(picture_file(args.heatmap));
    const auto folder = args.is_thesis() ? thesis_folder(args.out) : nullptr;
    const Session session = open_session(args, summary);
    complete(options, args, session, summary);
    notices_about_stance(args, command, session.robot);
    notice_about_heading(args, session.map, options.heading);
    summary.lap("load");
    const bool needs_all = args.is_thesis() || args.adaptive || !args.heatmap.empty() || args.host->wants_values();
    if (!needs_all) {
        const RasterResult result = write_in_parts(args, *session.judge, options, summary);
        summary.set_verdicts(result.counts, result.exact_checks);
        return {};
    }
    require_raster_memory(args, session.map, options);
    RasterResult result = raster(*session.judge, options);
    summary.lap("query");
    const auto draw = [&] {
        if (!picture_to) return;
        const HeatmapOptions picture{.title = session.map.name + ", " + session.robot.name,
                                     .caption = heatmap_caption(options, args.ground, *session.judge),
                                     .robot = &session.robot,
                                     .format = picture_to->format,
                                     .threads = args.threads};
        write_heatmap(session.map, read_terrain(session.map), result, picture, picture_to->path);
    };
    if (folder)
        write_thesis(
            args, *folder, settings_of(args, session, options, result.grid), result.counts, summary,
            [&](const auto& into) {
                return write_thesis_locations(into, result, args.write_aerial, progress_bar(args, "writing"));
            },
            draw);
    else if (args.out.empty() && !args.heatmap.empty())
        draw();
    else
        write_output(
            args, args.out, [&](const auto& sink) { write_table(args, result, sink, summary); }, draw);
    summary.set_verdicts(result.counts, result.exact_checks);
    keep(args, FoundRaster{std::move(result)});
    return {};
}

}  // namespace

void add_raster(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<RasterCommandArgs>();
    CLI::App& command = *app.add_subcommand("raster", "Verdict at every position of a 2D or 3D raster");
    add_map_and_robot(command, *args);
    add_dims(command, *args)->required();
    command.add_option("--step", args->step, "Distance between columns, m")->required();
    command.add_flag("--adaptive", args->adaptive,
                     "2D: write square cells of columns with equal verdicts in place of poses: large ones in the open, "
                     "down to --step near edges");
    command.add_option("--step-z", args->step_z, "3D: distance between heights, m (default: --step)");
    command.add_option("--out,-o", args->out,
                       "CSV file, or folder, to write (default: standard output, or nothing with --heatmap)");
    command
        .add_option("--format", args->format,
                    "csv, or thesis: a folder of Valid_Locations.txt and similar files in Unity's frame (default csv)")
        ->check(one_of({"csv", "thesis"}));
    command.add_option("--heatmap", args->heatmap, "Picture to write: .png, .svg or .pdf (- for standard output)");
    add_raster_query(command, *args);
    command.add_flag("--write-aerial", args->write_aerial,
                     "3D: write aerial poses, too. With --format thesis, in 2D and 3D: also those off the terrain");
    command.footer(
        "Example:\n"
        "  spawnfield raster /tmp/training --robot box:0.99,0.67,0.39 --dims 2 --step 0.5 --offset 0.5 -o "
        "/tmp/box_raster.csv");
    set_work(command, args, chosen, run_raster);
}

}  // namespace spawnfield::cli

#include "angle.h"
#include "command.h"
#include "export.h"
#include "spelling.h"

#include <spawnfield/error.h>

#include <algorithm>

namespace spawnfield::cli {
namespace {

/// Returns all formats in the order of --help. Append further tables here.
const std::vector<ExportFormat>& formats()
{
    static const std::vector<ExportFormat> table = [] {
        std::vector<ExportFormat> all = map_formats(), poses = pose_export_formats();
        all.insert(all.end(), poses.begin(), poses.end());
        return all;
    }();
    return table;
}

std::vector<std::string> format_names()
{
    std::vector<std::string> names;
    for (const ExportFormat& format : formats()) names.push_back(format.name);
    return names;
}

const ExportFormat& format_of(const std::string& name)
{
    return *std::find_if(formats().begin(), formats().end(),
                         [&](const ExportFormat& format) { return format.name == name; });
}

bool contains(const std::vector<std::string>& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool uses(const ExportFormat& format, const std::string& option)
{
    return contains(format.needs, option) || contains(format.takes, option);
}

/// Returns the formats that use an option: "glb, ply".
std::string users_of(const std::string& option)
{
    std::string names;
    for (const ExportFormat& format : formats())
        if (uses(format, option)) names += (names.empty() ? "" : ", ") + std::string(format.name);
    return names;
}

/// Options that every format accepts.
const std::vector<std::string> general{"map",       "--format", "--out",         "--threads", "--quiet",
                                       "--summary", "--help",   "--allow-empty", "--with",    "--without"};

void check_options(const ExportArgs& args, const CLI::App& command)
{
    const ExportFormat& format = format_of(args.format);
    for (const std::string& option : format.needs)
        if (command.count(option) == 0) throw ArgumentError("--format " + args.format + " needs " + option);
    if (contains(format.needs, "--out") && args.out == "-")
        throw ArgumentError("--out is \"-\": --format " + args.format +
                            " cannot go to standard output; give a file name");
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || contains(general, name) || uses(format, name)) continue;
        throw ArgumentError(name + " is not for --format " + args.format + "; it is for " + users_of(name));
    }
    if (args.robot.empty()) {
        refuse(command, pose_options(), "needs --robot");
        refuse(command, quantity_setting_names, "needs --robot");
        refuse(command, {"--bands"}, "needs --robot");
    }
}

/// Returns whether the room to manoeuvre is a band, which needs the drivable graph.
bool asks_for_room(const ExportArgs& args)
{
    const std::vector<std::string> bands = CLI::detail::split(args.bands, ',');
    return contains(bands, to_string(PlaceQuantity::Room));
}

Ending run_export(const ExportArgs& args, const CLI::App& command, Summary& summary)
{
    check_options(args, command);
    const Session session = open_session(args, summary);
    summary.lap("load");
    const ExportFormat& format = format_of(args.format);
    IslandChoice islands;
    if (session.judge && uses(format, "--island"))
        islands = choice_for(session.map, args, args.islands, command, island_choice(args, args.islands, command),
                             asks_for_room(args));
    format.write({args, command, session, summary, islands});
    if (!args.out.empty() && args.out != "-") summary.extra.push_back(args.out);
    return {};
}

std::string help()
{
    std::size_t width = 0;
    for (const std::string& name : format_names()) width = std::max(width, name.size());
    std::string text = "Formats (docs/exports.md and docs/simulators.md describe them):\n";
    for (const ExportFormat& format : formats()) {
        const std::string name = format.name;
        text += "  " + name + std::string(width - name.size() + 2, ' ') + format.about + "\n";
    }
    return text +
           "\nExample:\n  spawnfield export /tmp/training --format nav2 --robot box:0.99,0.67,0.39 -o "
           "/tmp/training_nav2.yaml";
}

}  // namespace

const std::vector<std::string>& pose_options()
{
    static const std::vector<std::string> options = [] {
        std::vector<std::string> all{"--model-path", "--joints",    "--mesh-parts", "--max-height", "--max-water-depth",
                                     "--max-slope",  "--collision", "--exhaustive", "--offset",     "--yaw"};
        for (const auto* const more : {&stance_options(), &island_option_names, &reach_option_names})
            all.insert(all.end(), more->begin(), more->end());
        return all;
    }();
    return options;
}

void add_export(CLI::App& app, ChosenCommand& chosen)
{
    auto args = std::make_shared<ExportArgs>();
    args->ground.layers.clear();  // the default depends on the format
    CLI::App& command = *app.add_subcommand("export", "A map, or poses in it, in a file of another program");
    add_map_and_robot(command, *args);
    command.get_option("--robot")->required(false);
    command.add_option("--format", args->format, "One of the formats below")
        ->required()
        ->check(one_of(format_names()).description(""));
    command.add_option("--out,-o", args->out, "File to write (default: standard output, if the format allows it)");
    command.add_option("--poses,-p", args->poses,
                       "CSV file of poses, for example from sample or check. Without --name, its column name names the "
                       "robots (- for standard input)");
    command.add_option("--resolution", args->resolution, "nav2, geotiff: side of a pixel, m (default: the map's)");
    command.add_option("--step", args->step, "ply: distance between columns, m");
    command.add_flag("--local", args->local, "geotiff: use the map's own frame, not the survey's coordinates");
    command.add_option("--bands", args->bands,
                       "geotiff: bands with these quantities of the places where the robot can stand, with commas "
                       "between them: clearance, head_room, roughness, view, room");
    add_ground(
        command, args->ground,
        "Layers that count: top (the default), bottom, N from the top (0 first), or all (only ply, its default)");
    command.add_option("--yaw", args->yaw, "Yaw of all poses: " + yaw_help + " (default 0)");
    add_verdict_options(command, *args);
    add_stance(command, *args, Stance::Settled);
    add_islands(command, args->islands);
    add_quantity_settings(command, args->places);
    start_group(command, help_group::region);
    command.add_option(
        "--bounds", args->bounds,
        "x0,y0,x1,y1 in m, or x0,y0,z0,x1,y1,z1: layers beyond z0 .. z1 are not ground (default: the map's)");
    add_simulator_options(command, args->simulator);
    add_robot_and_run(command, *args);
    add_allow_empty(command, *args);
    command.footer(help());
    set_work(command, args, chosen, run_export);
}

}  // namespace spawnfield::cli

#include "angle.h"
#include "export.h"

#include <algorithm>

namespace spawnfield::cli {
namespace {

/// All formats, in the order in which --help tells them: further tables are to be appended here.
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

/// "glb, ply": those that an option is for.
std::string users_of(const std::string& option)
{
    std::string names;
    for (const ExportFormat& format : formats())
        if (uses(format, option)) names += (names.empty() ? "" : ", ") + std::string(format.name);
    return names;
}

/// Options that are there for all formats, or help.
const std::vector<std::string> general{"map",     "--format",  "--out",  "--threads",
                                       "--quiet", "--summary", "--help", "--allow-empty"};

void check_options(const ExportArgs& args, const CLI::App& command)
{
    const ExportFormat& format = format_of(args.format);
    for (const std::string& option : format.needs)
        if (command.count(option) == 0) throw ArgumentError("--format " + args.format + " needs " + option);
    if (contains(format.needs, "--out") && args.out == "-")
        throw ArgumentError("--out is \"-\": --format " + args.format + " cannot go to standard output, name a file");
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 || contains(general, name) || uses(format, name)) continue;
        throw ArgumentError(name + " is not for --format " + args.format + "; it is for " + users_of(name));
    }
    if (args.robot.empty()) refuse(command, asking_options(), "needs --robot");
}

int run_export(const ExportArgs& args, const CLI::App& command)
{
    check_options(args, command);
    Summary summary("export", args);
    const Session session = open_session(args, summary);
    summary.lap("load");
    format_of(args.format).write({args, command, session, summary});
    summary.lap("write");
    summary.map_hash = session.map.hash;
    if (!args.out.empty() && args.out != "-") summary.extra.push_back(args.out);
    summary.finish();
    return done;
}

std::string help()
{
    std::size_t width = 0;
    for (const std::string& name : format_names()) width = std::max(width, name.size());
    std::string text = "Formats (docs/exports.md and docs/simulators.md tell of their pixels, frames and colours):\n";
    for (const ExportFormat& format : formats()) {
        const std::string name = format.name;
        text += "  " + name + std::string(width - name.size() + 2, ' ') + format.about + "\n";
    }
    return text +
           "Example:\n  spawnfield export /tmp/training --format nav2 --robot box:0.99,0.67,0.39 -o "
           "/tmp/training_nav2.yaml";
}

}  // namespace

const std::vector<std::string>& asking_options()
{
    static const std::vector<std::string> options{"--model-path",      "--joints",    "--mesh-parts", "--max-height",
                                                  "--max-water-depth", "--max-slope", "--collision",  "--exhaustive",
                                                  "--offset",          "--yaw"};
    return options;
}

void add_export(CLI::App& app, Run& run)
{
    auto args = std::make_shared<ExportArgs>();
    args->ground.layers.clear();  // the default depends on the format
    CLI::App& command = *app.add_subcommand("export", "A map, or poses in it, in a file of another program");
    add_query(command, *args);
    command.get_option("--robot")->required(false);
    command.add_option("--format", args->format, "One of the formats below")->required()->check(one_of(format_names()));
    command.add_option("--out,-o", args->out, "File to write (default: standard output, where the format can)");
    add_ground(command, args->ground,
               "Layers that count: all (ply alone, its default), top (the default of others), bottom, or N from the "
               "top (0 first)");
    command.add_option("--yaw", args->yaw, "Of all poses, " + yaw_help + " (default 0)");
    command.add_option("--resolution", args->resolution, "Side of a pixel, m (default: the map's)");
    command.add_option("--step", args->step, "Between columns, m");
    command.add_option(
        "--bounds", args->bounds,
        "x0,y0,x1,y1 in m, or x0,y0,z0,x1,y1,z1: layers beyond z0 .. z1 are no ground (default: the map's)");
    command.add_flag("--local", args->local, "In the map's own frame, though the survey's coordinates are known");
    command.add_option("--poses,-p", args->poses,
                       "CSV file of poses, as sample and check write them; a column name names the robots where --name "
                       "does not (- for standard input)");
    add_allow_empty(command, *args);
    add_simulator_options(command, args->simulator);
    command.footer(help());
    command.callback([=, &command, &run] { run = [=, &command] { return run_export(*args, command); }; });
}

}  // namespace spawnfield::cli

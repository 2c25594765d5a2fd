#include "command.h"

#include "help_format.h"
#include "messages.h"
#include "numbers.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace spawnfield::cli {

Ending interrupted_ending(std::size_t found, const std::string& noun, std::optional<std::size_t> wanted)
{
    return {.status = interrupted,
            .complaint = "interrupted: " + counted(found, noun) + (wanted ? " of " + std::to_string(*wanted) : "") +
                         (found == 1 ? " was" : " were") + " found and written"};
}

void add_commands(CLI::App& app, const std::string& command_line, ChosenCommand& chosen, const std::string& name)
{
    app.name("spawnfield");
    app.description("spawnfield: where can this robot stand in this world?");
    app.formatter(std::make_shared<HelpFormat>());
    app.get_help_ptr()->description("Print this help and exit");
    app.set_version_flag("--version", version(), "Print the version and exit");
    app.require_subcommand(1);
    app.footer(
        "Example:\n"
        "  spawnfield bake maps/training/scene.yaml -o /tmp/training\n"
        "  spawnfield sample /tmp/training --robot maps/robots/husky.yaml -n 10");
    using Add = std::function<void()>;
    const std::vector<std::pair<std::string, Add>> commands{
        {"bake", [&] { add_bake(app, chosen); }},
        {"info", [&] { add_info(app, chosen); }},
        {"check", [&] { add_check(app, chosen); }},
        {"raster", [&] { add_raster(app, chosen); }},
        {"search", [&] { add_search(app, chosen); }},
        {"sample", [&] { add_sample(app, chosen); }},
        {"heatmap", [&] { add_heatmap(app, command_line, chosen); }},
        {"review", [&] { add_review(app, command_line, chosen); }},
        {"export", [&] { add_export(app, chosen); }},
        {"audit", [&] { add_audit(app, chosen); }},
        {"experiment", [&] { add_experiment(app, command_line, chosen); }},
        {"clean", [&] { add_clean(app, chosen); }},
    };
    const auto is_it = [&](const auto& command) { return command.first == name; };
    const bool is_known = std::any_of(commands.begin(), commands.end(), is_it);
    for (const auto& command : commands)
        if (!is_known || is_it(command)) command.second();
}

/// A summary that cannot be written leaves the result, which is already there.
void finish(Summary& summary)
{
    try {
        summary.finish();
    } catch (const OutputError& error) {
        throw std::runtime_error("--summary " + std::string(error.what()) + "; the result itself is complete");
    }
}

int run_command(const ChosenCommand& chosen)
{
    Summary summary(chosen.name, *chosen.args);
    const Ending ending = chosen.work(summary);
    summary.lap("write");
    finish(summary);
    if (!ending.notice.empty()) notice(*chosen.args, ending.notice);
    if (!ending.complaint.empty()) chosen.host->complain(ending.complaint);
    return ending.status;
}

}  // namespace spawnfield::cli

#include "command.h"

#include "help_format.h"
#include "messages.h"
#include "numbers.h"

namespace spawnfield::cli {

Ending interrupted_ending(std::size_t found, const std::string& noun, std::optional<std::size_t> wanted)
{
    return {.status = interrupted,
            .complaint = "interrupted: " + counted(found, noun) + (wanted ? " of " + std::to_string(*wanted) : "") +
                         (found == 1 ? " was" : " were") + " found and written"};
}

void add_commands(CLI::App& app, const std::string& command_line, ChosenCommand& chosen)
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
    add_bake(app, chosen);
    add_info(app, chosen);
    add_check(app, chosen);
    add_raster(app, chosen);
    add_search(app, chosen);
    add_sample(app, chosen);
    add_heatmap(app, chosen);
    add_export(app, chosen);
    add_audit(app, chosen);
    add_experiment(app, command_line, chosen);
}

int run_command(const ChosenCommand& chosen)
{
    Summary summary(chosen.name, *chosen.args);
    const Ending ending = chosen.work(summary);
    summary.lap("write");
    summary.finish();
    if (!ending.notice.empty()) notice(*chosen.args, ending.notice);
    if (!ending.complaint.empty()) chosen.host->complain(ending.complaint);
    return ending.status;
}

}  // namespace spawnfield::cli

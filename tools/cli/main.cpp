#include "cli.h"
#include "interrupt.h"
#include "streams.h"

#include <spawnfield/error.h>

#include <tbb/global_control.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <iostream>

namespace {

using namespace spawnfield;
using namespace spawnfield::cli;

int tell(int status, const std::string& message)
{
    clear_progress_bar();
    std::cerr << "spawnfield: " << message << "\n";
    return status;
}

int guarded(const CLI::App& app, const Run& run)
{
    try {
        for (const CLI::App* const command : app.get_subcommands()) check_streams(*command);
        return run();
    } catch (const Interrupted&) {
        return tell(interrupted, "interrupted; nothing was written");
    } catch (const ArgumentError& error) {
        return tell(wrong_usage, error.message());
    } catch (const NothingFits& nothing) {
        return tell(fewer_found, nothing.why);
    } catch (const FileError& error) {
        return tell(input_refused, error.what());
    } catch (const std::bad_alloc&) {
        return tell(failure, "out of memory; a coarser --resolution or --step, or smaller --bounds, needs less");
    } catch (const std::exception& error) {
        return tell(failure, error.what());
    }
}

std::vector<std::string> command_names(CLI::App& app)
{
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

/// What a shell would read as one word.
std::string quoted_if_needed(const std::string& word)
{
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
        return std::isalnum(c) || std::strchr("-_./:,=@+%", c);
    });
    if (plain) return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
}

std::string command_line(int argc, char** argv)
{
    std::string out = "spawnfield";
    for (int i = 1; i < argc; ++i) out += " " + quoted_if_needed(argv[i]);
    return out;
}

/// Whether the first argument is meant to be a command, but is none.
bool has_unknown_command(const std::vector<std::string>& names, int argc, char** argv)
{
    return argc > 1 && argv[1][0] != '-' && std::find(names.begin(), names.end(), argv[1]) == names.end();
}

}  // namespace

int main(int argc, char** argv)
{
    CLI::App app{"spawnfield: where can this robot stand in this world?", "spawnfield"};
    app.set_version_flag("--version", version());
    app.require_subcommand(1);
    app.footer(
        "Example:\n"
        "  spawnfield bake maps/training/scene.yaml -o /tmp/training\n"
        "  spawnfield sample /tmp/training --robot maps/robots/husky.yaml -n 10");
    Run run;
    add_bake(app, run);
    add_info(app, run);
    add_check(app, run);
    add_raster(app, run);
    add_search(app, run);
    add_sample(app, run);
    add_heatmap(app, run);
    add_export(app, run);
    add_experiment(app, command_line(argc, argv), run);
    const std::vector<std::string> names = command_names(app);
    if (has_unknown_command(names, argc, argv))
        return tell(wrong_usage, std::string(argv[1]) + " is no command, needs one of " +
                                     CLI::detail::join(names, ", ") + suggestion(argv[1], names));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (const std::string words = error.get_exit_code() == 0 ? "" : unknown_option(app); !words.empty())
            return tell(wrong_usage, words + "\nRun with --help for more information.");
        return app.exit(error) == 0 ? done : wrong_usage;
    }
    catch_interrupts();
    // The process is the program's alone: --threads may ask for more threads than there are cores.
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, most_threads);
    return guarded(app, run);
}

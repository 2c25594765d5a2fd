#include "about/about.h"
#include "command.h"
#include "overwriting.h"
#include "shell_words.h"
#include "spelling.h"
#include "streams.h"
#include "terminal.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/memory.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>

namespace {

using namespace spawnfield;
using namespace spawnfield::cli;

std::string out_of_memory(const CommonArgs& args)
{
    return "needs more memory than the limit of " + memory_text(memory_limit(args)) +
           " (--max-memory); a coarser --resolution or --step, smaller --bounds or fewer --threads need less";
}

/// Some libraries turn std::bad_alloc into a text of their own, for example OpenCV. oneTBB says that it cannot create a
/// thread if there is no memory for its stack.
bool is_about_memory(const std::string& text)
{
    constexpr std::array words = {"bad_alloc", "Failed to allocate", "pthread_create has failed"};
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return text.find(word) != std::string::npos; });
}

int run_guarded(const CLI::App& app, const ChosenCommand& chosen)
{
    const auto failed = [&](int status, const std::string& message) {
        chosen.host->complain(message);
        return status;
    };
    try {
        for (const CLI::App* const command : app.get_subcommands()) {
            check_streams(*command);
            check_overwriting(*command);
        }
        limit_memory(memory_limit(*chosen.args));
        return run_command(chosen);
    } catch (const Interrupted&) {
        return failed(interrupted, "interrupted; nothing was written");
    } catch (const ArgumentError& error) {
        return failed(wrong_usage, error.message());
    } catch (const NothingFits& nothing) {
        return failed(fewer_found, nothing.why);
    } catch (const FileError& error) {
        return failed(input_refused, error.what());
    } catch (const std::bad_alloc&) {
        return failed(failure, out_of_memory(*chosen.args));
    } catch (const std::filesystem::filesystem_error& error) {
        return failed(input_refused, unreachable_file(error).what());
    } catch (const std::exception& error) {
        return failed(failure, is_about_memory(error.what()) ? out_of_memory(*chosen.args) : error.what());
    }
}

/// Returns the status of a run that only wrote to standard output.
int flushed(Terminal& terminal)
{
    try {
        terminal.flush();
        return done;
    } catch (const OutputError& error) {
        terminal.complain(error.what());
        return failure;
    }
}

std::vector<std::string> command_names(CLI::App& app)
{
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

std::string command_line(int argc, char** argv)
{
    std::vector<std::string> words{"spawnfield"};
    words.insert(words.end(), argv + 1, argv + argc);
    return shell_line(words);
}

/// Returns whether the first argument is where a command should be, but is not the name of a command.
bool has_unknown_command(const std::vector<std::string>& names, int argc, char** argv)
{
    return argc > 1 && argv[1][0] != '-' && std::find(names.begin(), names.end(), argv[1]) == names.end();
}

}  // namespace

int main(int argc, char** argv)
{
    if (const std::optional<int> status = serve_reader(argc, argv)) return *status;
    Terminal terminal;
    terminal.reader = ReaderProcess{"/proc/self/exe", [&] {
                                        if (terminal.is_interrupted()) throw Interrupted{};
                                    }};
    ChosenCommand chosen{.host = &terminal};
    CLI::App app;
    // Adding all commands takes 1.5 ms, a fifth of the time of a short command.
    add_commands(app, command_line(argc, argv), chosen, argc > 1 ? argv[1] : "");
    add_about(app, chosen);
    const std::vector<std::string> names = command_names(app);
    if (has_unknown_command(names, argc, argv)) {
        terminal.complain(std::string(argv[1]) + " is not a command; the commands are " +
                          CLI::detail::join(names, ", ") + suggestion(argv[1], names));
        return wrong_usage;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const std::string words = error.get_exit_code() == 0 ? "" : unknown_option(app);
        if (words.empty()) {
            if (app.exit(error) != 0) return wrong_usage;
            return flushed(terminal);  // --help, --version
        }
        terminal.complain(words + "\nRun with --help for more information.");
        return wrong_usage;
    }
    return run_guarded(app, chosen);
}

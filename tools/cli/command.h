#pragma once

#include "host.h"
#include "summary.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <string>

namespace spawnfield::cli {

enum ExitStatus {
    done = 0,
    failure = 1,
    wrong_usage = 2,
    fewer_found = 3,
    not_valid = 3,    ///< check --require-valid
    rule_broken = 3,  ///< audit --rules
    input_refused = 4,
    interrupted = 130
};

/// No pose can be valid, for the reason `why`: the command ends with fewer_found, without a summary.
struct NothingFits {
    std::string why;
};

/// How a command ends after its summary.
struct Ending {
    int status = done;
    std::string notice = {};     ///< printed unless --quiet was given; may be empty
    std::string complaint = {};  ///< printed always; may be empty
};

/// Returns how a command ends that was interrupted, and has written what it had found: "5 spawns of 100". `wanted`: no
/// value if there was no number.
Ending interrupted_ending(std::size_t found, const std::string& noun, std::optional<std::size_t> wanted);

/// The command that the user chose, with its options.
struct ChosenCommand {
    Host* host = nullptr;  ///< what surrounds the command
    std::string name = {};
    std::shared_ptr<const CommonArgs> args = {};
    std::function<Ending(Summary&)> work = {};  ///< writes all results, and fills the summary
};

/// Makes `work` the work of the chosen command if the user chooses this one.
template <class Args>
void set_work(CLI::App& command, const std::shared_ptr<Args>& args, ChosenCommand& chosen,
              Ending (*work)(const Args&, const CLI::App&, Summary&))
{
    command.callback([=, &command, &chosen] {
        args->host = chosen.host;
        chosen = {chosen.host, command.get_name(), args,
                  [=, &command](Summary& summary) { return work(*args, command, summary); }};
    });
}

/// Does the work, then what all commands have in common: prints the summary and the ending. Returns the exit status.
int run_command(const ChosenCommand& chosen);

/// Each adds its command to the app, and sets `chosen` if the user chooses it.
void add_bake(CLI::App& app, ChosenCommand& chosen);
void add_info(CLI::App& app, ChosenCommand& chosen);
void add_check(CLI::App& app, ChosenCommand& chosen);
void add_raster(CLI::App& app, ChosenCommand& chosen);
void add_search(CLI::App& app, ChosenCommand& chosen);
void add_sample(CLI::App& app, ChosenCommand& chosen);
void add_heatmap(CLI::App& app, const std::string& command_line, ChosenCommand& chosen);
void add_export(CLI::App& app, ChosenCommand& chosen);
void add_audit(CLI::App& app, ChosenCommand& chosen);
void add_clean(CLI::App& app, ChosenCommand& chosen);
void add_review(CLI::App& app, const std::string& command_line, ChosenCommand& chosen);
void add_experiment(CLI::App& app, const std::string& command_line, ChosenCommand& chosen);

/// Adds all commands and the text of the program's help. `command_line`: for reports. `chosen` must have its host.
/// `name`: of the only command that is needed, if there is one of this name.
void add_commands(CLI::App& app, const std::string& command_line, ChosenCommand& chosen, const std::string& name = "");

}  // namespace spawnfield::cli

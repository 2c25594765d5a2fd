#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace spawnfield::cli {

class Host;

/// Options that every command has.
struct CommonArgs {
    Host* host = nullptr;  ///< what surrounds the command; set when the command is chosen
    int threads = 0;
    bool quiet = false;
    std::string summary;
    std::string max_memory;            ///< 8GB; empty: 80 % of what is available
    bool trusted = false;              ///< read scenes and robots in this process; set by --trusted
    std::vector<std::string> confine;  ///< folders to which --confine restricts files; empty: see confines_usually
    bool confines_usually = false;     ///< without --confine, files are restricted to usual_folders()
    bool allow_empty = false;          ///< files of poses may contain no pose; set by --allow-empty
};

/// Headings of --help, below a command's most common options.
namespace help_group {
inline const std::string ground = "Poses and ground", rest = "Robot at rest", region = "Region", place = "Place",
                         robot = "Robot", reach = "Reach", changes = "Changed world", repair = "Repair",
                         scene = "Scene", picture = "Picture", simulator = "Files for simulators",
                         run = "Output and run";
}

/// All options that are added after this call appear below this heading of --help.
void start_group(CLI::App& command, const std::string& name);

/// Returns the limit of memory, in bytes. Throws ArgumentError.
double memory_limit(const CommonArgs& args);

/// Adds --threads, --quiet, --summary and --max-memory.
void add_common(CLI::App& command, CommonArgs& args);

/// Adds --trusted and --confine, for commands that read scenes or robots. Uses CommonArgs::confines_usually.
void add_trusted(CLI::App& command, CommonArgs& args);

/// Adds --allow-empty, for commands that read poses.
void add_allow_empty(CLI::App& command, CommonArgs& args);

/// Rejects an empty value, for example from an unset shell variable.
CLI::Validator not_empty();

/// Throws ArgumentError "--option REASON" if one of the options was given.
void refuse(const CLI::App& command, const std::vector<std::string>& options, const std::string& reason);

/// Prints a notice for each of the options that was given although it has no effect.
void notice_no_effect(const CommonArgs& args, const CLI::App& command, const std::vector<std::string>& options,
                      const std::string& reason);

}  // namespace spawnfield::cli

#include "common_args.h"

#include "messages.h"
#include "numbers.h"

#include <spawnfield/error.h>
#include <spawnfield/memory.h>

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <string>

namespace spawnfield::cli {

void start_group(CLI::App& command, const std::string& name) { command.option_defaults()->group(name); }

double memory_limit(const CommonArgs& args)
{
    constexpr double default_share = 0.8, least = 100e6;  // bytes; the program needs less than that for itself
    static const double available = available_memory();   // before this process takes any
    if (args.max_memory.empty()) return default_share * available;
    const double given = parse_size("--max-memory", args.max_memory);
    if (given < least)
        throw ArgumentError("--max-memory is \"" + args.max_memory + "\", needs at least " + memory_text(least) +
                            " for the program itself");
    return given;
}

namespace {

constexpr int most_threads = 1024;  // largest value of --threads

/// Allows more threads than there are cores if so many are asked for: the process belongs to the program alone. Without
/// need, TBB is not started, which takes as long as a tenth of a short command.
void allow_threads(const std::string& wanted)
{
    if (std::stoi(wanted) <= tbb::info::default_concurrency()) return;
    static const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, most_threads);
}

}  // namespace

void add_common(CLI::App& command, CommonArgs& args)
{
    start_group(command, help_group::run);
    command.add_option("--threads", args.threads, "Number of threads; 0: all cores. It never changes the result")
        ->check(CLI::Range(0, most_threads))
        ->each(allow_threads);
    command.add_flag("--quiet,-q", args.quiet, "Print no notices, no progress and no summary line");
    command.add_option("--summary", args.summary, "JSON file to which the summary is written (- for standard output)");
    command
        .add_option("--max-memory", args.max_memory,
                    "Limit of the program's memory: 8GB, 500MB (default: 80 % of what is available here, also in a "
                    "container). What needs more ends with status 1")
        ->check(not_empty());
}

void add_trusted(CLI::App& command, CommonArgs& args)
{
    command.add_flag(
        "--trusted", args.trusted,
        "Read the files of scenes and robots in this process. By default, a process of its own reads them, "
        "with limits of memory and time, because damaged or hostile files can crash the libraries for them");
    command
        .add_option("--confine", args.confine,
                    std::string("Refuse scenes and robots that name files outside of this folder, also by links "
                                "(repeatable)") +
                        (args.confines_usually ? ". Default: its own folder, or the one above if that is called "
                                                 "worlds, urdf or the like; --model-path; GZ_SIM_RESOURCE_PATH, "
                                                 "GAZEBO_MODEL_PATH; downloaded models. All files: --confine /"
                                               : ""))
        ->allow_extra_args(false)
        ->check(CLI::ExistingDirectory);
}

void add_allow_empty(CLI::App& command, CommonArgs& args)
{
    command.add_flag("--allow-empty", args.allow_empty, "Accept a file of poses that has a header but no pose");
}

CLI::Validator not_empty()
{
    return {[](const std::string& text) { return text.empty() ? "is empty; is a variable of the shell not set?" : ""; },
            ""};
}

void refuse(const CLI::App& command, const std::vector<std::string>& options, const std::string& reason)
{
    for (const std::string& option : options)
        if (command.count(option) > 0) throw ArgumentError(option + " " + reason);
}

void notice_no_effect(const CommonArgs& args, const CLI::App& command, const std::vector<std::string>& options,
                      const std::string& reason)
{
    for (const std::string& option : options)
        if (command.count(option) > 0) notice(args, option + " has no effect: " + reason);
}

}  // namespace spawnfield::cli

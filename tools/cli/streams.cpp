#include "streams.h"

#include <spawnfield/error.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <iterator>

namespace spawnfield::cli {
namespace {

/// Options whose value is read from standard input if it is `-`.
constexpr std::array inputs{"--poses", "--spawns", "--pairs", "--paths", "--avoid", "--region", "--keep-out"};

/// An option that cannot be read from standard input, and its meaning.
struct Unable {
    const char* option;
    const char* what;
};

constexpr std::array unable{Unable{"scene", "a scene, which names other files beside it"},
                            Unable{"what", "a map, a scene or a robot, which consist of several files"},
                            Unable{"map", "a map, which is a folder"},
                            Unable{"--robot", "a robot, which names other files beside it"},
                            Unable{"--robot-file", "the robot's file, which the result names"},
                            Unable{"--world", "a world, which names other files beside it"},
                            Unable{"--model-path", "a folder"}};

/// Returns how often an option was given as `-`.
std::size_t standard_uses(const CLI::App& command, const std::string& name)
{
    const CLI::Option* const option = command.get_option_no_throw(name);
    if (option == nullptr) return 0;
    const std::vector<std::string>& values = option->results();
    return std::size_t(std::count_if(values.begin(), values.end(), is_standard));
}

bool was_given(const CLI::App& command, const std::string& name)
{
    const CLI::Option* const option = command.get_option_no_throw(name);
    return option != nullptr && option->count() > 0;
}

/// Returns whether the result goes to standard output by default.
bool prints_by_default(const CLI::App& command)
{
    if (command.get_name() == "info" || command.get_name() == "clean") return true;
    const bool is_picture_alone = command.get_name() == "raster" && was_given(command, "--heatmap");
    return command.get_option_no_throw("--out") != nullptr && !was_given(command, "--out") && !is_picture_alone;
}

void check_folder(const CLI::App& command)
{
    const std::string name = command.get_name();
    if ((name == "bake" || name == "experiment") && standard_uses(command, "--out") > 0)
        throw ArgumentError("--out is \"-\": the result of " + name +
                            " is a folder, which cannot go to standard output");
}

}  // namespace

std::string read_standard_input()
{
    std::string text(std::istreambuf_iterator<char>(std::cin), {});
    if (std::cin.bad()) throw FileError("standard input", "cannot be read");
    return text;
}

void check_streams(const CLI::App& command)
{
    for (const auto& [option, what] : unable)
        if (standard_uses(command, option) > 0)
            throw ArgumentError("\"-\" (standard input) cannot be " + std::string(what) + "; give its path");
    check_folder(command);
    std::vector<std::string> in, out;
    for (const char* const option : inputs) in.insert(in.end(), standard_uses(command, option), option);
    if (in.size() > 1)
        throw ArgumentError(in[0] + " and " + in[1] +
                            " are both \"-\", but standard input can be read only once; give one of them a file");
    if (prints_by_default(command)) out.push_back("the result");
    for (const char* const option : output_options) out.insert(out.end(), standard_uses(command, option), option);
    if (out.size() > 1)
        throw ArgumentError(out[0] + " and " + out[1] + " would both go to standard output; give one of them a file");
}

}  // namespace spawnfield::cli

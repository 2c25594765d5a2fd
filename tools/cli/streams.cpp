#include "streams.h"

#include "messages.h"

#include <spawnfield/error.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

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

std::size_t read_standard_input(const CommonArgs& args, char* to, std::size_t size)
{
    for (;;) {
        stop_if_interrupted(args);
        const ssize_t count = ::read(STDIN_FILENO, to, size);
        if (count >= 0) return std::size_t(count);
        if (errno != EINTR) throw FileError("standard input", std::string("cannot be read: ") + std::strerror(errno));
    }
}

std::string read_standard_input(const CommonArgs& args)
{
    constexpr std::size_t piece = 1 << 20;
    std::string text;
    for (std::size_t count = 1; count > 0;) {
        const std::size_t before = text.size();
        text.resize(before + piece);
        count = read_standard_input(args, text.data() + before, piece);
        text.resize(before + count);
    }
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

#include "this_build.h"
#include "program.h"

#include <catch2/catch.hpp>

#include <poll.h>
#include <pty.h>
#include <sys/wait.h>

#include <chrono>

namespace {

/// A shell command for the program, with no input and its standard output in the folder's `.out`.
std::string command_for(const TempFolder& folder, const std::string& before, const std::string& arguments)
{
    return "exec </dev/null >'" + (folder / ".out").string() + "'; cd '" + folder.path().string() + "' && " + before +
           " '" + program_file() + "' " + arguments;
}

int exit_status(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

std::string taken(const std::filesystem::path& file)
{
    std::string bytes = bytes_of(file);
    std::filesystem::remove(file);
    return bytes;
}

/// Returns the run, and prints it if the next check fails: without it, nobody would know what, for example, a sanitizer
/// found.
ProgramRun reported(const std::string& arguments, ProgramRun run)
{
    UNSCOPED_INFO("spawnfield " << arguments << "\nended with status " << run.status << " and printed:\n" << run.err);
    return run;
}

ProgramRun run(const TempFolder& folder, const std::string& before, const std::string& arguments)
{
    const std::filesystem::path err = folder / ".err";
    const std::string command = "exec 2>'" + err.string() + "'; " + command_for(folder, before, arguments);
    const int status = exit_status(std::system(command.c_str()));
    return reported(arguments, {status, taken(folder / ".out"), taken(err)});
}

}  // namespace

ProgramRun run_program(const TempFolder& folder, const std::string& arguments) { return run(folder, "", arguments); }

ProgramRun limited_program(const TempFolder& folder, const std::string& arguments)
{
    return run(folder, "timeout --signal=KILL 120", arguments);
}

namespace {

/// The signals for interrupted_run().
struct Interrupts {
    int signal = SIGINT;
    std::string bar = " %";                         ///< text of the progress bar at which the signal is sent
    std::function<bool()> is_time_for_second = {};  ///< may be empty
};

ProgramRun interrupted_run(const TempFolder& folder, const std::string& arguments, Interrupts interrupts)
{
    const std::string command = command_for(folder, "exec", arguments);
    termios settings{};  // all off: lines arrive as they were written
    int terminal = -1;
    const pid_t child = forkpty(&terminal, nullptr, &settings, nullptr);
    if (child < 0) throw std::runtime_error("no terminal for tests");
    if (child == 0) {
        execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
        _exit(127);
    }
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::seconds patience(60);  // until the bar, and then until the end
    std::string err;
    bool is_sent = false;
    for (auto deadline = Clock::now() + patience;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        const bool waits_for_second = is_sent && interrupts.is_time_for_second;
        if (waits_for_second && interrupts.is_time_for_second()) {
            kill(child, interrupts.signal);
            interrupts.is_time_for_second = {};
            continue;
        }
        pollfd input{terminal, POLLIN, 0};
        const int ready = left <= 0 ? 0 : poll(&input, 1, waits_for_second ? 1 : int(left));
        if (ready <= 0 && left > 0 && waits_for_second) continue;
        if (ready <= 0) {
            kill(child, SIGKILL);
            break;
        }
        char bytes[4096];
        const ssize_t count = read(terminal, bytes, sizeof bytes);
        if (count <= 0) break;  // the program has ended
        err.append(bytes, std::size_t(count));
        if (is_sent || err.find(interrupts.bar) == std::string::npos) continue;
        kill(child, interrupts.signal);
        is_sent = true;
        deadline = Clock::now() + patience;
    }
    int status = 0;
    waitpid(child, &status, 0);
    close(terminal);
    return reported(arguments, {exit_status(status), taken(folder / ".out"), err});
}

}  // namespace

ProgramRun interrupt_program(const TempFolder& folder, const std::string& arguments, int signal, const std::string& bar)
{
    return interrupted_run(folder, arguments, {.signal = signal, .bar = bar});
}

ProgramRun interrupt_program_twice(const TempFolder& folder, const std::string& arguments,
                                   const std::function<bool()>& is_time)
{
    return interrupted_run(folder, arguments, {.is_time_for_second = is_time});
}

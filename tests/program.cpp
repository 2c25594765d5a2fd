#include "paths.h"
#include "program.h"

#include <sys/wait.h>

namespace {

ProgramRun run(const TempFolder& folder, const std::string& before, const std::string& arguments)
{
    const std::string out = (folder / ".out").string(), err = (folder / ".err").string();
    const std::string command = "exec </dev/null >'" + out + "' 2>'" + err + "'; cd '" + folder.path().string() +
                                "' && " + before + " '" + program_file() + "' " + arguments;
    const int status = std::system(command.c_str());
    const ProgramRun result{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), bytes_of(out),
                            bytes_of(err)};
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return result;
}

}  // namespace

ProgramRun run_program(const TempFolder& folder, const std::string& arguments) { return run(folder, "", arguments); }

ProgramRun interrupt_program(const TempFolder& folder, const std::string& arguments, double seconds,
                             const std::string& signal)
{
    // With --foreground only the program gets the signal. Without it, every process of the group gets the signal, so
    // the program gets it twice, and a second Ctrl-C ends it at once.
    return run(
        folder,
        "timeout --foreground --preserve-status --signal=" + signal + " --kill-after=30 " + std::to_string(seconds),
        arguments);
}

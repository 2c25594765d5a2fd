#include "process.h"

#include "base/stopwatch.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

namespace bench {
namespace {

/// Starts a program whose standard output is `output`; its standard error is discarded. Returns its process. In
/// contrast to fork(), this takes the same time however much memory this process has, because no page tables are
/// copied.
pid_t start(const std::filesystem::path& program, const std::vector<std::string>& args, int output)
{
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const std::string& arg : args) argv.push_back(const_cast<char*>(arg.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    pid_t process = 0;
    const int error = posix_spawn(&process, program.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("cannot start a process for " + program.string());
    return process;
}

std::string read_all(int file)
{
    std::string text;
    char bytes[4096];
    for (ssize_t count; (count = read(file, bytes, sizeof bytes)) > 0;) text.append(bytes, std::size_t(count));
    return text;
}

double seconds_of(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

}  // namespace

ProcessRun run_process(const std::filesystem::path& program, const std::vector<std::string>& args)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot create a pipe to " + program.string());
    ProcessRun out;
    spawnfield::Stopwatch watch;
    const pid_t child = start(program, args, ends[1]);
    close(ends[1]);
    out.output = read_all(ends[0]);
    close(ends[0]);
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    out.seconds = watch.lap();
    out.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    out.peak_memory = std::uint64_t(usage.ru_maxrss) * 1024;
    out.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return out;
}

std::filesystem::path this_program() { return std::filesystem::read_symlink("/proc/self/exe"); }

std::filesystem::path spawnfield_program()
{
    const std::filesystem::path beside = this_program().parent_path() / "spawnfield";
    return std::filesystem::exists(beside) ? beside : std::filesystem::path();
}

}  // namespace bench

#include "apart/memory_file.h"
#include "apart/reader_limits.h"
#include "apart/reader_protocol.h"
#include "apart/scene_fields.h"
#include "base/number.h"
#include "base/text.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/reader_process.h>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <ctime>
#include <system_error>
#include <thread>

namespace spawnfield {

template <>
inline constexpr AnswerKind last_value<AnswerKind> = AnswerKind::Failure;

namespace {

namespace fs = std::filesystem;

/// A running reader process. It is killed if this object is destroyed before wait() has returned.
class Child {
public:
    Child(const fs::path& program, const MemoryFile& request, const MemoryFile& answer)
    {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        // Libraries print what they think of a file. A sanitizer's report must be seen.
        if (!is_sanitized) posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&actions, request.descriptor(), request_descriptor);
        posix_spawn_file_actions_adddup2(&actions, answer.descriptor(), answer_descriptor);
        posix_spawn_file_actions_addclosefrom_np(&actions, answer_descriptor + 1);
        std::string name = program.string(), argument = reader_argument;
        char* const arguments[] = {name.data(), argument.data(), nullptr};
        const int error = posix_spawn(&process_, program.c_str(), &actions, nullptr, arguments, environ);
        posix_spawn_file_actions_destroy(&actions);
        if (error != 0)
            throw std::runtime_error(program.string() + " cannot be started to read files: " + std::strerror(error));
        descriptor_ = int(syscall(SYS_pidfd_open, process_, 0));  // that of glibc 2.36 is not for C++
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child()
    {
        if (process_ > 0) {
            kill(process_, SIGKILL);
            reap();
        }
        if (descriptor_ >= 0) close(descriptor_);
    }

    /// Waits for its end, and returns its wait status. Calls `tick` ten times per second. Kills it if it does nothing
    /// for too long; then `stalled` becomes true.
    int wait(const std::function<void()>& tick, bool& stalled)
    {
        using Clock = std::chrono::steady_clock;
        constexpr std::chrono::seconds patience(15);
        constexpr std::chrono::milliseconds pause(100);
        double used = 0;
        auto seen_at_work = Clock::now();
        while (!has_ended(pause)) {
            if (tick) tick();
            const double now = processor_time();
            if (now > used + 1e-3) seen_at_work = Clock::now();
            used = std::max(used, now);
            stalled = Clock::now() - seen_at_work > patience;
            if (stalled) kill(process_, SIGKILL);
        }
        return reap();
    }

private:
    bool has_ended(std::chrono::milliseconds most) const
    {
        pollfd event{descriptor_, POLLIN, 0};
        if (descriptor_ >= 0) return poll(&event, 1, int(most.count())) > 0;
        std::this_thread::sleep_for(most / 10);  // a kernel or a sandbox without pidfd_open()
        siginfo_t end{};
        return waitid(P_PID, id_t(process_), &end, WEXITED | WNOHANG | WNOWAIT) == 0 && end.si_pid == process_;
    }

    double processor_time() const  // s
    {
        clockid_t clock{};
        timespec time{};
        if (clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
        return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
    }

    int reap()
    {
        int status = 0;
        while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = -1;
        return status;
    }

    pid_t process_ = -1;
    int descriptor_ = -1;
};

const std::string damaged = "; is the file damaged?";
const std::string remedy = damaged + " If you trust it, --trusted reads it without limits";

/// Returns the file that was being read; `file` was asked for.
std::string file_name(const ReaderStatus& last, const std::string& file)
{
    return last.file[0] == 0 ? file : last.file;
}

std::string reader_name(const ReaderStatus& last) { return last.reader[0] == 0 ? "reader" : last.reader; }

/// Throws FileError: what happened to a process that gave no answer. `file` was asked for.
[[noreturn]] void throw_end(int status, bool stalled, const ReaderStatus& last, const std::string& file)
{
    const std::string at = file_name(last, file);
    const std::string reader = reader_name(last);
    if (stalled) throw FileError(at, "the " + reader + " waited for 15 s without doing anything" + remedy);
    if (!WIFSIGNALED(status))
        throw FileError(at, "the " + reader + " ended with status " + std::to_string(WEXITSTATUS(status)) + damaged);
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU)
        throw FileError(at, "the " + reader + " needs more than " + number(last.seconds) +
                                " s of processor time, the limit for files of this size" + remedy);
    throw FileError(
        at, "the " + reader + " crashed (signal " + std::to_string(signal) + ", " + strsignal(signal) + ")" + damaged);
}

/// Throws the exception that the text stands for.
[[noreturn]] void rethrow_file_error(const std::string& text)
{
    const std::size_t colon = text.find(": ");
    if (colon == std::string::npos) throw FileError(text, "cannot be read");
    throw FileError(text.substr(0, colon), text.substr(colon + 2));
}

[[noreturn]] void rethrow(AnswerKind kind, ArchiveReader& answer, const ReaderStatus& last, const std::string& file)
{
    if (kind == AnswerKind::OutOfMemory)
        throw FileError(file_name(last, file), "the " + reader_name(last) + " needs more than " +
                                                   number(last.gigabytes) + " GB of memory, the " +
                                                   (last.is_given != 0 ? "limit that was given (--max-memory)" + damaged
                                                                       : "limit for files of this size" + remedy));
    std::string text, message;
    answer(text);
    if (kind == AnswerKind::FileError) rethrow_file_error(text);
    if (kind != AnswerKind::ArgumentError) throw std::runtime_error(text);
    answer(message);
    if (text.empty()) throw ArgumentError(message);
    throw ArgumentError(text, message);
}

/// Asks a reader process for a Scene or a Robot.
template <class Result, class Options>
Result asked(RequestKind kind, std::string name, Options options, const ReaderProcess& process)
{
    MemoryFile request("spawnfield-request"), answer("spawnfield-answer");
    ArchiveWriter out;
    std::vector<fs::path> confine = process.confine;
    std::string own_version = version();
    double max_memory = process.max_memory;
    out(own_version, kind, name, confine, max_memory, options);
    request.write(0, out.take());
    answer.write(0, std::string(sizeof(ReaderStatus), '\0'));
    bool stalled = false;
    const int end = Child(process.program, request, answer).wait(process.wait, stalled);

    const SharedMemory shared(answer, answer.size());
    ReaderStatus last;
    std::memcpy(&last, shared.data(), sizeof last);
    last.reader[sizeof last.reader - 1] = last.file[sizeof last.file - 1] = 0;
    if (end != 0 || last.answer_bytes == 0) throw_end(end, stalled, last, name);
    try {
        ArchiveReader in(shared.view().substr(sizeof last, last.answer_bytes));
        AnswerKind answered{};
        in(answered);
        if (answered != AnswerKind::Result) rethrow(answered, in, last, name);
        Result result;
        std::vector<fs::path> files;
        in(result, files);
        const std::string fault = fault_of(result);
        if (!fault.empty()) throw FileError(name, "the reader gave a wrong result (" + fault + ")" + damaged);
        if (process.report) process.report(files);
        return result;
    } catch (const std::out_of_range&) {
        throw FileError(name, "the reader gave an answer that is cut short" + damaged);
    }
}

/// Returns whether a foreign library may read a file for this robot: its own file as SDF, or a mesh that it names.
bool may_need_foreign_reader(const std::string& robot)
{
    if (robot.starts_with("box:")) return false;
    const fs::path file(robot);
    const std::string extension = lower_case(file.extension().string());
    const bool is_text = extension == ".urdf" || extension == ".yaml" || extension == ".yml";
    if (!is_text || !is_file(file)) return true;
    return read_file(file).find("mesh") != std::string::npos;
}

}  // namespace

Scene load_scene_apart(const fs::path& file, const SceneOptions& options, const ReaderProcess& process)
{
    return asked<Scene>(RequestKind::Scene, file.string(), options, process);
}

Robot load_robot_apart(const std::string& robot, const RobotOptions& options, const ReaderProcess& process)
{
    if (process.confine.empty() && !may_need_foreign_reader(robot)) return load_robot(robot, options);
    return asked<Robot>(RequestKind::Robot, robot, options, process);
}

}  // namespace spawnfield

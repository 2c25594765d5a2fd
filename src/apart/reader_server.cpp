#include "apart/memory_file.h"
#include "apart/reader_limits.h"
#include "apart/reader_protocol.h"
#include "apart/scene_fields.h"
#include "model/built_in_models.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/reader_process.h>

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <iostream>
#include <new>

namespace spawnfield {

template <>
inline constexpr RequestKind last_value<RequestKind> = RequestKind::Robot;

namespace {

namespace fs = std::filesystem;

/// Returns the answer to a request, without its AnswerKind.
std::string answer_to(std::string_view request, ReaderLimits& limits)
{
    ArchiveReader in(request);
    ArchiveWriter out;
    std::string asked_by, name;
    RequestKind kind{};
    std::vector<fs::path> confine;
    in(asked_by);
    if (asked_by != version())
        throw std::runtime_error("the program that reads files has version " + version() + ", the library " + asked_by +
                                 "; install both from the same build");
    double max_memory = 0;
    in(kind, name, confine, max_memory);
    limits.limit_memory_to(max_memory);
    if (!confine.empty()) {
        confine.push_back(built_in_folder());
        limits.confine(confine);
    }
    if (kind == RequestKind::Scene) {
        SceneOptions options;
        in(options);
        Scene scene = load_scene(name, options);
        out(scene);
    } else {
        RobotOptions options;
        in(options);
        Robot robot = load_robot(name, options);
        out(robot);
    }
    std::vector<fs::path> files(limits.files().begin(), limits.files().end());
    std::error_code unreachable;
    const fs::path own = fs::weakly_canonical(built_in_folder(), unreachable);
    std::erase_if(files, [&](const fs::path& file) { return is_in_folder(file, own); });
    out(files);
    return out.take();
}

std::string answer(AnswerKind kind, const std::string& rest)
{
    BinaryWriter out;
    out.put(std::uint8_t(kind));
    return out.take() + rest;
}

std::string texts(std::initializer_list<std::string> texts)
{
    BinaryWriter out;
    for (const std::string& text : texts) out.put_text(text);
    return out.take();
}

/// Some libraries turn std::bad_alloc into a text of their own.
bool is_about_memory(const std::string& text) { return text.find("bad_alloc") != std::string::npos; }

/// Returns the whole answer, also if reading fails.
std::string served(std::string_view request, const ReaderStatus& status, ReaderLimits& limits)
{
    try {
        return answer(AnswerKind::Result, answer_to(request, limits));
    } catch (const FileError& error) {
        if (is_about_memory(error.what())) return answer(AnswerKind::OutOfMemory, "");
        return answer(AnswerKind::FileError, texts({error.what()}));
    } catch (const ArgumentError& error) {
        const std::string all = error.what(), message = error.message();
        const std::string prefix = all.substr(0, all.size() - message.size());  // "FUNCTION: ", or nothing
        return answer(AnswerKind::ArgumentError,
                      texts({prefix.substr(0, prefix.size() - std::min<std::size_t>(2, prefix.size())), message}));
    } catch (const fs::filesystem_error& error) {
        return answer(AnswerKind::FileError, texts({unreachable_file(error).what()}));
    } catch (const std::bad_alloc&) {
        return answer(AnswerKind::OutOfMemory, "");
    } catch (const std::exception& error) {
        if (is_about_memory(error.what())) return answer(AnswerKind::OutOfMemory, "");
        if (status.reader[0] == 0) return answer(AnswerKind::Failure, texts({error.what()}));
        return answer(AnswerKind::FileError, texts({std::string(status.file) + ": the " + status.reader +
                                                    " cannot read it: " + error.what()}));
    }
}

/// Lets the terminal's signals go to the parent alone, which ends this process.
void ignore_terminal()
{
    for (const int signal : {SIGINT, SIGHUP, SIGQUIT, SIGTSTP}) std::signal(signal, SIG_IGN);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
}

}  // namespace

std::optional<int> serve_reader(int argc, char** argv)
{
    if (argc != 2 || std::strcmp(argv[1], reader_argument) != 0) return {};
    ignore_terminal();
    // _exit() runs no destructors: those of a foreign library might crash after a hostile file.
    const MemoryFile request(request_descriptor);
    MemoryFile out(answer_descriptor);
    try {
        const SharedMemory asked(request, request.size()), shared(out, sizeof(ReaderStatus));
        auto& status = *reinterpret_cast<ReaderStatus*>(shared.data());
        ReaderLimits limits(status);
        set_input_watch(limits);
        const std::string bytes = served(asked.view(), status, limits);
        out.write(sizeof(ReaderStatus), bytes);
        status.answer_bytes = bytes.size();
        _exit(0);
    } catch (const std::exception& error) {
        std::cerr << "this is for a program that reads files in a process of its own: " << error.what() << "\n";
        return 2;
    }
}

}  // namespace spawnfield

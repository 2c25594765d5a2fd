#include "interpreter.h"

#include "command.h"
#include "overwriting.h"
#include "results.h"
#include "spelling.h"
#include "streams.h"

#include <spawnfield/error.h>

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include <chrono>
#include <exception>
#include <thread>

namespace spawnfield::python {
namespace {

/// How often the calling thread looks for Ctrl-C while a command runs.
constexpr std::chrono::milliseconds patience{50};

/// Returns the words as the program would get them, for reports.
std::string line_of(const std::vector<std::string>& words)
{
    std::string out = "spawnfield";
    for (const std::string& word : words) out += " " + word;
    return out;
}

/// Reads the arguments of a command. Throws ArgumentError.
void parse(CLI::App& app, const std::vector<std::string>& words)
{
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes them in reverse
    } catch (const CLI::ParseError& error) {
        const std::string unknown = cli::unknown_option(app);
        throw ArgumentError(unknown.empty() ? error.what() : unknown);
    }
    for (const CLI::App* const command : app.get_subcommands()) {
        cli::check_streams(*command);
        cli::check_overwriting(*command);
    }
}

/// Returns the result of a command as an object of Python; None if there is none.
nb::object object_of(const std::any& result)
{
    if (const auto* const spawns = std::any_cast<std::shared_ptr<const cli::FoundSpawns>>(&result))
        return nb::cast(std::const_pointer_cast<cli::FoundSpawns>(*spawns));
    if (const auto* const pairs = std::any_cast<std::shared_ptr<const cli::FoundPairs>>(&result))
        return nb::cast(std::const_pointer_cast<cli::FoundPairs>(*pairs));
    if (const auto* const fleet = std::any_cast<std::shared_ptr<const cli::FoundFleet>>(&result))
        return nb::cast(std::const_pointer_cast<cli::FoundFleet>(*fleet));
    if (const auto* const raster = std::any_cast<std::shared_ptr<const cli::FoundRaster>>(&result))
        return nb::cast(std::const_pointer_cast<cli::FoundRaster>(*raster));
    if (const auto* const verdicts = std::any_cast<std::shared_ptr<const cli::FoundVerdicts>>(&result))
        return nb::cast(std::const_pointer_cast<cli::FoundVerdicts>(*verdicts));
    return nb::none();
}

/// Throws a command's exception in a form that the module translates.
[[noreturn]] void raise(const std::exception_ptr& failure)
{
    try {
        std::rethrow_exception(failure);
    } catch (const ArgumentError& error) {
        throw ArgumentError(error.message());
    } catch (const cli::NothingFits& nothing) {
        throw NothingFits(nothing.why);
    }
}

}  // namespace

void Interpreter::notice(const std::string& text)
{
    const std::lock_guard lock(mutex_);
    messages_.push_back({"notice", text});
}

void Interpreter::complain(const std::string& message)
{
    const std::lock_guard lock(mutex_);
    messages_.push_back({"complaint", message});
}

Progress Interpreter::show_progress(const std::string& label)
{
    return [this, label](double share) {
        const std::lock_guard lock(mutex_);
        share_ = Share{label, share};
    };
}

bool Interpreter::pass_on(const nb::callable& on_message, const nb::object& on_progress)
{
    std::vector<Message> messages;
    std::optional<Share> share;
    {
        const std::lock_guard lock(mutex_);
        messages.swap(messages_);
        share.swap(share_);
    }
    for (const Message& message : messages) on_message(message.kind, message.text);
    if (share && !on_progress.is_none()) on_progress(share->label, share->share);
    return PyErr_CheckSignals() == 0;
}

bool Interpreter::attend(const nb::callable& on_message, const nb::object& on_progress)
{
    bool is_calm = true;
    for (bool is_done = false; !is_done;) {
        {
            const nb::gil_scoped_release unlocked;
            std::unique_lock lock(mutex_);
            is_done = changed_.wait_for(lock, patience, [&] { return is_done_; });
        }
        if (!is_calm) continue;  // the exception waits for the command to end
        try {
            is_calm = pass_on(on_message, on_progress);
        } catch (nb::python_error& error) {
            error.restore();
            is_calm = false;
        }
        if (!is_calm) is_interrupted_ = true;
    }
    return !is_calm;
}

nb::dict Interpreter::run(const std::vector<std::string>& words, bool wants_text, const nb::callable& on_message,
                          const nb::object& on_progress)
{
    wants_text_ = wants_text;
    cli::ChosenCommand chosen{.host = this};
    CLI::App app;
    cli::add_commands(app, line_of(words), chosen, words.empty() ? "" : words.front());
    parse(app, words);
    int status = cli::done;
    std::exception_ptr failure;
    // Python may end this thread while it waits. The worker is joined then, too.
    std::jthread worker([&] {
        try {
            status = cli::run_command(chosen);
        } catch (...) {
            failure = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        is_done_ = true;
        changed_.notify_one();
    });
    const bool has_exception = attend(on_message, on_progress);
    worker.join();
    if (has_exception) nb::raise_python_error();
    if (failure) raise(failure);
    nb::dict out;
    out["status"] = status;
    out["summary"] = summary_;
    out["text"] = text_;
    out["result"] = object_of(result);
    return out;
}

}  // namespace spawnfield::python

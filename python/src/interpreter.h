#pragma once

#include "arrays.h"
#include "host.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace spawnfield::python {

/// No pose can be valid: cli::NothingFits, as an exception of Python.
struct NothingFits : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Python, which calls a command. The command runs in a thread of its own, without the interpreter's lock (GIL). The
/// calling thread passes messages on, and looks for Ctrl-C.
class Interpreter : public cli::Host {
public:
    void notice(const std::string& text) override;
    void complain(const std::string& message) override;
    Progress show_progress(const std::string& label) override;
    void hide_progress() override {}
    bool is_interrupted() const override { return is_interrupted_; }
    void forget_interruption() override { is_interrupted_ = false; }
    bool wants_text() const override { return wants_text_; }
    bool wants_values() const override { return true; }
    void write(std::string_view text) override { text_ += text; }
    void flush() override {}
    void summarize(const std::string&, const std::string& json, bool) override { summary_ = json; }

    /// Runs a command with its arguments. `on_message` is called with "notice" or "complaint" and a text, and
    /// `on_progress`, unless it is None, with a label and a share of 0 .. 1. Returns a dictionary with the `status`,
    /// the `summary` (JSON), the `text` if it is wanted, and the `result`, which may be None. Throws ArgumentError,
    /// FileError, OutputError, and KeyboardInterrupt after Ctrl-C.
    nb::dict run(const std::vector<std::string>& words, bool wants_text, const nb::callable& on_message,
                 const nb::object& on_progress);

private:
    struct Message {
        const char* kind;
        std::string text;
    };
    struct Share {
        std::string label;
        double share;
    };
    /// Waits until the command is done, and passes on what it says. Returns whether Python has set an exception.
    bool attend(const nb::callable& on_message, const nb::object& on_progress);
    bool pass_on(const nb::callable& on_message, const nb::object& on_progress);

    std::mutex mutex_;  ///< of the four below
    std::condition_variable changed_;
    std::vector<Message> messages_;
    std::optional<Share> share_;
    bool is_done_ = false;

    std::atomic<bool> is_interrupted_{false};
    bool wants_text_ = false;
    std::string text_, summary_;
};

}  // namespace spawnfield::python

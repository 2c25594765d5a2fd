#pragma once

#include "host.h"

namespace spawnfield::cli {

/// The program: messages go to standard error, results to standard output, and Ctrl-C interrupts. There is only one,
/// because signals belong to the process.
class Terminal : public Host {
public:
    /// From now on Ctrl-C, SIGTERM and a lost terminal (SIGHUP) are noticed. A second signal of the same kind ends the
    /// program at once.
    Terminal();

    void notice(const std::string& text) override;
    void complain(const std::string& message) override;
    /// A bar, if standard error is a terminal.
    Progress show_progress(const std::string& label) override;
    void hide_progress() override;
    bool is_interrupted() const override;
    void forget_interruption() override;
    bool wants_text() const override { return true; }
    bool wants_values() const override { return false; }
    void write(std::string_view text) override;
    void flush() override;
    void summarize(const std::string& line, const std::string& json, bool is_quiet) override;

private:
    void note_output_fault();

    bool is_bar_shown_ = false;
    int output_fault_ = 0;  ///< errno of the first failure to write to standard output; 0: none
};

}  // namespace spawnfield::cli

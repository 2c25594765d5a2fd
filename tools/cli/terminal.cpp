#include "terminal.h"

#include "printable.h"

#include <spawnfield/error.h>

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>

namespace spawnfield::cli {
namespace {

std::atomic<bool> interrupt_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

void note_interrupt(int signal)
{
    interrupt_seen = true;
    std::signal(signal, SIG_DFL);
}

/// Reading from a pipe or a terminal ends after a signal (no SA_RESTART), so that the reader can look for it.
void catch_interrupts()
{
    struct sigaction action = {};
    action.sa_handler = note_interrupt;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction old = {};
        sigaction(signal, nullptr, &old);
        if (old.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);  // nohup ignores SIGHUP
    }
}

/// Returns a message as it may go to a terminal. A text that is too long loses its middle.
std::string shown(const std::string& text)
{
    constexpr std::size_t most = 8000, end = 1000;  // bytes
    if (text.size() <= most) return printable(text, true);
    return printable(text.substr(0, most - end), true) + " … " + printable(text.substr(text.size() - end), true);
}

}  // namespace

Terminal::Terminal() { catch_interrupts(); }

void Terminal::notice(const std::string& text)
{
    hide_progress();
    std::cerr << "notice: " << shown(text) << "\n";
}

void Terminal::complain(const std::string& message)
{
    hide_progress();
    std::cerr << "spawnfield: " << shown(message) << "\n";
}

Progress Terminal::show_progress(const std::string& label)
{
    if (isatty(STDERR_FILENO) == 0) return {};
    using Clock = std::chrono::steady_clock;
    auto last = std::make_shared<Clock::time_point>(Clock::now());
    return [this, label, last](double share) {
        const auto now = Clock::now();
        if (now - *last < std::chrono::milliseconds(100)) return;
        *last = now;
        const int width = 30, full = int(share * width);
        std::fprintf(stderr, "\r%s [%s%s] %3d %%", label.c_str(), std::string(full, '#').c_str(),
                     std::string(width - full, ' ').c_str(), int(share * 100));
        is_bar_shown_ = true;
    };
}

void Terminal::hide_progress()
{
    if (is_bar_shown_) std::fprintf(stderr, "\r%70s\r", "");
    is_bar_shown_ = false;
}

bool Terminal::is_interrupted() const { return interrupt_seen; }

void Terminal::forget_interruption()
{
    interrupt_seen = false;
    catch_interrupts();
}

void Terminal::write(std::string_view text)
{
    std::cout << text;
    note_output_fault();
}

void Terminal::flush()
{
    note_output_fault();  // CLI11 writes the help without write()
    std::cout.flush();
    note_output_fault();
    if (output_fault_ != 0)
        throw OutputError("standard output", std::string("cannot be written: ") + std::strerror(output_fault_));
}

void Terminal::note_output_fault()
{
    if (!std::cout && output_fault_ == 0) output_fault_ = errno;
}

void Terminal::summarize(const std::string& line, const std::string&, bool is_quiet)
{
    hide_progress();
    if (!is_quiet) std::cerr << shown(line) << "\n";
}

}  // namespace spawnfield::cli

#include "interrupt.h"

#include <atomic>
#include <csignal>

namespace spawnfield::cli {
namespace {

std::atomic<bool> interrupt_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

void note_interrupt(int signal)
{
    interrupt_seen = true;
    std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts()
{
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (std::signal(signal, note_interrupt) == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup ignores SIGHUP
}

bool is_interrupted() { return interrupt_seen; }

bool end_interruptible_work(bool has_found)
{
    if (!has_found) stop_if_interrupted();
    if (!interrupt_seen.exchange(false)) return false;
    catch_interrupts();
    return true;
}

void stop_if_interrupted()
{
    if (is_interrupted()) throw Interrupted{};
}

}  // namespace spawnfield::cli

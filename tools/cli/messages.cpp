#include "messages.h"

#include "interrupt.h"
#include "notices.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>

namespace spawnfield::cli {
namespace {

bool bar_shown = false;

}  // namespace

void notice(const CommonArgs& args, const std::string& text)
{
    if (args.quiet) return;
    clear_progress_bar();
    std::cerr << "notice: " << text << "\n";
}

void notices(const CommonArgs& args, const std::vector<std::string>& texts)
{
    for (const std::string& text : grouped(texts)) notice(args, text);
}

void complain(const std::string& message)
{
    clear_progress_bar();
    std::cerr << "spawnfield: " << message << "\n";
}

Progress progress_bar(const CommonArgs& args, const std::string& label, bool throws)
{
    const bool shown = !args.quiet && isatty(STDERR_FILENO) != 0;
    using Clock = std::chrono::steady_clock;
    auto last = std::make_shared<Clock::time_point>(Clock::now());
    return [=](double share) {
        if (throws) stop_if_interrupted();
        const auto now = Clock::now();
        if (!shown || now - *last < std::chrono::milliseconds(100)) return;
        *last = now;
        const int width = 30, full = int(share * width);
        std::fprintf(stderr, "\r%s [%s%s] %3d %%", label.c_str(), std::string(full, '#').c_str(),
                     std::string(width - full, ' ').c_str(), int(share * 100));
        bar_shown = true;
    };
}

void clear_progress_bar()
{
    if (bar_shown) std::fprintf(stderr, "\r%70s\r", "");
    bar_shown = false;
}

}  // namespace spawnfield::cli

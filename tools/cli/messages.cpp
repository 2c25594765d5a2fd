#include "messages.h"

#include "host.h"
#include "notices.h"

namespace spawnfield::cli {

void notice(const CommonArgs& args, const std::string& text)
{
    if (!args.quiet) args.host->notice(text);
}

void notices(const CommonArgs& args, const std::vector<std::string>& texts)
{
    for (const std::string& text : grouped(texts)) notice(args, text);
}

Progress progress_bar(const CommonArgs& args, const std::string& label, bool throws)
{
    const Progress show = args.quiet ? Progress{} : args.host->show_progress(label);
    return [show, throws, host = args.host](double share) {
        if (throws && host->is_interrupted()) throw Interrupted{};
        if (show) show(share);
    };
}

void clear_progress_bar(const CommonArgs& args) { args.host->hide_progress(); }

void stop_if_interrupted(const CommonArgs& args)
{
    if (args.host->is_interrupted()) throw Interrupted{};
}

StopRequest stop_request(const CommonArgs& args)
{
    return [host = args.host] { return host->is_interrupted(); };
}

bool end_interruptible_work(const CommonArgs& args, bool has_found)
{
    if (!args.host->is_interrupted()) return false;
    if (!has_found) throw Interrupted{};
    args.host->forget_interruption();
    return true;
}

}  // namespace spawnfield::cli

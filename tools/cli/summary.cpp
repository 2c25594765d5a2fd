#include "summary.h"

#include "host.h"
#include "numbers.h"
#include "output.h"
#include "streams.h"

#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

namespace spawnfield::cli {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

std::uint64_t peak_memory_bytes()
{
    rusage own{}, readers{};  // the largest process that read files for this one
    getrusage(RUSAGE_SELF, &own);
    getrusage(RUSAGE_CHILDREN, &readers);
    return std::uint64_t(std::max(own.ru_maxrss, readers.ru_maxrss)) * 1024;  // Linux counts KiB
}

}  // namespace

Summary::Summary(std::string command, const CommonArgs& args)
    : command_(std::move(command)), args_(args), start_(now()), last_(start_)
{
    std::error_code ignored;
    const bool is_pipe = std::filesystem::is_fifo(args.summary, ignored);  // opening a pipe waits for its reader
    if (!args.summary.empty() && !is_standard(args.summary) && !is_pipe) file_.emplace(args.summary);
}

double Summary::lap(const std::string& stage)
{
    const double time = now(), out = time - last_;
    seconds_.emplace_back(stage, out);
    last_ = time;
    return out;
}

void Summary::set_verdicts(const VerdictCounts& counts, std::uint64_t exact_checks)
{
    counts_ = counts;
    exact_checks_ = exact_checks;
}

unsigned Summary::threads() const
{
    return args_.threads > 0 ? unsigned(args_.threads) : std::max(1u, std::thread::hardware_concurrency());
}

double Summary::seconds_of(const std::string& stage) const
{
    double sum = 0;
    for (const auto* const stages : {&seconds_, &more_stages})
        for (const auto& [name, seconds] : *stages)
            if (name == stage) sum += seconds;
    return sum;
}

std::string Summary::line(double total) const
{
    std::string text = "spawnfield " + command_ + ": " + (is_interrupted ? "interrupted; " : "");
    for (const std::string& words : extra) text += words + "; ";
    if (counts_) {
        text += counted(counts_->total(), "pose");
        std::string verdicts;
        for (auto verdict = all_verdicts.rbegin(); verdict != all_verdicts.rend(); ++verdict)  // valid first
            if (const std::uint64_t count = (*counts_)[*verdict]; count > 0)
                verdicts += (verdicts.empty() ? ": " : ", ") + std::to_string(count) + " " + to_string(*verdict);
        text += verdicts + "; " + (cells ? counted(*cells, "cell") + "; " : "") +
                counted(exact_checks_, "exact check") + "; ";
    }
    if (const std::size_t outside = args_.host->outside_files.size(); command_ == "bake" && outside > 0)
        text += counted(outside, "file") + " from outside of the scene's folder; ";
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.3f s", total);
    return text + seconds;
}

std::string Summary::json(double total) const
{
    nlohmann::ordered_json out;
    out["command"] = command_;
    if (is_interrupted) out["interrupted"] = true;
    out["poses"] = counts_ ? counts_->total() : 0;
    out["counts"] = nlohmann::ordered_json::object();
    if (counts_)
        for (const Verdict verdict : all_verdicts) out["counts"][to_string(verdict)] = (*counts_)[verdict];
    out["exact_checks"] = exact_checks_;
    if (fullness) {
        out["full"] = fullness->is_full;
        out["undecided_area"] = fullness->undecided_area;
    }
    if (cells) out["cells"] = *cells;
    if (offset) out["offset"] = *offset;
    if (repairs)
        out["repairs"] = {
            {"repaired", repairs->repaired}, {"turned", repairs->turned}, {"unrepaired", repairs->unrepaired}};
    for (const auto& [what, count] : draws) out["draws"][what] = count;
    const double load = seconds_of("load"), write = seconds_of("write");
    // Exact checks run on all threads, so their seconds are divided by the number of threads.
    const double islands = seconds_of("islands"), query = total - load - write - islands, judging = seconds_of("query");
    const double exact = std::min(judging, double(exact_time_.nanoseconds) * 1e-9 / threads());
    out["seconds"] = {{"load", load},   {"query", query}, {"mask", judging - exact},
                      {"exact", exact}, {"write", write}, {"total", total}};
    if (islands > 0) out["seconds"]["islands"] = islands;
    for (const auto& [stage, seconds] : more_stages) out["seconds"][stage] = seconds_of(stage);
    out["peak_memory_bytes"] = peak_memory_bytes();
    out["threads"] = threads();
    out["seed"] = seed;
    out["map_hash"] = map_hash;
    if (!changes.empty()) out["changes"] = changes;
    if (!args_.host->outside_files.empty()) out["outside_files"] = args_.host->outside_files;
    out["version"] = version();
    return out.dump(2) + "\n";
}

double Summary::elapsed() const { return now() - start_; }

void Summary::finish()
{
    const double total = elapsed();
    if (!args_.summary.empty()) {
        if (is_standard(args_.summary)) {
            write_output(args_, args_.summary, [&](const auto& sink) { sink(json(total)); });
        } else {
            if (!file_) file_.emplace(args_.summary);
            file_->write(json(total));
            file_->commit();
        }
    }
    args_.host->summarize(line(total), json(total), args_.quiet);
}

}  // namespace spawnfield::cli

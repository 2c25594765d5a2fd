#include "check_pairs.h"

#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "spelling.h"
#include "streams.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/pair_report.h>

#include <algorithm>
#include <array>

namespace spawnfield::cli {
namespace {

/// Returns "5 valid, 2 unreachable".
std::string pair_count_words(const std::vector<JudgedPair>& pairs)
{
    constexpr std::array all{PairVerdict::Valid,       PairVerdict::StartNotValid, PairVerdict::GoalNotValid,
                             PairVerdict::Unreachable, PairVerdict::TooShort,      PairVerdict::TooLong,
                             PairVerdict::TooDirect};
    std::string out;
    for (const PairVerdict verdict : all) {
        const auto count = std::count_if(pairs.begin(), pairs.end(),
                                         [&](const JudgedPair& pair) { return pair.verdict == verdict; });
        if (count > 0 || verdict == PairVerdict::Valid)
            out += (out.empty() ? "" : ", ") + std::to_string(count) + " " + to_string(verdict);
    }
    return out;
}

std::string pairs_not_valid_words(const PairReport& report)
{
    constexpr std::size_t shown = 5;
    std::size_t count = 0;
    std::string list;
    for (std::size_t i = 0; i < report.pairs.size(); ++i)
        if (report.pairs[i].verdict != PairVerdict::Valid && ++count <= shown)
            list += "\n  pair " + std::to_string(i + 1) + ": " + reason(report, i);
    if (count == 0) return "";
    return std::to_string(count) + " of " + counted(report.pairs.size(), "pair") + (count == 1 ? " is" : " are") +
           " not valid:" + list + (count > shown ? "\n  and " + std::to_string(count - shown) + " more" : "");
}

void write_report(const CommonArgs& args, const std::string& out, const std::string& format, const PairReport& report)
{
    write_output(args, out, [&](const auto& sink) {
        if (format == "json")
            write_judged_pairs_json(report, sink);
        else if (format == "junit")
            write_judged_pairs_junit(report, sink);
        else
            sink(judged_pairs_csv(report));
    });
}

}  // namespace

PairTable open_pairs(const CommonArgs& common, const std::string& file)
{
    const std::string text = is_standard(file) ? read_standard_input(common) : read_file(file);
    PairTable out = parse_pairs(text, input_name(file), common.allow_empty);
    for (const PoseTable* table : {&out.starts, &out.goals})
        for (const std::string& what : table->notices) notice(common, what);
    return out;
}

void add_check_pairs(CLI::App& command, CheckPairsArgs& args)
{
    command.add_option(
        "--pairs", args.file,
        "CSV file with pairs of a start and a goal: start_x,start_y,start_z[,start_yaw, …],goal_x, …, as "
        "sample --pairs writes them, in place of --poses. The robot is let down at both (- for standard "
        "input)");
    add_pair_limits(command, args.limits);
    add_reach(command, args.reach);
}

void refuse_check_pairs_options(const CLI::App& command)
{
    std::vector<std::string> names = pair_limit_names;
    names.insert(names.end(), reach_option_names.begin(), reach_option_names.end());
    refuse(command, names, "is only for --pairs; give it, or leave this option out");
}

Ending run_check_pairs(const QueryArgs& query, const CheckPairsArgs& args, const CLI::App& command,
                       const PairOutput& output, Summary& summary)
{
    PairOptions options = pair_limits(args.limits);
    options.spawns.threads = query.threads;
    options.spawns.progress = progress_bar(query, "check");
    const PairTable table = open_pairs(query, args.file);
    const Session session = open_session(query, summary);
    notices_about_stance(query, command, session.robot);
    summary.lap("load");
    const ReachGraph graph = find_islands(query, args.reach, session, summary, "check", true);
    const std::vector<JudgedPair> pairs = judge_pairs(*session.judge, graph, table.starts.poses, table.goals.poses,
                                                      options);
    summary.lap("query");
    const PairReport report{table, pairs, *session.judge, options};
    write_report(query, output.file, output.format, report);
    summary.extra.push_back(counted(pairs.size(), "pair") + ": " + pair_count_words(pairs));
    const std::string complaint = output.require_valid ? pairs_not_valid_words(report) : "";
    if (complaint.empty()) return {};
    return {.status = not_valid, .complaint = "--require-valid: " + complaint};
}

}  // namespace spawnfield::cli

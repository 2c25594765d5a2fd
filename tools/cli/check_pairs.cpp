#include "check_pairs.h"

#include "messages.h"
#include "numbers.h"
#include "output.h"
#include "spelling.h"
#include "streams.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/pair_files.h>

#include <algorithm>
#include <array>

namespace spawnfield::cli {
namespace {

PairTable open_pairs(const CommonArgs& common, const std::string& file)
{
    const std::string text = is_standard(file) ? read_standard_input() : read_file(file);
    PairTable out = parse_pairs(text, input_name(file), common.allow_empty);
    for (const PoseTable* table : {&out.starts, &out.goals})
        for (const std::string& what : table->notices) notice(common, what);
    return out;
}

/// Returns why a pair is not valid, in words.
std::string pair_reason(const JudgedPair& pair, const Judge& judge, const PairOptions& options)
{
    const auto island = [](const std::optional<std::size_t>& number) {
        return number ? "on island " + std::to_string(*number) : "on no island";
    };
    const std::string name = std::string(to_string(pair.verdict)) + ": ";
    switch (pair.verdict) {
    case PairVerdict::StartNotValid: return name + judge.describe(pair.start);
    case PairVerdict::GoalNotValid: return name + judge.describe(pair.goal);
    case PairVerdict::Unreachable:
        return name + "the start is " + island(pair.start_island) + ", the goal " + island(pair.goal_island);
    case PairVerdict::TooLong: return name + "the path is longer than " + number(options.max_path) + " m (--max-path)";
    case PairVerdict::TooShort:
        return name + "the path is " + rounded(*pair.path_length) + " m long, the limit is " +
               number(options.min_path) + " m (--min-path)";
    case PairVerdict::TooDirect:
        return name + "the path is " + rounded(*pair.detour()) + " times as long as the straight line, the limit is " +
               number(options.min_detour) + " (--detour)";
    case PairVerdict::Valid: break;
    }
    return "valid";
}

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

std::string pairs_not_valid_words(const std::vector<JudgedPair>& pairs, const Judge& judge, const PairOptions& options)
{
    constexpr std::size_t shown = 5;
    std::size_t count = 0;
    std::string list;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (pairs[i].verdict != PairVerdict::Valid && ++count <= shown)
            list += "\n  pair " + std::to_string(i + 1) + ": " + pair_reason(pairs[i], judge, options);
    if (count == 0) return "";
    return std::to_string(count) + " of " + counted(pairs.size(), "pair") + (count == 1 ? " is" : " are") +
           " not valid:" + list + (count > shown ? "\n  and " + std::to_string(count - shown) + " more" : "");
}

}  // namespace

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
                       const std::string& out, bool require_valid, Summary& summary)
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
    write_output(out, [&](const auto& sink) { sink(judged_pairs_csv(table, pairs)); });
    summary.extra.push_back(counted(pairs.size(), "pair") + ": " + pair_count_words(pairs));
    const std::string complaint = require_valid ? pairs_not_valid_words(pairs, *session.judge, options) : "";
    if (complaint.empty()) return {};
    return {.status = not_valid, .complaint = "--require-valid: " + complaint};
}

}  // namespace spawnfield::cli

#include "base/csv.h"
#include "base/number.h"
#include "base/number.h"
#include "pairs/pair_json.h"
#include "poses/judged_pose.h"
#include "poses/pose_columns.h"

#include <spawnfield/frames.h>
#include <spawnfield/pair_report.h>

namespace spawnfield {
namespace {

/// The columns of judged pairs.
const std::vector<std::string> pair_columns{"pair_verdict", "start_verdict", "goal_verdict", "path_length",
                                            "straight",     "detour",        "island",       "start_hit",
                                            "goal_hit",     "start_reason",  "goal_reason",  "pair_reason"};

constexpr std::array all_pair_verdicts{PairVerdict::StartNotValid, PairVerdict::GoalNotValid, PairVerdict::Unreachable,
                                       PairVerdict::TooLong,       PairVerdict::TooShort,     PairVerdict::TooDirect,
                                       PairVerdict::Valid};

std::size_t count_of(const PairReport& report, PairVerdict verdict)
{
    return std::size_t(std::ranges::count(report.pairs, verdict, &JudgedPair::verdict));
}

/// Appends a comma, and the number if there is one.
void append_optional(std::string& text, const std::optional<double>& value)
{
    text += ',';
    if (value) append_number(text, *value);
}

std::string hit_name(const SettledPose& pose, const Map& map) { return pose.hit ? name_of(*pose.hit, map) : ""; }

std::string why_not_valid(const SettledPose& pose, const Judge& judge)
{
    return pose.verdict == Verdict::Valid ? "" : judge.describe(pose);
}

void append_columns(std::string& text, const PairReport& report, std::size_t index)
{
    const JudgedPair& pair = report.pairs[index];
    const Judge& judge = report.judge;
    text += std::string(to_string(pair.verdict)) + ',' + to_string(pair.start.verdict) + ',' +
            to_string(pair.goal.verdict);
    for (const std::optional<double>& value : {pair.path_length, pair.straight, pair.detour()})
        append_optional(text, value);
    text += ',';
    if (pair.start_island && pair.start_island == pair.goal_island) text += std::to_string(*pair.start_island);
    const std::string words = pair.verdict == PairVerdict::Valid ? "" : reason(report, index);
    for (const std::string& field : {hit_name(pair.start, judge.map()), hit_name(pair.goal, judge.map()),
                                     why_not_valid(pair.start, judge), why_not_valid(pair.goal, judge), words})
        text += ',' + csv_quoted(field);
}

Json settings_json(const PairReport& report)
{
    Json out = judge_settings_json(report.judge, true);
    add_path_limits(out, report.options);
    return out;
}

template <class Value>
Json optional_json(const std::optional<Value>& value)
{
    return value ? Json(*value) : Json();
}

/// Returns a start or a goal as it was given, with what the judge says about it.
Json end_json(const PairReport& report, const Pose& given, const SettledPose& pose)
{
    Json out = pose_json({{}, {}, given.position, rpy_from(given.rotation)});
    const Judgement judgement = judgement_of(pose);
    add_verdict(out, {report.judge, given, judgement, &pose});
    return out;
}

Json row_json(const PairReport& report, std::size_t index, const std::string& name)
{
    const JudgedPair& pair = report.pairs[index];
    Json out = {{"row", index + 1}};
    if (!name.empty()) out["name"] = name;
    out["verdict"] = to_string(pair.verdict);
    out["reason"] = pair.verdict == PairVerdict::Valid ? Json() : Json(reason(report, index));
    out["start"] = end_json(report, report.table.starts.poses[index], pair.start);
    out["goal"] = end_json(report, report.table.goals.poses[index], pair.goal);
    out["path_length"] = optional_json(pair.path_length);
    out["straight"] = optional_json(pair.straight);
    out["detour"] = optional_json(pair.detour());
    out["start_island"] = optional_json(pair.start_island);
    out["goal_island"] = optional_json(pair.goal_island);
    out["columns"] = fields_json(report.table.starts, index, pair_columns);
    return out;
}

/// Returns the text of a test case of JUnit that fails.
std::string failure_details(const PairReport& report, std::size_t index)
{
    const JudgedPair& pair = report.pairs[index];
    std::string text = "row " + std::to_string(index + 1) + ": " + xml_text(report.table.starts.rows[index]) + "\n";
    const auto add = [&](const std::string& name, const Pose& given, const SettledPose& pose) {
        const Judgement judgement = judgement_of(pose);
        text += name + ": " + xml_text(report.judge.describe(pose)) + "\n" +
                verdict_lines({report.judge, given, judgement, &pose});
    };
    add("start", report.table.starts.poses[index], pair.start);
    add("goal", report.table.goals.poses[index], pair.goal);
    if (pair.path_length)
        text += "path of " + rounded(*pair.path_length) + " m, " + rounded(*pair.straight) + " m in a straight line\n";
    return text;
}

}  // namespace

std::string reason(const PairReport& report, std::size_t index)
{
    const JudgedPair& pair = report.pairs[index];
    const PairOptions& options = report.options;
    const auto island = [](const std::optional<std::size_t>& number) {
        return number ? "on island " + std::to_string(*number) : "on no island";
    };
    const std::string name = std::string(to_string(pair.verdict)) + ": ";
    switch (pair.verdict) {
    case PairVerdict::StartNotValid: return name + report.judge.describe(pair.start);
    case PairVerdict::GoalNotValid: return name + report.judge.describe(pair.goal);
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

std::string judged_pairs_csv(const PairReport& report)
{
    return with_columns(report.table.starts, pair_columns,
                        [&](std::string& text, std::size_t i) { append_columns(text, report, i); });
}

void write_judged_pairs_json(const PairReport& report, const TextSink& sink)
{
    const Judge& judge = report.judge;
    Json head = json_head("check", judge.map(), judge.robot(), settings_json(report), "spawnfield-pair-verdicts/1");
    for (const PairVerdict verdict : all_pair_verdicts) head["counts"][to_string(verdict)] = count_of(report, verdict);
    const std::vector<std::string> names = column_of(report.table.starts, "name");
    const auto row = [&](std::size_t i) { return row_json(report, i, names.empty() ? "" : names[i]); };
    write_json_rows(head, "pairs", report.pairs.size(), row, sink);
}

void write_judged_pairs_junit(const PairReport& report, const TextSink& sink)
{
    const std::vector<std::string> names = row_names(report.table.starts, "pair");
    const auto test_case = [&](std::size_t i) -> JunitCase {
        const PairVerdict verdict = report.pairs[i].verdict;
        if (verdict == PairVerdict::Valid) return {.name = names[i]};
        return {names[i], to_string(verdict), reason(report, i), failure_details(report, i)};
    };
    write_junit({.map = report.judge.map().name,
                 .robot = robot_name(report.judge.robot()),
                 .properties = junit_properties(report.judge, settings_json(report)),
                 .cases = names.size(),
                 .failures = names.size() - count_of(report, PairVerdict::Valid),
                 .test_case = test_case},
                sink);
}

}  // namespace spawnfield

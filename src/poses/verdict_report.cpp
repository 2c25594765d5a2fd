#include "poses/judged_pose.h"

#include "base/number.h"

#include <spawnfield/frames.h>
#include <spawnfield/verdict_report.h>

namespace spawnfield {
namespace {

JudgedPose judged_pose(const VerdictReport& report, std::size_t index)
{
    return {report.judge, report.table.poses[index], report.judgements[index],
            report.settled != nullptr ? &(*report.settled)[index] : nullptr};
}

VerdictCounts counts_of(const VerdictReport& report)
{
    VerdictCounts counts;
    for (const Judgement& judged : report.judgements) ++counts[judged.verdict];
    return counts;
}

Json settings_json(const VerdictReport& report)
{
    Json out = judge_settings_json(report.judge, report.settled != nullptr);
    if (report.repairs == nullptr) return out;
    const RepairOptions& search = report.repairs->options;
    out["repair"] = {{"radius", search.radius}, {"step", *search.step}, {"headings", search.headings}};
    return out;
}

/// Returns the repair of a pose; null if the pose is valid.
Json repair_json(const std::optional<Repair>& repair)
{
    if (!repair) return {};
    Json out = {{"found", repair->pose.has_value()}};
    if (repair->pose) {
        const Spawn& to = *repair->pose;
        out.update(pose_json({{}, {}, to.position, {to.roll, to.pitch, to.yaw}}));
        out["distance"] = repair->distance;
        out["turn"] = repair->turn;
    }
    out["tried"] = repair->tried;
    return out;
}

/// Returns the repair of a pose in words.
std::string repair_words(const Repair& repair, const RepairOptions& options)
{
    if (!repair.pose)
        return "no repair: none of " + std::to_string(repair.tried) + " grid poses within " + rounded(options.radius) +
               " m is valid";
    const Spawn& to = *repair.pose;
    return "repair: position " + listed(to.position) + " m; roll, pitch, yaw " + listed({to.roll, to.pitch, to.yaw}) +
           " rad; " + rounded(repair.distance) + " m away";
}

Json verdict_json(const VerdictReport& report, std::size_t index, const std::string& name,
                  const std::vector<std::string>& replaced)
{
    const Pose& pose = report.table.poses[index];
    Json out = {{"row", report.first + index + 1}};
    out.update(pose_json({name, {}, pose.position, rpy_from(pose.rotation)}));
    add_verdict(out, judged_pose(report, index));
    if (report.repairs != nullptr) out["repair"] = repair_json(report.repairs->repairs[index]);
    out["columns"] = fields_json(report.table, index, replaced);
    return out;
}

/// Returns the text of a test case of JUnit that fails.
std::string failure_details(const VerdictReport& report, std::size_t index)
{
    std::string text = "row " + std::to_string(report.first + index + 1) + ": " + xml_text(report.table.rows[index]) +
                       "\n" + verdict_lines(judged_pose(report, index));
    if (report.repairs != nullptr && report.repairs->repairs[index])
        text += repair_words(*report.repairs->repairs[index], report.repairs->options) + "\n";
    return text;
}

}  // namespace

std::vector<std::string> pose_names(const PoseTable& table, std::size_t first)
{
    return row_names(table, "pose", first);
}

std::string reason(const VerdictReport& report, std::size_t index) { return reason_of(judged_pose(report, index)); }

bool remains_invalid(const VerdictReport& report, std::size_t index)
{
    if (report.repairs == nullptr) return report.judgements[index].verdict != Verdict::Valid;
    const std::optional<Repair>& repair = report.repairs->repairs[index];
    return repair && !repair->pose;
}

void write_verdicts_json(const VerdictReport& report, const TextSink& sink)
{
    Json head = json_head("check", report.judge.map(), report.judge.robot(), settings_json(report),
                          "spawnfield-verdicts/1");
    const VerdictCounts counts = counts_of(report);
    for (const Verdict verdict : all_verdicts) head["counts"][to_string(verdict)] = counts[verdict];
    const std::vector<std::string> names = column_of(report.table, "name"),
                                   replaced = replaced_columns(report.table, report.settled != nullptr,
                                                               report.repairs != nullptr);
    const auto row = [&](std::size_t i) { return verdict_json(report, i, names.empty() ? "" : names[i], replaced); };
    write_json_rows(head, "poses", report.judgements.size(), row, sink);
}

void write_verdicts_junit(const VerdictReport& report, const TextSink& sink)
{
    const std::vector<std::string> names = pose_names(report.table, report.first);
    const auto test_case = [&](std::size_t i) -> JunitCase {
        const Verdict verdict = report.judgements[i].verdict;
        if (verdict == Verdict::Valid) return {.name = names[i]};
        return {names[i], to_string(verdict), reason(report, i), failure_details(report, i)};
    };
    const std::size_t all = names.size();
    write_junit({.map = report.judge.map().name,
                 .robot = robot_name(report.judge.robot()),
                 .properties = junit_properties(report.judge, settings_json(report)),
                 .cases = all,
                 .failures = all - std::size_t(counts_of(report)[Verdict::Valid]),
                 .test_case = test_case},
                sink);
}

}  // namespace spawnfield

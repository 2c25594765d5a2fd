#include "audit/audit_words.h"
#include "base/text.h"
#include "poses/judged_pose.h"

#include <algorithm>

namespace spawnfield {
namespace {

constexpr std::size_t most_lines = 20;  // of a list; the other formats have all

/// Adds lines with two spaces in front, at most `most_lines` of them.
void add_lines(std::string& out, const std::vector<std::string>& lines)
{
    for (std::size_t i = 0; i < std::min(lines.size(), most_lines); ++i) out += "  " + one_line(lines[i]) + "\n";
    if (lines.size() > most_lines)
        out += "  and " + std::to_string(lines.size() - most_lines) + " more (json, junit and html have all)\n";
}

void add_robot(std::string& out, const AuditReport& report, const RobotAudit& robot)
{
    const auto islands = robot.graph.islands();
    out += one_line(robot_name(robot.judge.robot())) + ": free area " + area_words(robot.free_area, robot.free_share) +
           "; " + counted_things(islands.size(), "island");
    if (!islands.empty()) out += ", the largest " + area_words(islands[0].area, islands[0].share);
    out += "; " + counted_things(robot.closed_rooms.size(), "closed room");
    if (!report.poses.empty())
        out += "; " + std::to_string(report.poses.size() - robot.bad_poses.size()) + " of " +
               counted_things(report.poses.size(), "pose") + " valid";
    out += "\n";
    std::vector<std::string> rooms, poses;
    for (const ClosedRoom& room : robot.closed_rooms) rooms.push_back("closed room: " + words_of(room));
    for (const BadPose& bad : robot.bad_poses) poses.push_back(report.poses[bad.pose].name + ": " + words_of(bad));
    add_lines(out, rooms);
    add_lines(out, poses);
}

void add_findings(std::string& out, const FindingClass& found)
{
    out += found.title + ": " + (found.findings.empty() ? "none" : std::to_string(found.findings.size())) + "\n";
    std::vector<std::string> lines;
    for (const AuditFinding& finding : found.findings)
        lines.push_back((finding.name.empty() ? "" : finding.name + ": ") + finding.words);
    add_lines(out, lines);
}

void add_rules(std::string& out, const std::vector<RuleResult>& rules)
{
    if (rules.empty()) return;
    std::vector<std::string> broken;
    for (const RuleResult& result : rules)
        if (!result.is_kept) broken.push_back(result.rule + ": " + result.words);
    out += "rules: " + std::to_string(broken.size()) + " of " + std::to_string(rules.size()) + " broken\n";
    add_lines(out, broken);
}

}  // namespace

std::string audit_text(const AuditReport& report)
{
    std::string out = "world " + one_line(report.map.name) + ": " + counted_things(report.robots.size(), "robot") +
                      ", " + counted_things(report.parts.props, "prop") + "\n";
    for (const RobotAudit& robot : report.robots) add_robot(out, report, robot);
    for (const FindingClass& found : finding_classes(report)) {
        if (found.key == "missing" && !report.missing)
            out += "missing files: not known, because a map folder does not say what was missing\n";
        else
            add_findings(out, found);
    }
    if (const std::string undecided = undecided_words(report); !undecided.empty()) out += undecided + "\n";
    add_rules(out, report.rules);
    return out;
}

}  // namespace spawnfield

#include "audit/audit_words.h"
#include "poses/judged_pose.h"

namespace spawnfield {
namespace {

/// Returns a test case that fails if there are findings.
JunitCase case_of(const std::string& group, const std::string& name, const std::string& type,
                  const std::vector<std::string>& lines)
{
    JunitCase out{.name = name, .group = group};
    if (lines.empty()) return out;
    out.type = type;
    out.message = std::to_string(lines.size()) + ": " + lines[0] + (lines.size() > 1 ? "; …" : "");
    for (const std::string& line : lines) out.details += xml_text(line) + "\n";
    return out;
}

void add_rules(std::vector<JunitCase>& out, const AuditReport& report)
{
    for (const RuleResult& result : report.rules) {
        if (result.rule == "require") continue;  // the pose has a case of its own
        JunitCase rule{.name = result.rule + (result.subject.empty() ? "" : ", " + result.subject), .group = "rules"};
        if (!result.is_kept) {
            rule.type = result.rule;
            rule.message = result.words;
            rule.details = xml_text(result.words) + "\n";
        }
        out.push_back(std::move(rule));
    }
}

void add_robot(std::vector<JunitCase>& out, const AuditReport& report, const RobotAudit& robot)
{
    const std::string name = robot_name(robot.judge.robot());
    for (std::size_t i = 0; i < report.poses.size(); ++i) {
        JunitCase pose{.name = report.poses[i].name, .group = name};
        if (const BadPose* const bad = bad_pose_at(robot, i)) {
            pose.type = to_string(bad->verdict);
            pose.message = bad->reason;
            pose.details = xml_text(words_of(*bad)) + "\n";
        }
        out.push_back(std::move(pose));
    }
    if (has_rule(report, "max_closed_rooms")) return;
    std::vector<std::string> lines;
    for (const ClosedRoom& room : robot.closed_rooms) lines.push_back(words_of(room));
    out.push_back(case_of(name, "closed rooms", "closed_rooms", lines));
}

std::vector<JunitCase> cases_of(const AuditReport& report)
{
    std::vector<JunitCase> out;
    add_rules(out, report);
    for (const RobotAudit& robot : report.robots) add_robot(out, report, robot);
    for (const FindingClass& found : finding_classes(report)) {
        if (has_rule(report, found.rule)) continue;
        std::vector<std::string> lines;
        for (const AuditFinding& finding : found.findings)
            lines.push_back((finding.name.empty() ? "" : finding.name + ": ") + finding.words);
        out.push_back(case_of("world", found.title, found.key, lines));
    }
    return out;
}

}  // namespace

void write_audit_junit(const AuditReport& report, const std::function<void(std::string_view)>& sink)
{
    const std::vector<JunitCase> cases = cases_of(report);
    const auto failures = std::count_if(cases.begin(), cases.end(),
                                        [](const JunitCase& test) { return !test.type.empty(); });
    std::vector<std::pair<std::string, std::string>> properties{
        {"version", version()}, {"map", report.map.name}, {"map_hash", report.map.hash}};
    for (const RobotAudit& robot : report.robots) {
        const std::string name = robot_name(robot.judge.robot());
        properties.emplace_back("robot", name);
        properties.emplace_back("free_area, " + name, area_words(robot.free_area, robot.free_share));
        properties.emplace_back("islands, " + name, std::to_string(robot.graph.islands().size()));
    }
    write_junit({.command = "audit",
                 .map = report.map.name,
                 .properties = properties,
                 .cases = cases.size(),
                 .failures = std::size_t(failures),
                 .test_case = [&](std::size_t i) { return cases[i]; }},
                sink);
}

}  // namespace spawnfield

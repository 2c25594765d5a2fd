#include "audit/audit_words.h"
#include "base/number.h"
#include "poses/judged_pose.h"

#include <spawnfield/audit.h>
#include <spawnfield/error.h>

#include <algorithm>

namespace spawnfield {
namespace {

/// Adds the result of a rule that limits a number of things. `thing` has a plural with "s".
void add_count(std::vector<RuleResult>& out, const std::string& rule, const std::string& subject, std::size_t count,
               const std::optional<std::size_t>& most, const std::string& thing)
{
    if (!most) return;
    const std::string of = subject.empty() ? "" : " of " + subject;
    out.push_back({rule, subject, count <= *most,
                   counted_things(count, thing) + of + ", at most " + std::to_string(*most) +
                       (*most == 1 ? " is allowed" : " are allowed")});
}

/// Adds the result of a rule that limits findings. If it is broken, its words name the first of them.
void add_findings(std::vector<RuleResult>& out, const AuditReport& report, const std::string& rule,
                  const std::optional<std::size_t>& most, const std::string& thing)
{
    constexpr std::size_t most_names = 5;
    for (const FindingClass& found : finding_classes(report)) {
        if (found.rule != rule || !most) continue;
        add_count(out, rule, "", found.findings.size(), most, thing);
        if (out.back().is_kept) continue;
        for (std::size_t k = 0; k < std::min(most_names, found.findings.size()); ++k) {
            const AuditFinding& finding = found.findings[k];
            out.back().words += (k == 0 ? ": " : "; ") + (finding.name.empty() ? finding.words : finding.name);
        }
        if (found.findings.size() > most_names) out.back().words += "; …";
    }
}

/// Returns whether a pose is one that the rules require.
bool is_required(const AuditRules& rules, const NamedPose& pose)
{
    const auto is_same = [&](const NamedPose& other) { return other.name == pose.name; };
    return rules.requires_all || std::any_of(rules.poses.begin(), rules.poses.end(), is_same) ||
           std::find(rules.required.begin(), rules.required.end(), pose.name) != rules.required.end();
}

void add_poses(std::vector<RuleResult>& out, const AuditRules& rules, const AuditReport& report,
               const RobotAudit& robot)
{
    const std::string name = robot_name(robot.judge.robot());
    for (std::size_t i = 0; i < report.poses.size(); ++i) {
        if (!is_required(rules, report.poses[i])) continue;
        const BadPose* const bad = bad_pose_at(robot, i);
        const std::string where = report.poses[i].name + ", " + name;
        out.push_back({"require", where, bad == nullptr,
                       where + ": " + (bad == nullptr ? "valid" : bad->reason + "; the pose must be valid")});
    }
}

void add_robot(std::vector<RuleResult>& out, const AuditRules& rules, const AuditReport& report,
               const RobotAudit& robot)
{
    const std::string name = robot_name(robot.judge.robot());
    if (rules.min_free_area)
        out.push_back({"min_free_area", name, robot.free_area >= *rules.min_free_area,
                       "free area of " + name + " is " + rounded(robot.free_area) + " m2, at least " +
                           rounded(*rules.min_free_area) + " m2 are needed"});
    add_count(out, "max_islands", name, robot.graph.islands().size(), rules.max_islands, "island");
    add_count(out, "max_closed_rooms", name, robot.closed_rooms.size(), rules.max_closed_rooms, "closed room");
    add_poses(out, rules, report, robot);
}

void add_missing(std::vector<RuleResult>& out, const AuditRules& rules, const AuditReport& report)
{
    if (!rules.max_missing) return;
    if (report.missing) return add_findings(out, report, "max_missing", rules.max_missing, "missing file");
    out.push_back({"max_missing", "", false,
                   "it is not known what is missing, because a map folder does not say; give the scene in its place"});
}

}  // namespace

std::vector<NamedPose> audited_poses(const AuditRules& rules, const std::vector<NamedPose>& listed)
{
    std::vector<NamedPose> out = listed;
    for (const std::string& name : rules.required)
        if (std::none_of(listed.begin(), listed.end(), [&](const NamedPose& pose) { return pose.name == name; }))
            throw ArgumentError("audited_poses", "require: no pose has the name \"" + name +
                                                     "\"; give a file of poses that has it, or a pose as [x, y, z, "
                                                     "yaw]");
    out.insert(out.end(), rules.poses.begin(), rules.poses.end());
    return out;
}

std::vector<RuleResult> results_of(const AuditRules& rules, const AuditReport& report)
{
    std::vector<RuleResult> out;
    for (const RobotAudit& robot : report.robots) add_robot(out, rules, report, robot);
    add_findings(out, report, "max_overlaps", rules.max_overlaps, "overlap");
    add_findings(out, report, "max_floating", rules.max_floating, "floating prop");
    add_findings(out, report, "max_sunken", rules.max_sunken, "sunken prop");
    add_missing(out, rules, report);
    return out;
}

}  // namespace spawnfield

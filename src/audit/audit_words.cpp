#include "audit/audit_words.h"

#include "base/number.h"
#include "poses/judged_pose.h"

#include <algorithm>
#include <cmath>

namespace spawnfield {
namespace {

std::string joined(const std::vector<std::string>& names)
{
    std::string out;
    for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
    return out;
}

/// Returns a length of a finding, m, rounded to 0.1 mm.
std::string length_words(double metres) { return rounded(std::round(metres * 1e4) / 1e4) + " m"; }

std::string place_words(const Vec3& point)
{
    const Vec3 millimetres = (point * 1e3).array().round();
    return listed(millimetres / 1e3) + " m";
}

std::string percent(double share) { return rounded(std::round(share * 1e3) / 10) + " %"; }

AuditFinding finding_of(const FloatingProps& floating)
{
    const std::string end = floating.height ? "hangs " + length_words(*floating.height) + " above " + floating.below
                                            : "hangs above nothing";
    return {joined(floating.props), end + ", lowest point " + place_words(floating.lowest)};
}

AuditFinding finding_of(const SunkenProp& sunken)
{
    return {sunken.prop, percent(sunken.share) + " of it is below the ground, its highest point is " +
                             length_words(sunken.top) + ", middle " + place_words(sunken.place)};
}

AuditFinding finding_of(const Overlap& overlap)
{
    return {overlap.a + ", " + overlap.b, "overlap by " + std::string(overlap.is_exact ? "" : "at least ") +
                                              length_words(overlap.depth) + " at " + place_words(overlap.place)};
}

template <class List>
std::vector<AuditFinding> findings_of(const List& list)
{
    std::vector<AuditFinding> out;
    for (const auto& entry : list) out.push_back(finding_of(entry));
    return out;
}

}  // namespace

std::string counted_things(std::size_t count, const std::string& thing)
{
    return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

const BadPose* bad_pose_at(const RobotAudit& robot, std::size_t pose)
{
    for (const BadPose& bad : robot.bad_poses)
        if (bad.pose == pose) return &bad;
    return nullptr;
}

std::vector<FindingClass> finding_classes(const AuditReport& report)
{
    std::vector<FindingClass> out{
        {"floating props", "floating", "max_floating", findings_of(report.parts.floating)},
        {"sunken props", "sunken", "max_sunken", findings_of(report.parts.sunken)},
        {"overlapping parts", "overlaps", "max_overlaps", findings_of(report.parts.overlaps)}};
    FindingClass missing{"missing files", "missing", "max_missing", {}};
    if (report.missing)
        for (const std::string& text : *report.missing) missing.findings.push_back({"", text});
    out.push_back(std::move(missing));
    return out;
}

std::string words_of(const ClosedRoom& room)
{
    return "island " + std::to_string(room.island) + ", " + rounded(std::round(room.area * 100) / 100) + " m2, at " +
           place_words(room.place);
}

std::string words_of(const BadPose& pose)
{
    std::string out = pose.reason;
    if (!pose.repair.pose)
        return out + "; no valid pose near it was found (" + std::to_string(pose.repair.tried) + " were tried)";
    const Spawn& to = *pose.repair.pose;
    return out + "; the nearest valid pose is " + length_words(pose.repair.distance) +
           " away: " + place_words(to.position) + ", yaw " + rounded(std::round(to.yaw * 1e4) / 1e4) + " rad";
}

std::string area_words(double area, double share)
{
    return rounded(std::round(area * 100) / 100) + " m2 (" + percent(share) + ")";
}

std::string undecided_words(const AuditReport& report)
{
    const std::size_t pairs = report.parts.undecided.size();
    if (pairs == 0) return "";
    return counted_things(pairs, "pair") + " of meshes may overlap, too, but this was not decided (json lists them)";
}

bool has_rule(const AuditReport& report, const std::string& rule)
{
    return std::any_of(report.rules.begin(), report.rules.end(),
                       [&](const RuleResult& result) { return result.rule == rule; });
}

}  // namespace spawnfield

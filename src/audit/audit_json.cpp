#include "audit/audit_words.h"
#include "poses/judged_pose.h"

#include <spawnfield/frames.h>

#include <algorithm>

namespace spawnfield {
namespace {

Json point_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json settings_json(const RobotAudit& robot)
{
    const ReachOptions& reach = robot.graph.options();
    Json out = judge_settings_json(robot.judge, true);
    out["drive"] = name_of(*reach.drive);
    out["max_step"] = *reach.max_step;
    if (reach.turning_radius) out["turning_radius"] = *reach.turning_radius;
    out["reach_step"] = *reach.step;
    return out;
}

Json free_json(const RobotAudit& robot)
{
    Json out = {{"area", robot.free_area}, {"share", robot.free_share}, {"step", robot.raster.grid.step}};
    for (const Verdict verdict : all_verdicts) out["poses"][to_string(verdict)] = robot.raster.counts[verdict];
    return out;
}

Json islands_json(const RobotAudit& robot)
{
    Json out = Json::array();
    for (const Island& island : robot.graph.islands())
        out.push_back({{"island", out.size()},
                       {"area", island.area},
                       {"share", island.share},
                       {"at", point_json(island.place)},
                       {"z", {island.low, island.high}}});
    return out;
}

Json rooms_json(const RobotAudit& robot)
{
    Json out = Json::array();
    for (const ClosedRoom& room : robot.closed_rooms)
        out.push_back({{"island", room.island}, {"area", room.area}, {"at", point_json(room.place)}});
    return out;
}

Json bad_pose_json(const BadPose& bad, const AuditReport& report)
{
    Json out = {{"name", report.poses[bad.pose].name},
                {"verdict", to_string(bad.verdict)},
                {"reason", bad.reason},
                {"culprit", bad.culprit.empty() ? Json() : Json(bad.culprit)},
                {"repair", nullptr},
                {"tried", bad.repair.tried}};
    if (const std::optional<Spawn>& to = bad.repair.pose) {
        out["repair"] = pose_json({{}, {}, to->position, {to->roll, to->pitch, to->yaw}});
        out["repair"]["distance"] = bad.repair.distance;
        out["repair"]["turn"] = bad.repair.turn;
    }
    return out;
}

Json robot_json(const RobotAudit& robot, const AuditReport& report)
{
    Json out = {{"robot", robot_name(robot.judge.robot())},
                {"settings", settings_json(robot)},
                {"free", free_json(robot)},
                {"islands", islands_json(robot)},
                {"closed_rooms", rooms_json(robot)}};
    out["bad_poses"] = Json::array();
    for (const BadPose& bad : robot.bad_poses) out["bad_poses"].push_back(bad_pose_json(bad, report));
    return out;
}

Json overlaps_json(const std::vector<Overlap>& overlaps)
{
    Json out = Json::array();
    for (const Overlap& overlap : overlaps)
        out.push_back({{"parts", {overlap.a, overlap.b}},
                       {"depth", overlap.depth},
                       {"exact", overlap.is_exact},
                       {"at", point_json(overlap.place)}});
    return out;
}

void add_findings(Json& out, const AuditReport& report)
{
    out["floating"] = Json::array();
    for (const FloatingProps& floating : report.parts.floating)
        out["floating"].push_back({{"props", floating.props},
                                   {"lowest", point_json(floating.lowest)},
                                   {"height", floating.height ? Json(*floating.height) : Json()},
                                   {"below", floating.height ? Json(floating.below) : Json()}});
    out["sunken"] = Json::array();
    for (const SunkenProp& sunken : report.parts.sunken)
        out["sunken"].push_back({{"prop", sunken.prop},
                                 {"share", sunken.share},
                                 {"top", sunken.top},
                                 {"lines", sunken.lines},
                                 {"at", point_json(sunken.place)}});
    out["overlaps"] = overlaps_json(report.parts.overlaps);
    out["undecided_overlaps"] = overlaps_json(report.parts.undecided);
    out["missing"] = report.missing ? Json(*report.missing) : Json();
}

}  // namespace

void write_audit_json(const AuditReport& report, const std::function<void(std::string_view)>& sink)
{
    Json out = {{"format", "spawnfield-audit/1"},
                {"version", version()},
                {"world", {{"name", report.map.name}, {"hash", report.map.hash}}},
                {"frame", "metres, radians, x forward, y left, z up (REP-103)"},
                {"limits",
                 {{"gap", report.part_limits.gap},
                  {"overlap", report.part_limits.overlap},
                  {"min_room", report.min_room},
                  {"allow", report.part_limits.allow}}},
                {"props", report.parts.props}};
    out["robots"] = Json::array();
    for (const RobotAudit& robot : report.robots) out["robots"].push_back(robot_json(robot, report));
    out["poses"] = Json::array();
    for (const NamedPose& named : report.poses)
        out["poses"].push_back(pose_json({named.name, {}, named.pose.position, rpy_from(named.pose.rotation)}));
    add_findings(out, report);
    out["rules"] = Json::array();
    for (const RuleResult& result : report.rules)
        out["rules"].push_back(
            {{"rule", result.rule}, {"subject", result.subject}, {"kept", result.is_kept}, {"words", result.words}});
    sink(json_text(out, 1) + "\n");
}

}  // namespace spawnfield

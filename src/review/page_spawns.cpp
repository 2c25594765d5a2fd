#include "review/page_spawns.h"

#include "base/csv.h"
#include "poses/judged_pose.h"
#include "query/place_meter.h"
#include "review/judged_poses.h"

#include <spawnfield/frames.h>
#include <spawnfield/pair_report.h>
#include <spawnfield/path.h>

namespace spawnfield {
namespace {

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json pose_numbers(const Vec3& position, const Rpy& rpy)
{
    return {position.x(), position.y(), position.z(), rpy.roll, rpy.pitch, rpy.yaw};
}

/// Returns the pose of a robot at rest, raised by the lift; its place if it has none.
Json rest_numbers(const SettledPose& pose, double lift)
{
    return pose_numbers(pose.position + lift * Vec3::UnitZ(), {pose.roll, pose.pitch, pose.yaw});
}

Json contacts_of(const SettledPose& pose)
{
    Json out = Json::array();
    for (const RestContact& contact : pose.contacts)
        out.push_back({contact.point.x(), contact.point.y(), contact.point.z()});
    return out;
}

/// Returns the verdict whose colour a pair has: that of its end that is not valid, or whether there is a way.
Verdict verdict_of(const JudgedPair& pair)
{
    switch (pair.verdict) {
    case PairVerdict::StartNotValid: return pair.start.verdict;
    case PairVerdict::GoalNotValid: return pair.goal.verdict;
    case PairVerdict::Valid: return Verdict::Valid;
    default: return Verdict::Unreachable;
    }
}

}  // namespace

Json spawns_for_page(const Judge& judge, const ReviewSpawns& spawns, const ReviewContents& contents,
                     const RunOptions& options)
{
    const PoseTable& table = spawns.table;
    const bool is_settled = contents.stance == Stance::Settled;
    PlaceMeasures clearance;
    clearance.columns = {PlaceQuantity::Clearance};
    const PlaceMeter meter("write_review", judge.map().geometry, judge.robot(), clearance, is_settled);
    Json poses = Json::array(), verdicts = poses, hits = poses, reasons = poses, tilt = poses, margin = poses,
         clearances = poses, contacts = poses, rows = poses;
    for (const std::string& row : table.rows) rows.push_back(csv_fields(row));
    const double lift = judge.options().stand.lift;
    judge_places(
        judge, contents.stance, table.poses.size(), [&](std::size_t k) { return table.poses[k]; }, options,
        [&](std::size_t i, const JudgedPlace& place) {
            const Pose& given = table.poses[i];
            const SettledPose& rest = place.settled;
            const bool is_down = is_settled && rest.has_pose, is_valid = place.judgement.verdict == Verdict::Valid;
            poses.push_back(is_down ? rest_numbers(rest, lift)
                                    : pose_numbers(given.position, rpy_from(given.rotation)));
            verdicts.push_back(int(place.judgement.verdict));
            hits.push_back(hit_number(place.judgement.hit, judge.map()));
            reasons.push_back(place.reason);
            tilt.push_back(is_down ? number_or_null(rest.tilt) : Json());
            margin.push_back(is_down ? number_or_null(rest.margin) : Json());
            const Pose pose = is_down ? rest.lifted(lift) : given;
            clearances.push_back(is_valid ? number_or_null(meter.measure(PlaceQuantity::Clearance, pose, rest.tilt,
                                                                         rest.margin, nullptr))
                                          : Json());
            contacts.push_back(is_down ? contacts_of(rest) : Json::array());
        });
    return {{"file", spawns.file},  {"columns", csv_fields(table.header)},
            {"rows", rows},         {"poses", poses},
            {"verdicts", verdicts}, {"hits", hits},
            {"reasons", reasons},   {"tilt", tilt},
            {"margin", margin},     {"clearance", clearances},
            {"contacts", contacts}};
}

Json pairs_for_page(const Judge& judge, const ReachGraph& graph, const ReviewPairs& pairs, const RunOptions& options)
{
    PairOptions judged_by = pairs.options;
    judged_by.spawns.threads = options.threads;
    judged_by.spawns.progress = options.progress;
    const std::vector<JudgedPair> judged = judge_pairs(judge, graph, pairs.table.starts.poses, pairs.table.goals.poses,
                                                       judged_by);
    const PairReport report{pairs.table, judged, judge, judged_by};
    const std::vector<std::string> names = row_names(pairs.table.starts, "pair");
    const double lift = judge.options().stand.lift;
    PathSearch search(graph);
    Json list = Json::array();
    for (std::size_t i = 0; i < judged.size(); ++i) {
        const JudgedPair& pair = judged[i];
        Json path = Json::array();
        if (const auto found = pair.path_length ? search.path(pair.start, pair.goal) : std::nullopt)
            for (const SettledPose& pose : found->poses)
                path.push_back({pose.position.x(), pose.position.y(), pose.position.z() + lift});
        const bool is_valid = pair.verdict == PairVerdict::Valid;
        list.push_back({{"name", names[i]},
                        {"start", rest_numbers(pair.start, lift)},
                        {"goal", rest_numbers(pair.goal, lift)},
                        {"verdict", to_string(verdict_of(pair))},
                        {"pair_verdict", to_string(pair.verdict)},
                        {"reason", is_valid ? "" : reason(report, i)},
                        {"path", path}});
    }
    return {{"file", pairs.file}, {"pairs", list}};
}

}  // namespace spawnfield

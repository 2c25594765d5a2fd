#include "poses/judged_pose.h"

#include "base/csv.h"
#include "base/number.h"
#include "settle/friction.h"

#include <spawnfield/frames.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace spawnfield {
namespace {

/// Returns how high the robot's origin is above its ground, m: at the pose, or where it rests. Nothing if it has no
/// ground, or no room to rest.
std::optional<double> height_above(const JudgedPose& judged)
{
    const std::optional<Ground>& ground = judged.judgement.ground;
    if (!ground) return std::nullopt;
    if (judged.settled == nullptr) return judged.pose.position.z() - ground->height;
    return judged.settled->has_pose ? std::optional(judged.settled->position.z() - ground->height) : std::nullopt;
}

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Returns how a robot rests; null if it was not let down or has no room.
Json settled_json(const Judge& judge, const SettledPose& pose)
{
    if (!pose.has_pose) return {};
    Json out = pose_json({{}, {}, pose.position, {pose.roll, pose.pitch, pose.yaw}});
    out["tilt"] = pose.tilt;
    out["margin"] = pose.margin;
    out["tip_over"] = pose.tip_over;
    out["belly"] = pose.belly;
    if (pose.slides)  // infinite: null
        out["friction_needed"] = friction_needed(pose.contacts, mass_center_at(pose, mass_center_of(judge.robot())),
                                                 judge.options().stand.friction);
    out["contacts"] = Json::array();
    for (const RestContact& contact : pose.contacts)
        out["contacts"].push_back({{"point", vector_json(contact.point)},
                                   {"normal", vector_json(contact.normal)},
                                   {"part", part_name(judge.robot(), contact.part)},
                                   {"ground", judge.map().geometry.parts()[contact.ground].name}});
    return out;
}

}  // namespace

std::string reason_of(const JudgedPose& judged)
{
    return judged.settled != nullptr ? judged.judge.describe(*judged.settled)
                                     : judged.judge.describe(judged.pose, judged.judgement);
}

void add_verdict(Json& out, const JudgedPose& judged)
{
    const Judgement& judgement = judged.judgement;
    out["verdict"] = to_string(judgement.verdict);
    out["ground"] = judgement.ground ? Json(judgement.ground->height) : Json();
    const std::optional<double> above = height_above(judged);
    out["height_above"] = above ? Json(*above) : Json();
    out["hit"] = judgement.hit ? Json(name_of(*judgement.hit, judged.judge.map())) : Json();
    if (judged.settled == nullptr) return;
    out["reason"] = judgement.verdict == Verdict::Valid ? Json() : Json(reason_of(judged));
    out["settled"] = settled_json(judged.judge, *judged.settled);
}

std::string verdict_lines(const JudgedPose& judged)
{
    const std::optional<Ground>& ground = judged.judgement.ground;
    const Rpy rpy = rpy_from(judged.pose.rotation);
    std::string text = "position " + listed(judged.pose.position) + " m; roll, pitch, yaw " +
                       listed({rpy.roll, rpy.pitch, rpy.yaw}) + " rad\n";
    text += ground ? "ground at " + rounded(ground->height) + " m" : "no ground below the origin";
    if (const auto above = height_above(judged))
        text += ", " + rounded(std::abs(*above)) + (*above < 0 ? " m above the origin" : " m below the origin");
    text += "\n";
    const std::optional<CollisionHit>& hit = judged.judgement.hit;
    return hit ? text + "hit " + xml_text(name_of(*hit, judged.judge.map())) + "\n" : text;
}

std::string listed(const Vec3& values)
{
    return rounded(values.x()) + ", " + rounded(values.y()) + ", " + rounded(values.z());
}

Json judge_settings_json(const Judge& judge, bool settled)
{
    const JudgeOptions& options = judge.options();
    Json out = {{"max_height", options.max_height}};
    if (std::isfinite(options.max_water_depth)) out["max_water_depth"] = options.max_water_depth;
    if (settled)
        add_stand_limits(out, options.stand);
    else if (std::isfinite(options.max_slope))
        out["max_slope"] = options.max_slope;
    out["collision"] = options.obstacles == Obstacles::Voxels ? "octree" : "geometry";
    return out;
}

std::vector<std::pair<std::string, std::string>> junit_properties(const Judge& judge, const Json& settings)
{
    std::vector<std::pair<std::string, std::string>> out{
        {"version", version()}, {"map", judge.map().name}, {"map_hash", judge.map().hash}};
    for (const std::string& change : judge.map().changes) out.emplace_back("map_change", change);
    out.emplace_back("robot", robot_name(judge.robot()));
    for (const auto& [name, value] : settings.items())
        out.emplace_back(name, value.is_string() ? value.get<std::string>() : json_text(value, -1));
    return out;
}

std::string robot_name(const Robot& robot) { return robot.name.empty() ? "robot" : robot.name; }

std::vector<std::string> row_names(const PoseTable& table, const std::string& noun, std::size_t first)
{
    std::vector<std::string> names = column_of(table, "name");
    names.resize(table.poses.size());
    std::map<std::string, int> uses;
    const auto numbered = [&](std::size_t row) { return noun + " " + std::to_string(first + row + 1); };
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) names[i] = numbered(i);
        ++uses[names[i]];
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        if (uses[names[i]] > 1) names[i] += " (" + numbered(i) + ")";
    return names;
}

Json fields_json(const PoseTable& table, std::size_t row, const std::vector<std::string>& replaced)
{
    const std::vector<std::string> columns = csv_fields(table.header), fields = csv_fields(table.rows[row]);
    Json out = Json::object();
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (std::count(replaced.begin(), replaced.end(), columns[i]) == 0) out[columns[i]] = fields[i];
    return out;
}

void write_json_rows(const Json& head, const std::string& key, std::size_t rows,
                     const std::function<Json(std::size_t)>& row, const TextSink& sink)
{
    std::string text = json_text(head, 2);
    text.erase(text.rfind("\n}"));
    text += ",\n  " + json_text(key, -1) + ": [";
    for (std::size_t i = 0; i < rows; ++i) {
        text += i == 0 ? "\n    " : ",\n    ";
        text += json_text(row(i), -1);
        if (text.size() < text_piece) continue;
        sink(text);
        text.clear();
    }
    sink(text + "\n  ]\n}\n");
}

}  // namespace spawnfield

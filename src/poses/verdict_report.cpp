#include "base/csv.h"
#include "base/number.h"
#include "base/text.h"
#include "poses/pose_json.h"
#include "settle/friction.h"

#include <spawnfield/frames.h>
#include <spawnfield/verdict_report.h>

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace spawnfield {
namespace {

using Sink = std::function<void(std::string_view)>;
constexpr std::size_t piece = 1 << 20;  // bytes

std::string listed(const Vec3& values)
{
    return rounded(values.x()) + ", " + rounded(values.y()) + ", " + rounded(values.z());
}

/// Returns how high the robot's origin is above its ground, m: at the pose, or where it rests. Nothing if it has no
/// ground, or no room to rest.
std::optional<double> height_above(const VerdictReport& report, std::size_t index)
{
    const std::optional<Ground>& ground = report.judgements[index].ground;
    if (!ground) return std::nullopt;
    if (report.settled == nullptr) return report.table.poses[index].position.z() - ground->height;
    const SettledPose& settled = (*report.settled)[index];
    return settled.has_pose ? std::optional(settled.position.z() - ground->height) : std::nullopt;
}

VerdictCounts counts_of(const VerdictReport& report)
{
    VerdictCounts counts;
    for (const Judgement& judged : report.judgements) ++counts[judged.verdict];
    return counts;
}

Json settings_json(const VerdictReport& report)
{
    const JudgeOptions& options = report.judge.options();
    Json out = {{"max_height", options.max_height}};
    if (std::isfinite(options.max_water_depth)) out["max_water_depth"] = options.max_water_depth;
    if (report.settled != nullptr)
        add_stand_limits(out, options.stand);
    else if (std::isfinite(options.max_slope))
        out["max_slope"] = options.max_slope;
    out["collision"] = options.obstacles == Obstacles::Voxels ? "octree" : "geometry";
    if (report.repairs != nullptr) {
        const RepairOptions& search = report.repairs->options;
        out["repair"] = {{"radius", search.radius}, {"step", *search.step}, {"headings", search.headings}};
    }
    return out;
}

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Returns how a robot rests; null if it was not let down or has no room.
Json settled_json(const VerdictReport& report, const SettledPose& pose)
{
    if (!pose.has_pose) return {};
    Json out = pose_json({{}, {}, pose.position, {pose.roll, pose.pitch, pose.yaw}});
    out["tilt"] = pose.tilt;
    out["margin"] = pose.margin;
    out["tip_over"] = pose.tip_over;
    out["belly"] = pose.belly;
    if (pose.slides)  // infinite: null
        out["friction_needed"] = friction_needed(pose.contacts,
                                                 mass_center_at(pose, mass_center_of(report.judge.robot())),
                                                 report.judge.options().stand.friction);
    out["contacts"] = Json::array();
    for (const RestContact& contact : pose.contacts)
        out["contacts"].push_back({{"point", vector_json(contact.point)},
                                   {"normal", vector_json(contact.normal)},
                                   {"part", part_name(report.judge.robot(), contact.part)},
                                   {"ground", report.judge.map().geometry.parts()[contact.ground].name}});
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

/// Returns the fields of a row by the names of their columns, without those that the new verdict replaces.
Json fields_json(const VerdictReport& report, std::size_t index, const std::vector<std::string>& columns)
{
    const std::vector<std::string> fields = csv_fields(report.table.rows[index]);
    const std::vector<std::string> replaced = replaced_columns(report.table, report.settled != nullptr,
                                                               report.repairs != nullptr);
    Json out = Json::object();
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (std::count(replaced.begin(), replaced.end(), columns[i]) == 0) out[columns[i]] = fields[i];
    return out;
}

Json verdict_json(const VerdictReport& report, std::size_t index, const std::string& name,
                  const std::vector<std::string>& columns)
{
    const Judgement& judged = report.judgements[index];
    const Pose& pose = report.table.poses[index];
    Json out = {{"row", index + 1}};
    out.update(pose_json({name, {}, pose.position, rpy_from(pose.rotation)}));
    out["verdict"] = to_string(judged.verdict);
    out["ground"] = judged.ground ? Json(judged.ground->height) : Json();
    const std::optional<double> above = height_above(report, index);
    out["height_above"] = above ? Json(*above) : Json();
    out["hit"] = judged.hit ? Json(name_of(*judged.hit, report.judge.map())) : Json();
    if (report.settled != nullptr) {
        out["reason"] = judged.verdict == Verdict::Valid ? Json() : Json(reason(report, index));
        out["settled"] = settled_json(report, (*report.settled)[index]);
    }
    if (report.repairs != nullptr) out["repair"] = repair_json(report.repairs->repairs[index]);
    out["columns"] = fields_json(report, index, columns);
    return out;
}

/// Returns a text that XML can contain on one line: valid UTF-8 without control characters.
std::string xml_text(const std::string& text)
{
    // json_text replaces bytes that are not valid UTF-8.
    std::string out = one_line(Json::parse(json_text(text, -1)).get<std::string>());
    for (const char* const forbidden : {"\xEF\xBF\xBE", "\xEF\xBF\xBF"})  // U+FFFE, U+FFFF
        for (std::size_t place = out.find(forbidden); place != std::string::npos; place = out.find(forbidden, place))
            out.replace(place, 3, "\xEF\xBF\xBD");
    return out;
}

/// Writes a JUnit report. Passes the XML to the sink in pieces, so that only one piece is in memory.
class JunitWriter {
public:
    JunitWriter(const VerdictReport& report, const Sink& sink) : report_(report), sink_(sink) {}

    void write()
    {
        printer_.PushDeclaration("xml version=\"1.0\" encoding=\"UTF-8\"");
        printer_.OpenElement("testsuites");
        push_counts("spawnfield check");
        printer_.OpenElement("testsuite");
        push_counts("spawnfield check " + report_.judge.map().name);
        push("skipped", "0");
        push_properties();
        const std::vector<std::string> names = pose_names(report_.table);
        for (std::size_t i = 0; i < names.size(); ++i) {
            push_case(i, names[i]);
            if (std::size_t(printer_.CStrSize()) > piece) flush();
        }
        printer_.CloseElement();
        printer_.CloseElement();
        flush();
    }

private:
    void push(const char* name, const std::string& value) { printer_.PushAttribute(name, xml_text(value).c_str()); }

    /// Adds the name and the counts. Some readers need a time; it is 0, because a measured time would differ from run
    /// to run.
    void push_counts(const std::string& name)
    {
        const std::uint64_t valid = counts_of(report_)[Verdict::Valid], all = report_.judgements.size();
        push("name", name);
        push("tests", std::to_string(all));
        push("failures", std::to_string(all - valid));
        push("errors", "0");
        push("time", "0");
    }

    void push_property(const std::string& name, const std::string& value)
    {
        printer_.OpenElement("property");
        push("name", name);
        push("value", value);
        printer_.CloseElement();
    }

    void push_properties()
    {
        printer_.OpenElement("properties");
        push_property("version", version());
        push_property("map", report_.judge.map().name);
        push_property("map_hash", report_.judge.map().hash);
        for (const std::string& change : report_.judge.map().changes) push_property("map_change", change);
        push_property("robot", robot_name());
        const Json settings = settings_json(report_);
        for (const auto& [name, value] : settings.items())
            push_property(name, value.is_string() ? value.get<std::string>() : json_text(value, -1));
        printer_.CloseElement();
    }

    void push_case(std::size_t index, const std::string& name)
    {
        const Verdict verdict = report_.judgements[index].verdict;
        printer_.OpenElement("testcase");
        push("classname", report_.judge.map().name + "." + robot_name());
        push("name", name);
        push("time", "0");
        if (verdict != Verdict::Valid) {
            printer_.OpenElement("failure");
            push("type", to_string(verdict));
            push("message", reason(report_, index));
            printer_.PushText(details(index).c_str());
            printer_.CloseElement();
        }
        printer_.CloseElement();
    }

    std::string details(std::size_t index) const
    {
        const Judgement& judged = report_.judgements[index];
        const Pose& pose = report_.table.poses[index];
        const Vec3& p = pose.position;
        const Rpy rpy = rpy_from(pose.rotation);
        std::string text = "row " + std::to_string(index + 1) + ": " + xml_text(report_.table.rows[index]) + "\n";
        text += "position " + listed({p.x(), p.y(), p.z()}) + " m; ";
        text += "roll, pitch, yaw " + listed({rpy.roll, rpy.pitch, rpy.yaw}) + " rad\n";
        text += judged.ground ? "ground at " + rounded(judged.ground->height) + " m" : "no ground below the origin";
        if (const auto above = height_above(report_, index))
            text += ", " + rounded(std::abs(*above)) + (*above < 0 ? " m above the origin" : " m below the origin");
        text += "\n";
        if (judged.hit) text += "hit " + xml_text(name_of(*judged.hit, report_.judge.map())) + "\n";
        if (report_.repairs != nullptr && report_.repairs->repairs[index])
            text += repair_words(*report_.repairs->repairs[index], report_.repairs->options) + "\n";
        return text;
    }

    /// Returns the robot's name, or "robot" if it has none.
    std::string robot_name() const
    {
        const std::string& name = report_.judge.robot().name;
        return name.empty() ? "robot" : name;
    }

    void flush()
    {
        sink_(printer_.CStr());
        printer_.ClearBuffer(false);
    }

    const VerdictReport& report_;
    const Sink& sink_;
    tinyxml2::XMLPrinter printer_;
};

}  // namespace

std::vector<std::string> pose_names(const PoseTable& table)
{
    std::vector<std::string> names = column_of(table, "name");
    names.resize(table.poses.size());
    std::map<std::string, int> uses;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) names[i] = "pose " + std::to_string(i + 1);
        ++uses[names[i]];
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        if (uses[names[i]] > 1) names[i] += " (pose " + std::to_string(i + 1) + ")";
    return names;
}

std::string reason(const VerdictReport& report, std::size_t index)
{
    return report.settled != nullptr ? report.judge.describe((*report.settled)[index])
                                     : report.judge.describe(report.table.poses[index], report.judgements[index]);
}

bool remains_invalid(const VerdictReport& report, std::size_t index)
{
    if (report.repairs == nullptr) return report.judgements[index].verdict != Verdict::Valid;
    const std::optional<Repair>& repair = report.repairs->repairs[index];
    return repair && !repair->pose;
}

void write_verdicts_json(const VerdictReport& report, const Sink& sink)
{
    Json head = json_head("check", report.judge.map(), report.judge.robot(), settings_json(report),
                          "spawnfield-verdicts/1");
    const VerdictCounts counts = counts_of(report);
    for (const Verdict verdict : all_verdicts) head["counts"][to_string(verdict)] = counts[verdict];
    std::string text = json_text(head, 2);
    text.erase(text.rfind("\n}"));
    text += ",\n  \"poses\": [";
    const std::vector<std::string> names = column_of(report.table, "name"), columns = csv_fields(report.table.header);
    for (std::size_t i = 0; i < report.judgements.size(); ++i) {
        text += i == 0 ? "\n    " : ",\n    ";
        text += json_text(verdict_json(report, i, names.empty() ? "" : names[i], columns), -1);
        if (text.size() < piece) continue;
        sink(text);
        text.clear();
    }
    sink(text + "\n  ]\n}\n");
}

void write_verdicts_junit(const VerdictReport& report, const Sink& sink) { JunitWriter(report, sink).write(); }

}  // namespace spawnfield

#include "audit/audit_pictures.h"
#include "audit/audit_words.h"
#include "base/base64.h"
#include "base/csv.h"
#include "base/number.h"
#include "base/text.h"
#include "poses/judged_pose.h"
#include "review/page_shell.h"

#include <spawnfield/review.h>

#include <algorithm>

namespace spawnfield {
namespace {

using Row = std::vector<std::string>;

/// Returns a text for HTML: valid UTF-8 on one line, with special characters escaped.
std::string html(const std::string& text) { return xml_escaped(xml_text(text)); }

/// The report loads nothing, and has no scripts besides that of the review page, also if a name in it were not escaped.
std::string policy()
{
    return has_review_page() ? std::string(page_policy())
                             : "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
}

const char* const style =
    "<style>\n"
    "body { font-family: sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #1c1c1c; }\n"
    "table { border-collapse: collapse; margin: 0.5rem 0 1.5rem; }\n"
    "th, td { border: 1px solid #c4c4c4; padding: 0.3rem 0.6rem; text-align: left; vertical-align: top; }\n"
    "th { background: #efefef; }\n"
    ".broken { background: #fbe3d6; }\n"
    "img { max-width: 100%; }\n"
    "iframe { width: 100%; height: 40rem; border: 1px solid #c4c4c4; }\n"
    "</style>\n";

/// Returns a table. Rows of `marked` have the colour of broken rules.
std::string table(const Row& head, const std::vector<Row>& rows, const std::vector<bool>& marked = {})
{
    std::string out = "<table>\n<tr>";
    for (const std::string& cell : head) out += "<th>" + html(cell) + "</th>";
    out += "</tr>\n";
    for (std::size_t i = 0; i < rows.size(); ++i) {
        out += i < marked.size() && marked[i] ? "<tr class=\"broken\">" : "<tr>";
        for (const std::string& cell : rows[i]) out += "<td>" + html(cell) + "</td>";
        out += "</tr>\n";
    }
    return out + "</table>\n";
}

std::string heading(int level, const std::string& text)
{
    const std::string tag = "h" + std::to_string(level);
    return "<" + tag + ">" + html(text) + "</" + tag + ">\n";
}

std::string picture(const std::string& png, const std::string& words)
{
    return "<p><img alt=\"" + html(words) + "\" src=\"data:image/png;base64," + base64(png) + "\"></p>\n";
}

/// Returns the review page of a robot in a frame, which a browser reads only when it is shown.
std::string review_frame(const AuditReport& report, const RobotAudit& robot, int threads)
{
    constexpr std::size_t most_triangles = 200000;
    if (!has_review_page()) return "";
    ReviewContents contents;
    contents.rasters = {robot.raster};
    contents.graph = robot.graph;
    contents.floors = floors_of(report.map);
    contents.most_triangles = most_triangles;
    PoseTable starts{.header = "name", .rows = {}, .poses = {}, .notices = {}};
    for (const NamedPose& pose : report.poses) {
        starts.rows.push_back(csv_quoted(pose.name));
        starts.poses.push_back(pose.pose);
    }
    if (!starts.poses.empty()) contents.spawns = {{"start poses", std::move(starts)}};
    std::string page;
    write_review(robot.judge, contents, [&](std::string_view piece) { page += piece; }, {.threads = threads});
    const std::string name = robot_name(robot.judge.robot());
    return "<details>\n<summary>" + html("The world, and where " + name + " can stand, in 3D") +
           "</summary>\n<iframe loading=\"lazy\" title=\"" + html("Review of " + name) + "\" srcdoc=\"" +
           xml_escaped(page) + "\"></iframe>\n</details>\n";
}

std::string rules_table(const std::vector<RuleResult>& rules)
{
    if (rules.empty()) return "<p>No rules were given.</p>\n";
    std::vector<Row> rows;
    std::vector<bool> broken;
    for (const RuleResult& result : rules) {
        rows.push_back({result.rule, result.is_kept ? "kept" : "broken", result.words});
        broken.push_back(!result.is_kept);
    }
    return table({"Rule", "Result", "Value and limit"}, rows, broken);
}

std::string robots_table(const AuditReport& report)
{
    std::vector<Row> rows;
    for (const RobotAudit& robot : report.robots) {
        const auto islands = robot.graph.islands();
        rows.push_back({robot_name(robot.judge.robot()), area_words(robot.free_area, robot.free_share),
                        std::to_string(islands.size()),
                        islands.empty() ? "none" : area_words(islands[0].area, islands[0].share),
                        std::to_string(robot.closed_rooms.size()),
                        std::to_string(report.poses.size() - robot.bad_poses.size()) + " of " +
                            std::to_string(report.poses.size())});
    }
    return table({"Robot", "Free area", "Islands", "Largest island", "Closed rooms", "Valid start poses"}, rows);
}

std::string findings_part(const AuditReport& report)
{
    std::string out;
    for (const FindingClass& found : finding_classes(report)) {
        out += heading(3, found.title);
        if (found.key == "missing" && !report.missing) {
            out += "<p>Not known: a map folder does not say what was missing.</p>\n";
            continue;
        }
        std::vector<Row> rows;
        for (const AuditFinding& finding : found.findings) rows.push_back({finding.name, finding.words});
        out += rows.empty() ? "<p>None.</p>\n" : table({"What", "Finding"}, rows);
    }
    const std::string undecided = undecided_words(report);
    return undecided.empty() ? out : out + "<p>" + html(undecided) + ".</p>\n";
}

std::string robot_part(const AuditReport& report, const RobotAudit& robot, const AuditPictures& pictures)
{
    const std::string name = robot_name(robot.judge.robot());
    std::string out = heading(2, name);
    std::vector<Row> rows;
    for (const BadPose& bad : robot.bad_poses)
        rows.push_back({report.poses[bad.pose].name, to_string(bad.verdict), bad.culprit, words_of(bad)});
    if (!rows.empty())
        out += heading(3, "Start poses that are not valid") + table({"Pose", "Verdict", "Culprit", "Reason"}, rows);
    rows.clear();
    for (const ClosedRoom& room : robot.closed_rooms) rows.push_back({std::to_string(room.island), words_of(room)});
    if (!rows.empty()) out += heading(3, "Closed rooms") + table({"Island", "Area and place"}, rows);
    return out + picture(pictures.heatmap, "Where " + name + " can stand") +
           picture(pictures.islands, "Islands of " + name);
}

}  // namespace

void write_audit_html(const AuditReport& report, const std::function<void(std::string_view)>& sink, int threads)
{
    const std::string title = "Audit of " + report.map.name;
    const std::string head =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
        "http-equiv=\"Content-Security-Policy\" content=\"" +
        policy() + "\">\n" + style + "<title>" + html(title) + "</title>\n</head>\n<body>\n" + heading(1, title) +
        "<p>spawnfield " + html(version()) + ", " + html(counted_things(report.parts.props, "prop")) + "</p>\n";
    sink(head + heading(2, "Rules") + rules_table(report.rules) + heading(2, "Robots") + robots_table(report) +
         heading(2, "Findings") + findings_part(report));
    for (const RobotAudit& robot : report.robots) {
        sink(robot_part(report, robot, draw_audit(report, robot, threads)));
        sink(review_frame(report, robot, threads));
    }
    sink("</body>\n</html>\n");
}

}  // namespace spawnfield

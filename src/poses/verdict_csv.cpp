#include "base/csv.h"
#include "base/number.h"
#include "poses/pose_columns.h"
#include "poses/pose_json.h"

#include <spawnfield/verdict_report.h>

#include <cmath>
#include <limits>

namespace spawnfield {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Appends the repair of a pose, each field after a comma. Nothing: the pose is valid.
void append_repair(std::string& text, const std::optional<Repair>& repair)
{
    if (!repair) {
        text.append(repair_columns.size(), ',');
        return;
    }
    if (repair->pose) {
        const Spawn& to = *repair->pose;
        text += repair->turn == 0 ? ",moved," : ",turned,";
        append_numbers(
            text, {repair->distance, to.position.x(), to.position.y(), to.position.z(), to.roll, to.pitch, to.yaw});
    } else {
        text += ",none";
        text.append(repair_columns.size() - 2, ',');
    }
    (text += ',') += std::to_string(repair->tried);
}

/// How a table is written: which part of the file it is, and by how many threads.
struct TablePart {
    const std::function<void(std::string_view)>& sink;
    bool has_header = true;
    int threads = 1;
};

/// Writes the table with the columns that append(text, index) writes, and the repairs if they are given.
template <class Append>
void write_table(const PoseTable& table, bool settled, const RepairList* repairs, const TablePart& part,
                 const Append& append)
{
    std::vector<std::string> names = verdict_columns;
    if (settled) names.insert(names.end(), settled_columns.begin(), settled_columns.end());
    if (repairs != nullptr) names.insert(names.end(), repair_columns.begin(), repair_columns.end());
    write_with_columns(table, names, part.has_header, part.threads, part.sink, [&](std::string& text, std::size_t i) {
        append(text, i);
        if (repairs != nullptr) append_repair(text, repairs->repairs[i]);
    });
}

/// Appends verdict,ground,height_above,hit.
void append_verdict(std::string& text, const Judgement& judged, const Map& map, double height_above)
{
    text += to_string(judged.verdict);
    text += ',';
    if (judged.ground) append_number(text, judged.ground->height);
    text += ',';
    if (!std::isnan(height_above)) append_number(text, height_above);
    text += ',';
    if (judged.hit) text += csv_quoted(name_of(*judged.hit, map));
}

/// Returns "x y z PART on GROUND; …".
std::string contacts_text(const SettledPose& pose, const Map& map, const Robot& robot)
{
    std::string text;
    for (const RestContact& contact : pose.contacts) {
        if (!text.empty()) text += "; ";
        for (int axis = 0; axis < 3; ++axis) (text += number(contact.point[axis])) += ' ';
        text += part_name(robot, contact.part) + " on " + map.geometry.parts()[contact.ground].name;
    }
    return text;
}

void write_level(const PoseTable& table, const std::vector<Judgement>& judgements, const Map& map,
                 const RepairList* repairs, const TablePart& part)
{
    write_table(table, false, repairs, part, [&](std::string& text, std::size_t i) {
        const Judgement& judged = judgements[i];
        append_verdict(text, judged, map,
                       judged.ground ? table.poses[i].position.z() - judged.ground->height : no_number);
    });
}

void write_settled(const PoseTable& table, const std::vector<SettledPose>& poses, const Judge& judge,
                   const RepairList* repairs, const TablePart& part)
{
    write_table(table, true, repairs, part, [&](std::string& text, std::size_t i) {
        const SettledPose& pose = poses[i];
        append_verdict(text, judgement_of(pose), judge.map(),
                       pose.has_pose ? pose.position.z() - pose.ground->height : no_number);
        text += ',';
        if (pose.has_pose) {
            append_numbers(text, {pose.position.z(), pose.roll, pose.pitch, pose.tilt, pose.margin});
            text += ',' + csv_quoted(contacts_text(pose, judge.map(), judge.robot())) + ',';
            append_numbers(text, {pose.tip_over, pose.belly});
        } else {
            text.append(settled_columns.size() - 2, ',');  // all but `reason` are empty
        }
        text += ',';
        if (pose.verdict != Verdict::Valid) text += csv_quoted(judge.describe(pose));
    });
}

}  // namespace

void write_verdicts_csv(const VerdictReport& report, const std::function<void(std::string_view)>& sink, int threads)
{
    const TablePart part{sink, report.first == 0, threads};
    if (report.settled != nullptr)
        write_settled(report.table, *report.settled, report.judge, report.repairs, part);
    else
        write_level(report.table, report.judgements, report.judge.map(), report.repairs, part);
}

std::string verdicts_csv(const PoseTable& table, const std::vector<Judgement>& judgements, const Map& map,
                         const RepairList* repairs)
{
    std::string out;
    write_level(table, judgements, map, repairs, {[&](std::string_view text) { out += text; }});
    return out;
}

std::string settled_csv(const PoseTable& table, const std::vector<SettledPose>& poses, const Judge& judge,
                        const RepairList* repairs)
{
    std::string out;
    write_settled(table, poses, judge, repairs, {[&](std::string_view text) { out += text; }});
    return out;
}

}  // namespace spawnfield

#include "base/csv.h"
#include "base/number.h"
#include "poses/pose_columns.h"

#include <spawnfield/frames.h>
#include <spawnfield/poses.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace spawnfield {
namespace {

constexpr double rounding = 1e-12;  // m, rad, degrees: a number that changes by less keeps its text

/// The numbers of a pose by the names of their columns.
class PoseNumbers {
public:
    explicit PoseNumbers(const Spawn& pose)
        : pose_(pose), quaternion_(quaternion_from({pose.roll, pose.pitch, pose.yaw}))
    {
    }

    /// `name` must be the name of a column of a pose (is_pose_column()).
    double operator[](std::string_view name) const
    {
        if (name == "x") return pose_.position.x();
        if (name == "y") return pose_.position.y();
        if (name == "z") return pose_.position.z();
        if (name == "qx") return quaternion_.x();
        if (name == "qy") return quaternion_.y();
        if (name == "qz") return quaternion_.z();
        if (name == "qw") return quaternion_.w();
        const bool is_degrees = name.ends_with("_deg");
        if (is_degrees) name.remove_suffix(4);
        const double angle = name == "roll" ? pose_.roll : name == "pitch" ? pose_.pitch : pose_.yaw;
        return is_degrees ? angle * 180 / std::numbers::pi : angle;
    }

private:
    const Spawn& pose_;
    Eigen::Quaterniond quaternion_;
};

bool has_name(const std::vector<std::string>& names, const std::string& name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns the columns of angles that a table does not have, but repairs need.
std::vector<std::string> missing_columns(const std::vector<std::string>& names, const RepairList& repairs)
{
    if (has_name(names, "qw")) return {};
    const bool is_degrees = std::any_of(names.begin(), names.end(), [](const std::string& name) {
        return is_pose_column(name) && name.ends_with("_deg");
    });
    std::vector<std::string> out;
    for (const std::string angle : {"roll", "pitch", "yaw"}) {
        if (has_name(names, angle) || has_name(names, angle + "_deg")) continue;
        const bool is_needed = std::any_of(repairs.repairs.begin(), repairs.repairs.end(), [&](const auto& repair) {
            return repair && repair->pose && std::abs(PoseNumbers(*repair->pose)[angle]) > rounding;
        });
        if (is_needed) out.push_back(is_degrees ? angle + "_deg" : angle);
    }
    return out;
}

/// Returns the value after which the numbers of a column mean the same again: a whole turn for angles, 0 for others.
double period_of(const std::string& name)
{
    if (name.ends_with("_deg")) return 360;
    return name == "roll" || name == "pitch" || name == "yaw" ? 2 * std::numbers::pi : 0;
}

/// Returns the text of a number in place of `old`, which stays if it means the same.
std::string new_text(std::string_view old, double value, double period)
{
    double before = 0;
    if (!parse_number(csv_fields(old)[0], before)) return number(value);
    const double change = period > 0 ? std::remainder(before - value, period) : before - value;
    return std::abs(change) <= rounding ? std::string(old) : number(value);
}

/// Writes a table with its repairs. Each field is followed by a comma, and the last comma of a line becomes its end.
class RepairedTable {
public:
    RepairedTable(const PoseTable& table, const RepairList& repairs)
        : table_(table), repairs_(repairs), names_(csv_fields(table.header)), added_(missing_columns(names_, repairs))
    {
        const bool is_settled = repairs.options.stance == Stance::Settled;
        for (const std::string& name : names_) is_kept_.push_back(!is_verdict_column(name, is_settled, true));
    }

    std::string csv() const
    {
        std::string text;
        append_kept(text, table_.header, [](std::size_t, std::string_view field) { return std::string(field); });
        for (const std::string& name : added_) (text += name) += ',';
        text.back() = '\n';
        for (std::size_t i = 0; i < table_.rows.size(); ++i) append_row(text, i);
        return text;
    }

private:
    /// Appends written(column, field) for each field of a line that is kept.
    template <class Written>
    void append_kept(std::string& text, const std::string& line, const Written& written) const
    {
        const std::vector<std::string_view> fields = raw_csv_fields(line);
        for (std::size_t column = 0; column < fields.size(); ++column)
            if (is_kept_[column] != 0) (text += written(column, fields[column])) += ',';
    }

    void append_row(std::string& text, std::size_t index) const
    {
        const std::optional<Repair>& repair = repairs_.repairs[index];
        const Spawn pose = repair && repair->pose ? *repair->pose : Spawn{};
        const bool is_repaired = repair && repair->pose;
        const PoseNumbers numbers(pose);
        const bool keeps_rotation = is_repaired && has_rotation(pose, table_.poses[index].rotation);
        append_kept(text, table_.rows[index], [&](std::size_t column, std::string_view field) {
            const std::string& name = names_[column];
            const bool stays = !is_repaired || !is_pose_column(name) || (name.starts_with('q') && keeps_rotation);
            return stays ? std::string(field) : new_text(field, numbers[name], period_of(name));
        });
        for (const std::string& name : added_) (text += number(numbers[name])) += ',';
        text.back() = '\n';
    }

    static bool has_rotation(const Spawn& pose, const Mat3& rotation)
    {
        return (rotation - rotation_from_rpy(pose.roll, pose.pitch, pose.yaw)).norm() <= rounding;
    }

    const PoseTable& table_;
    const RepairList& repairs_;
    const std::vector<std::string> names_, added_;
    std::vector<std::uint8_t> is_kept_;  ///< of each column: not about the old verdict
};

}  // namespace

std::string repaired_csv(const PoseTable& table, const RepairList& repairs)
{
    return RepairedTable(table, repairs).csv();
}

}  // namespace spawnfield

#include "poses/pose_rows.h"

#include "base/csv.h"
#include "base/number.h"
#include "base/text.h"
#include "poses/pose_columns.h"

#include <spawnfield/error.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;
constexpr std::array position_names{"x", "y", "z"}, angle_names{"roll", "pitch", "yaw"};
constexpr std::array quaternion_names{"qx", "qy", "qz", "qw"};

/// Returns "roll_deg,pitch_deg" for "roll_deg pitch_deg", with the prefix before each name.
std::string with_prefix(const std::string& prefix, const std::string& names)
{
    std::string out = prefix + names;
    for (std::size_t at = 0; (at = out.find(' ', at)) != std::string::npos;) out.replace(at, 1, "," + prefix);
    return out;
}

/// Returns the header that a row with this number of fields most likely needs.
std::string likely_header(std::size_t fields)
{
    if (fields == 3) return "x,y,z";
    if (fields == 4) return "x,y,z,yaw (or yaw_deg)";
    return fields == 7 ? "x,y,z,qx,qy,qz,qw" : "x,y,z,roll,pitch,yaw (or roll_deg,pitch_deg,yaw_deg)";
}

/// Returns whether a column with this name is likely a yaw that is not read: theta, heading or yaw, alone or with a
/// unit, for example heading_deg or "theta (rad)".
bool is_other_yaw_name(const std::string& lower)
{
    for (const std::string word : {"theta", "heading", "yaw"}) {
        if (!lower.starts_with(word)) continue;
        std::string unit = lower.substr(word.size());
        std::erase_if(unit, [](char c) { return std::string_view(" _-.()[]").find(c) != std::string_view::npos; });
        constexpr std::array<std::string_view, 7> units{"", "deg", "degree", "degrees", "rad", "radian", "radians"};
        return std::find(units.begin(), units.end(), unit) != units.end();
    }
    return false;
}

/// The fields of a row, without quotes and the spaces around them. Most rows have no quotes; their fields refer to the
/// row, because copies would take most of the time.
class RowFields {
public:
    explicit RowFields(std::string_view row)
    {
        if (row.find('"') == std::string_view::npos) {
            fields_ = raw_csv_fields(row);
            for (std::string_view& field : fields_) field = trimmed_view(field);
            return;
        }
        owned_ = csv_fields(row);
        fields_.assign(owned_.begin(), owned_.end());
    }
    std::size_t size() const { return fields_.size(); }
    std::string_view operator[](int field) const { return fields_[std::size_t(field)]; }

private:
    std::vector<std::string_view> fields_;
    std::vector<std::string> owned_;
};

}  // namespace

void BeyondTurn::add(const BeyondTurn& later)
{
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (angles[i].rows == 0) angles[i].first = later.angles[i].first;
        angles[i].rows += later.angles[i].rows;
    }
}

PoseRows::PoseRows(std::string file, std::string prefix, std::string_view header, std::uint64_t line)
    : file_(std::move(file)), prefix_(std::move(prefix)), names_(csv_fields(header))
{
    if (const std::string complaint = separator_complaint(header); !complaint.empty()) fail(line, complaint);
    if (are_numbers(names_))
        fail(line, "has numbers, needs a header before them: add the line " + likely_header(names_.size()));
    for (std::size_t i = 0; i < position_.size(); ++i) position_[i] = field_of(position_names[i], line);
    for (std::size_t i = 0; i < quaternion_.size(); ++i) quaternion_[i] = field_of(quaternion_names[i], line);
    for (std::size_t i = 0; i < angles_.size(); ++i) angles_[i] = angle_column(angle_names[i], line);
    check_columns(line);
}

std::string PoseRows::needed_header(const std::string& prefix)
{
    const auto columns = [&](const std::string& names) { return with_prefix(prefix, names); };
    return "needs a header with " + columns("x y z") + "; " + columns("roll pitch yaw") + " (or " +
           columns("roll_deg pitch_deg yaw_deg") + ", or " + columns("qx qy qz qw") + ") are optional";
}

std::string PoseRows::columns(const std::string& names) const { return with_prefix(prefix_, names); }

/// Returns the index of a column, -1 if there is none.
int PoseRows::field_of(const std::string& column, std::uint64_t line) const
{
    const std::string name = prefix_ + column;
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end() && std::find(found + 1, names_.end(), name) != names_.end())
        fail(line, "column " + name + " is given twice");
    return found == names_.end() ? -1 : int(found - names_.begin());
}

PoseRows::AngleColumn PoseRows::angle_column(const std::string& name, std::uint64_t line) const
{
    const int radians = field_of(name, line), degrees = field_of(name + "_deg", line);
    if (radians >= 0 && degrees >= 0)
        fail(line, "has columns " + columns(name) + " and " + columns(name) + "_deg, needs one of the two");
    return degrees >= 0 ? AngleColumn{columns(name) + "_deg", degrees, true} : AngleColumn{columns(name), radians};
}

void PoseRows::check_columns(std::uint64_t line) const
{
    for (std::size_t i = 0; i < position_.size(); ++i) {
        if (position_[i] >= 0) continue;
        const std::string name = columns(position_names[i]);
        const auto other = std::find_if(names_.begin(), names_.end(),
                                        [&](const std::string& n) { return lower_case(n) == name; });
        fail(line, "column " + name + " is missing" +
                       (other == names_.end() ? "" : " (there is " + *other + ", but names are lower case)") + ", " +
                       needed_header(prefix_));
    }
    const auto quaternions = std::count_if(quaternion_.begin(), quaternion_.end(),
                                           [](int field) { return field >= 0; });
    if (quaternions != 0 && quaternions != 4)
        fail(line, "has some of the columns " + columns("qx qy qz qw") + ", needs all four or none");
    const bool has_angle = std::any_of(angles_.begin(), angles_.end(),
                                       [](const AngleColumn& angle) { return angle.field >= 0; });
    if (quaternions == 4 && has_angle)
        fail(line, "has columns " + columns("qx qy qz qw") + " beside " + columns("roll pitch yaw") +
                       ", needs one of the two");
}

/// One for each column that is not read although its name is known except for its case. If the file has no yaw, also
/// one for each column with another name of the yaw. Names with a prefix are not looked at.
std::vector<std::string> PoseRows::name_notices() const
{
    std::vector<std::string> out;
    if (!prefix_.empty()) return out;
    const bool has_yaw = quaternion_[0] >= 0 || angles_[2].field >= 0;
    for (const std::string& name : names_) {
        const std::string lower = lower_case(name), what = file_ + ": column " + name + " is copied but not read, ";
        if (name != lower && is_pose_column(lower))
            out.push_back(what + "because names of columns are lower case (" + lower + ")");
        else if (!has_yaw && is_other_yaw_name(lower))
            out.push_back(what + "so yaw is 0; if it is the angle from x towards y, name it yaw (rad) " +
                          "or yaw_deg (degrees)");
    }
    return out;
}

std::vector<std::string> PoseRows::turn_notices(const BeyondTurn& beyond) const
{
    std::vector<std::string> out;
    for (std::size_t i = 0; i < angles_.size(); ++i) {
        const auto& [rows, first] = beyond.angles[i];
        if (rows == 0) continue;
        const std::string more = rows == 1 ? "" : " (the first of " + std::to_string(rows) + " rows)";
        out.push_back(file_ + ": " + first + more +
                      ", which is more than a turn of 2 pi rad; for degrees name the column " + angles_[i].name +
                      "_deg");
    }
    return out;
}

Pose PoseRows::pose(std::string_view row, std::uint64_t line, BeyondTurn& beyond) const
{
    const RowFields fields(row);
    if (std::count(row.begin(), row.end(), '"') % 2 != 0) fail(line, "has a quote that is not closed");
    if (fields.size() != names_.size())
        fail(line, "has " + std::to_string(fields.size()) + (fields.size() == 1 ? " field" : " fields") +
                       ", the header has " + std::to_string(names_.size()));
    Pose pose;
    for (int axis = 0; axis < 3; ++axis)
        pose.position[axis] = number_in(fields[position_[std::size_t(axis)]], position_names[std::size_t(axis)], line);
    if (quaternion_[0] < 0) {
        std::array<double, 3> rpy{};
        for (std::size_t i = 0; i < rpy.size(); ++i) {
            const AngleColumn& angle = angles_[i];
            if (angle.field < 0) continue;
            const double value = number_in(fields[angle.field], angle.name, line);
            rpy[i] = angle.is_degrees ? value * radians_per_degree : value;
            constexpr double turn = 2 * std::numbers::pi + 1e-9;
            if (!angle.is_degrees && std::abs(value) > turn && beyond.angles[i].rows++ == 0)
                beyond.angles[i].first = "line " + std::to_string(line) + ": column " + angle.name + " is " +
                                         number(value);
        }
        pose.rotation = rotation_from_rpy(rpy[0], rpy[1], rpy[2]);
        return pose;
    }
    std::array<double, 4> q{};
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = number_in(fields[quaternion_[i]], quaternion_names[i], line);
    const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
    if (!(std::abs(rotation.norm() - 1) <= 1e-3))
        fail(line, "the quaternion's length is " + number(rotation.norm()) + ", needs 1 (to 0.001)");
    pose.rotation = rotation.normalized().toRotationMatrix();
    return pose;
}

double PoseRows::number_in(std::string_view field, std::string_view column, std::uint64_t line) const
{
    double value = 0;
    const auto named = [&] {
        return "column " + (column.starts_with(prefix_) ? "" : prefix_) + std::string(column) + " is ";
    };
    if (!parse_number(field, value)) fail(line, named() + '"' + std::string(field) + "\", needs a number");
    if (!std::isfinite(value)) fail(line, named() + std::string(field) + ", needs a finite number");
    return value;
}

void PoseRows::fail(std::uint64_t line, const std::string& what) const
{
    throw FileError(file_, "line " + std::to_string(line) + ": " + what);
}

}  // namespace spawnfield

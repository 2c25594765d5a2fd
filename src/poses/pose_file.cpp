#include "base/csv.h"
#include "base/number.h"
#include "base/text.h"
#include "poses/json_poses.h"
#include "poses/pose_columns.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>
#include <spawnfield/poses.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spawnfield {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

/// The column of an angle: roll, pitch or yaw.
struct AngleColumn {
    std::string name;
    int field = -1;  ///< its index; -1: not in the file
    bool is_degrees = false;
    std::size_t beyond_turn = 0;  ///< number of rows with more than a whole turn: likely degrees
    std::string first = {};       ///< place and value of the first of these, for the notice
};

/// The index of each column; -1: not in the file.
struct PoseColumns {
    int x, y, z, qx, qy, qz, qw;
    std::array<AngleColumn, 3> angles;  ///< roll, pitch, yaw
    std::size_t count;
    bool has_quaternion() const { return qx >= 0; }
};

class PoseReader {
public:
    PoseReader(std::string name, std::string prefix) : file_(std::move(name)), prefix_(std::move(prefix)) {}

    PoseTable read(std::string_view text, bool allow_empty)
    {
        PoseTable table;
        PoseColumns found{};
        bool has_header = false;
        for (std::size_t start = 0; start < text.size();) {
            const std::size_t end = std::min(text.find('\n', start), text.size());
            std::string line(text.substr(start, end - start));
            start = end + 1;
            ++line_;
            if (line_ == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
            if (!line.empty() && line.back() == '\r') line.pop_back();
            if (line.find_first_not_of(" \t") == std::string::npos) continue;
            if (!has_header) {
                found = read_header(line);
                add_name_notices(line, found, table);
                table.header = line;
                has_header = true;
                continue;
            }
            if (std::count(line.begin(), line.end(), '"') % 2 != 0) fail("has a quote that is not closed");
            table.poses.push_back(read_pose(csv_fields(line), found));
            table.rows.push_back(std::move(line));
        }
        if (!has_header) throw FileError(file_, "is empty, " + needed_header());
        add_turn_notices(found, table);
        if (!table.poses.empty()) return table;
        if (!allow_empty) throw FileError(file_, "has a header but no pose; --allow-empty accepts that");
        table.notices.push_back(file_ + ": has a header but no pose");
        return table;
    }

private:
    /// Returns "roll_deg,pitch_deg" for "roll_deg pitch_deg", with the prefix before each name.
    std::string columns(const std::string& names) const
    {
        std::string out = prefix_ + names;
        for (std::size_t at = 0; (at = out.find(' ', at)) != std::string::npos;) out.replace(at, 1, "," + prefix_);
        return out;
    }
    std::string needed_header() const
    {
        return "needs a header with " + columns("x y z") + "; " + columns("roll pitch yaw") + " (or " +
               columns("roll_deg pitch_deg yaw_deg") + ", or " + columns("qx qy qz qw") + ") are optional";
    }

    PoseColumns read_header(const std::string& line) const
    {
        if (const std::string complaint = separator_complaint(line); !complaint.empty()) fail(complaint);
        const auto names = csv_fields(line);
        if (are_numbers(names))
            fail("has numbers, needs a header before them: add the line " + likely_header(names.size()));
        const auto find = [&](const std::string& plain) {
            const std::string name = prefix_ + plain;
            const auto column = std::find(names.begin(), names.end(), name);
            if (column != names.end() && std::find(column + 1, names.end(), name) != names.end())
                fail("column " + name + " is given twice");
            return column == names.end() ? -1 : int(column - names.begin());
        };
        const auto angle = [&](const std::string& name) {
            const int radians = find(name), degrees = find(name + "_deg");
            if (radians >= 0 && degrees >= 0)
                fail("has columns " + columns(name) + " and " + columns(name) + "_deg, needs one of the two");
            return degrees >= 0 ? AngleColumn{columns(name) + "_deg", degrees, true}
                                : AngleColumn{columns(name), radians};
        };
        PoseColumns c{find("x"),   find("y"),  find("z"),  find("qx"),
                      find("qy"),  find("qz"), find("qw"), {angle("roll"), angle("pitch"), angle("yaw")},
                      names.size()};
        for (const auto& axis : {std::pair{c.x, "x"}, std::pair{c.y, "y"}, std::pair{c.z, "z"}})
            if (axis.first < 0) {
                const auto other = std::find_if(names.begin(), names.end(), [&](const std::string& n) {
                    return lower_case(n) == columns(axis.second);
                });
                fail("column " + columns(axis.second) + " is missing" +
                     (other == names.end() ? "" : " (there is " + *other + ", but names are lower case)") + ", " +
                     needed_header());
            }
        const int quaternions = (c.qx >= 0) + (c.qy >= 0) + (c.qz >= 0) + (c.qw >= 0);
        if (quaternions != 0 && quaternions != 4)
            fail("has some of the columns " + columns("qx qy qz qw") + ", needs all four or none");
        const bool has_angle = std::any_of(c.angles.begin(), c.angles.end(),
                                           [](const AngleColumn& a) { return a.field >= 0; });
        if (quaternions == 4 && has_angle)
            fail("has columns " + columns("qx qy qz qw") + " beside " + columns("roll pitch yaw") +
                 ", needs one of the two");
        return c;
    }

    /// Returns the header that a row with this number of fields most likely needs.
    static std::string likely_header(std::size_t fields)
    {
        if (fields == 3) return "x,y,z";
        if (fields == 4) return "x,y,z,yaw (or yaw_deg)";
        return fields == 7 ? "x,y,z,qx,qy,qz,qw" : "x,y,z,roll,pitch,yaw (or roll_deg,pitch_deg,yaw_deg)";
    }

    /// Adds a notice for each column that is not read although its name is known except for its case. If the file has
    /// no yaw, also for each column with another name of the yaw. Names with a prefix are not looked at.
    void add_name_notices(const std::string& header, const PoseColumns& found, PoseTable& table) const
    {
        if (!prefix_.empty()) return;
        const bool has_yaw = found.has_quaternion() || found.angles[2].field >= 0;
        for (const std::string& name : csv_fields(header)) {
            const std::string lower = lower_case(name), what = file_ + ": column " + name + " is copied but not read, ";
            if (name != lower && is_pose_column(lower))
                table.notices.push_back(what + "because names of columns are lower case (" + lower + ")");
            else if (!has_yaw && is_other_yaw_name(lower))
                table.notices.push_back(what + "so yaw is 0; if it is the angle from x towards y, name it yaw (rad) " +
                                        "or yaw_deg (degrees)");
        }
    }

    /// Returns whether a column with this name is likely a yaw that is not read: theta, heading or yaw, alone or with a
    /// unit, for example heading_deg or "theta (rad)".
    static bool is_other_yaw_name(const std::string& lower)
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

    /// Adds a notice for each angle in radians with values beyond a whole turn.
    void add_turn_notices(const PoseColumns& found, PoseTable& table) const
    {
        for (const AngleColumn& angle : found.angles) {
            if (angle.beyond_turn == 0) continue;
            const std::string more = angle.beyond_turn == 1
                                         ? ""
                                         : " (the first of " + std::to_string(angle.beyond_turn) + " rows)";
            table.notices.push_back(file_ + ": " + angle.first + more +
                                    ", which is more than a turn of 2 pi rad; for degrees name the column " +
                                    angle.name + "_deg");
        }
    }

    Pose read_pose(const std::vector<std::string>& fields, PoseColumns& c) const
    {
        if (fields.size() != c.count)
            fail("has " + std::to_string(fields.size()) + " fields, the header has " + std::to_string(c.count));
        Pose pose;
        pose.position = {number_in(fields, c.x, "x"), number_in(fields, c.y, "y"), number_in(fields, c.z, "z")};
        if (!c.has_quaternion()) {
            const double roll = angle_in(fields, c.angles[0]), pitch = angle_in(fields, c.angles[1]),
                         yaw = angle_in(fields, c.angles[2]);
            pose.rotation = rotation_from_rpy(roll, pitch, yaw);
            return pose;
        }
        const Eigen::Quaterniond q(number_in(fields, c.qw, "qw"), number_in(fields, c.qx, "qx"),
                                   number_in(fields, c.qy, "qy"), number_in(fields, c.qz, "qz"));
        if (!(std::abs(q.norm() - 1) <= 1e-3))
            fail("the quaternion's length is " + number(q.norm()) + ", needs 1 (to 0.001)");
        pose.rotation = q.normalized().toRotationMatrix();
        return pose;
    }

    /// Returns an angle, rad. Counts values beyond a whole turn, and remembers the first one.
    double angle_in(const std::vector<std::string>& fields, AngleColumn& angle) const
    {
        const double value = number_in(fields, angle.field, angle.name.c_str());
        if (angle.is_degrees) return value * radians_per_degree;
        constexpr double turn = 2 * std::numbers::pi + 1e-9;
        if (std::abs(value) > turn && angle.beyond_turn++ == 0)
            angle.first = "line " + std::to_string(line_) + ": column " + angle.name + " is " + number(value);
        return value;
    }

    double number_in(const std::vector<std::string>& fields, int column, const char* name) const
    {
        if (column < 0) return 0;
        double value = 0;
        const std::string& text = fields[std::size_t(column)];
        if (!parse_number(text, value)) fail("column " + prefixed(name) + " is \"" + text + "\", needs a number");
        if (!std::isfinite(value)) fail("column " + prefixed(name) + " is " + text + ", needs a finite number");
        return value;
    }

    /// Returns the name of a column; those of angles have the prefix already.
    std::string prefixed(const std::string& name) const { return name.starts_with(prefix_) ? name : prefix_ + name; }

    [[noreturn]] void fail(const std::string& what) const
    {
        throw FileError(file_, "line " + std::to_string(line_) + ": " + what);
    }

    const std::string file_, prefix_;
    int line_ = 0;
};

}  // namespace

PoseTable parse_poses(std::string_view text, const std::string& name, bool allow_empty, const std::string& prefix)
{
    if (prefix.empty() && is_json(text)) return PoseReader(name, prefix).read(csv_of_json(text, name), allow_empty);
    return PoseReader(name, prefix).read(text, allow_empty);
}

PoseTable read_poses(const std::filesystem::path& file, bool allow_empty)
{
    return parse_poses(read_file(file), file.string(), allow_empty);
}

}  // namespace spawnfield

#pragma once

#include <spawnfield/poses.h>

#include <algorithm>
#include <array>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spawnfield {

/// Returns whether a column with this name is part of a pose.
inline bool is_pose_column(const std::string& name)
{
    constexpr std::array names{"x",         "y",       "z",  "roll", "pitch", "yaw", "roll_deg",
                               "pitch_deg", "yaw_deg", "qx", "qy",   "qz",    "qw"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// The columns that `check` writes, and those that it adds for robots that it lets down.
inline const std::vector<std::string> verdict_columns{"verdict", "ground", "height_above", "hit"};
inline const std::vector<std::string> settled_columns{"settled_z", "settled_roll", "settled_pitch", "tilt",  "margin",
                                                      "contacts",  "tip_over",     "belly",         "reason"};

/// The columns that it adds for the repairs of poses.
inline const std::vector<std::string> repair_columns{"repair",       "repair_distance", "repair_x",
                                                     "repair_y",     "repair_z",        "repair_roll",
                                                     "repair_pitch", "repair_yaw",      "repair_tried"};

/// Returns the table as CSV, with new columns at the end, in the place of old ones with the same names. append(text,
/// index) appends the new fields of a row, with commas between them.
std::string with_columns(const PoseTable& table, const std::vector<std::string>& names,
                         const std::function<void(std::string&, std::size_t)>& append);

/// The same for one part of a table after the other: only the first part has `header`. Passes the text to `sink` in
/// pieces. Several threads call append().
void write_with_columns(const PoseTable& table, const std::vector<std::string>& names, bool header, int threads,
                        const std::function<void(std::string_view)>& sink,
                        const std::function<void(std::string&, std::size_t)>& append);

/// Appends numbers with commas between them.
void append_numbers(std::string& text, std::initializer_list<double> values);

/// Appends a comma, and the number unless it is NaN.
void append_if_known(std::string& text, double value);

/// Returns the name of the column for the free length that a rule measures; empty if it measures none.
std::string free_length_column(const std::optional<HeadingRule>& rule);

/// Returns whether `check` writes a column with this name: one of the pose as given, or, if `settled`, also one of a
/// robot that was let down, or, with `repairs`, one of a repair.
inline bool is_verdict_column(const std::string& name, bool settled, bool repairs)
{
    const auto is_in = [&](const auto& names) { return std::find(names.begin(), names.end(), name) != names.end(); };
    return is_in(verdict_columns) || (settled && is_in(settled_columns)) || (repairs && is_in(repair_columns));
}

}  // namespace spawnfield

#pragma once

#include "poses/junit.h"
#include "poses/pose_json.h"

#include <spawnfield/poses.h>

namespace spawnfield {

/// A pose as it was given, and what a judge says about it, for reports. Refers to all of them.
struct JudgedPose {
    const Judge& judge;
    const Pose& pose;
    const Judgement& judgement;
    const SettledPose* settled = nullptr;  ///< if the robot was let down; then the judgement is of this pose
};

/// Returns the verdict and its cause in words.
std::string reason_of(const JudgedPose& judged);

/// Adds verdict, ground, height_above and hit to a pose; for settled ones, also `reason` and `settled`.
void add_verdict(Json& out, const JudgedPose& judged);

/// Returns lines of text: the pose, the height of the ground, and what was hit.
std::string verdict_lines(const JudgedPose& judged);

/// Returns "1, 2, 3", rounded.
std::string listed(const Vec3& values);

/// Returns the limits of a judge that matter to poses as given or, if `settled`, to settled poses.
Json judge_settings_json(const Judge& judge, bool settled);

/// Returns the properties of a JUnit report: the version, the map, the robot and the settings.
std::vector<std::pair<std::string, std::string>> junit_properties(const Judge& judge, const Json& settings);

/// Returns the robot's name, or "robot" if it has none.
std::string robot_name(const Robot& robot);

/// Returns a name for each row of a table: the text in its column `name`, or the noun and the number of the row, from 1
/// on. If several rows have the same name, " (NOUN N)" is added to it. `first`: how many rows come before the table.
std::vector<std::string> row_names(const PoseTable& table, const std::string& noun, std::size_t first = 0);

/// Returns the fields of a row by the names of their columns, without the columns `replaced`.
Json fields_json(const PoseTable& table, std::size_t row, const std::vector<std::string>& replaced);

/// Writes an object with the members of `head` and a list of rows, each on a line of its own, in pieces.
void write_json_rows(const Json& head, const std::string& key, std::size_t rows,
                     const std::function<Json(std::size_t)>& row, const TextSink& sink);

}  // namespace spawnfield

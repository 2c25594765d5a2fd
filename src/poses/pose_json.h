#pragma once

#include <spawnfield/judge.h>
#include <spawnfield/map.h>
#include <spawnfield/query.h>
#include <spawnfield/robot.h>
#include <spawnfield/settled_pose.h>
#include <spawnfield/simulators.h>

#include <nlohmann/json.hpp>

namespace spawnfield {

using Json = nlohmann::ordered_json;

/// Returns the beginning of every JSON file of poses: format, version, command, map, robot, settings (left out if
/// null), frame.
Json json_head(const std::string& command, const Map& map, const Robot& robot, Json settings,
               const std::string& format = "spawnfield-spawns/1");

/// Returns name and namespace if they are not empty, position, quaternion and rpy.
Json pose_json(const RobotStart& robot);

/// Adds the limits of settled poses to the settings of a query.
void add_stand_limits(Json& settings, const StandLimits& limits);

/// Returns the settings of `sample`. Limits that are infinite are left out.
Json sample_settings_json(const SampleOptions& options, const Judge& judge);

/// Returns the name of a robot's part, or its number from 1 on.
std::string part_name(const Robot& robot, std::size_t part);

/// Returns the text of a value. Bytes in names that are not UTF-8 become U+FFFD. `indent` -1: on one line.
std::string json_text(const Json& value, int indent);

}  // namespace spawnfield

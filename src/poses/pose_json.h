#pragma once

#include <spawnfield/map.h>
#include <spawnfield/robot.h>
#include <spawnfield/simulators.h>

#include <nlohmann/json.hpp>

namespace spawnfield {

using Json = nlohmann::ordered_json;

/// What every JSON file of poses begins with: format, version, command, map, robot, settings (left out if null), frame.
Json json_head(const std::string& command, const Map& map, const Robot& robot, Json settings,
               const std::string& format = "spawnfield-spawns/1");

/// Name and namespace if they are not empty, position, quaternion and rpy.
Json pose_json(const RobotStart& robot);

/// The text of a value. Bytes that are not UTF-8, in names, become U+FFFD. `indent` -1: on one line.
std::string json_text(const Json& value, int indent);

}  // namespace spawnfield

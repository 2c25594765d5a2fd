#include "poses/pose_json.h"

#include <Eigen/Geometry>

namespace spawnfield {

Json json_head(const std::string& command, const Map& map, const Robot& robot, Json settings, const std::string& format)
{
    Json out;
    out["format"] = format;
    out["version"] = version();
    out["command"] = command;
    out["map"] = {{"name", map.name}, {"hash", map.hash}};
    if (!map.changes.empty()) out["map"]["changes"] = map.changes;
    if (!robot.name.empty()) out["robot"] = robot.name;
    for (const auto& [joint, value] : robot.joints) out["joints"][joint] = value;
    if (robot.mesh_parts != 1) out["mesh_parts"] = robot.mesh_parts;
    if (!settings.is_null()) out["settings"] = std::move(settings);
    out["frame"] = "metres, radians, x forward, y left, z up (REP-103)";
    out["quaternion_order"] = "xyzw";
    return out;
}

Json pose_json(const RobotStart& robot)
{
    Json out;
    if (!robot.name.empty()) out["name"] = robot.name;
    if (!robot.name_space.empty()) out["namespace"] = robot.name_space;
    const Vec3& p = robot.position;
    const Eigen::Quaterniond q = quaternion_from(robot.rpy);
    out["position"] = {p.x(), p.y(), p.z()};
    out["quaternion"] = {q.x(), q.y(), q.z(), q.w()};
    out["rpy"] = {robot.rpy.roll, robot.rpy.pitch, robot.rpy.yaw};
    return out;
}

void add_stand_limits(Json& settings, const StandLimits& limits)
{
    settings["stance"] = "settled";
    settings["lift"] = limits.lift;
    settings["max_slope"] = limits.max_slope;
    settings["max_tilt"] = limits.max_tilt;
    settings["min_stability"] = *limits.min_stability;
    settings["friction"] = limits.friction;
    if (limits.drop) settings["drop"] = *limits.drop;
}

std::string part_name(const Robot& robot, std::size_t part)
{
    const std::string& name = robot.parts[part].name;
    return name.empty() ? "part " + std::to_string(part + 1) : name;
}

std::string json_text(const Json& value, int indent)
{
    return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace spawnfield

#include "base/csv.h"
#include "base/number.h"
#include "simulators/text.h"

#include <nlohmann/json.hpp>

#include <numbers>

namespace spawnfield {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the text of a JSON value. Names may be in any encoding; bytes that are not UTF-8 are replaced.
std::string dumped(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

void append(std::string& text, std::initializer_list<double> values)
{
    for (const double value : values) {
        text += ',';
        append_number(text, value);
    }
}

}  // namespace

std::string carla_json(std::span<const RobotStart> robots, const std::string& blueprint)
{
    Json out;
    out["format"] = "spawnfield-carla/1";
    out["frame"] = "left-handed, x forward, y right, z up, metres, degrees: carla.Transform";
    out["transforms"] = Json::array();
    for (const RobotStart& robot : robots) {
        const Vec3 p = point_in(Frame::Carla, robot.position);
        const Rotator r = rotator_from(robot.rpy);
        out["transforms"].push_back({{"id", robot.name},
                                     {"type", blueprint},
                                     {"location", {{"x", p.x()}, {"y", p.y()}, {"z", p.z()}}},
                                     {"rotation", {{"pitch", r.pitch}, {"yaw", r.yaw}, {"roll", r.roll}}}});
    }
    return dumped(out);
}

std::string carla_objects_json(std::span<const RobotStart> robots, const std::string& blueprint)
{
    constexpr double degrees = 180 / std::numbers::pi;
    Json out;
    out["objects"] = Json::array();
    for (const RobotStart& robot : robots) {
        const Vec3& p = robot.position;
        const Rpy& rpy = robot.rpy;
        const Json point = {{"x", p.x()},
                            {"y", p.y()},
                            {"z", p.z()},
                            {"roll", rpy.roll * degrees},
                            {"pitch", rpy.pitch * degrees},
                            {"yaw", rpy.yaw * degrees}};
        out["objects"].push_back(
            {{"type", blueprint}, {"id", robot.name}, {"spawn_point", point}, {"sensors", Json::array()}});
    }
    return dumped(out);
}

std::string unity_csv(std::span<const RobotStart> robots, Frame frame)
{
    std::string text = "name,x,y,z,qx,qy,qz,qw\n";
    for (const RobotStart& robot : robots) {
        const Vec3 p = point_in(frame, robot.position);
        const Eigen::Quaterniond q = quaternion_in(frame, robot.rpy);
        text += csv_quoted(robot.name);
        append(text, {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
        text += '\n';
    }
    return text;
}

std::string unreal_csv(std::span<const RobotStart> robots)
{
    std::string text = "Name,X,Y,Z,Roll,Pitch,Yaw\n";
    for (const RobotStart& robot : robots) {
        const Vec3 p = point_in(Frame::Unreal, robot.position);
        const Rotator r = rotator_from(robot.rpy);
        text += csv_quoted(robot.name);
        append(text, {p.x(), p.y(), p.z(), r.roll, r.pitch, r.yaw});
        text += '\n';
    }
    return text;
}

}  // namespace spawnfield

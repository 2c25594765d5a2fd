#include "base/number.h"
#include "base/text.h"
#include "simulators/text.h"

namespace spawnfield {
namespace {

void append(std::string& text, double value)
{
    if (!text.empty()) text += ' ';
    append_number(text, value);
}

/// Appends x y z qw qx qy qz, then the joints.
void append_qpos(std::string& text, const RobotStart& robot, const std::vector<double>& joints)
{
    const Eigen::Quaterniond q = quaternion_in(Frame::Ros, robot.rpy);
    for (const double value : {robot.position.x(), robot.position.y(), robot.position.z(), q.w(), q.x(), q.y(), q.z()})
        append(text, value);
    for (const double joint : joints) append(text, joint);
}

std::string key(const std::string& name, const std::string& qpos)
{
    return "    <key name=\"" + xml_escaped(name) + "\" qpos=\"" + qpos + "\"/>\n";
}

}  // namespace

std::string mujoco_keyframes(std::span<const RobotStart> robots, const KeyframeOptions& options)
{
    std::string text = "<!-- " + made_by(robots.size()) + ": x y z (m), quaternion w x y z" +
                       (options.joints.empty() ? "" : ", joints") +
                       "; right-handed, x forward, y left, z up -->\n<mujoco>\n  <keyframe>\n";
    std::string all;
    for (const RobotStart& robot : robots) {
        std::string one;
        append_qpos(options.together ? all : one, robot, options.joints);
        if (!options.together) text += key(robot.name, one);
    }
    if (options.together && !robots.empty()) text += key("spawns", all);
    return text + "  </keyframe>\n</mujoco>\n";
}

}  // namespace spawnfield

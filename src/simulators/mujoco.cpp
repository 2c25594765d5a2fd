#include "base/number.h"
#include "base/text.h"
#include "simulators/text.h"

#include <spawnfield/error.h>
#include <spawnfield/robot_inertia.h>

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

std::string numbers(std::initializer_list<double> values)
{
    std::string text;
    for (const double value : values) append(text, value);
    return text;
}

std::string place(const Pose& pose)
{
    const Vec3& p = pose.position;
    const Eigen::Quaterniond q(pose.rotation);
    return " pos=\"" + numbers({p.x(), p.y(), p.z()}) + "\" quat=\"" + numbers({q.w(), q.x(), q.y(), q.z()}) + "\"";
}

/// Returns the type and the size of a shape: half lengths. `mesh` is the name of the asset of a hull.
std::string shape_attributes(const Shape& shape, const std::string& mesh)
{
    const auto with = [](const char* type, std::initializer_list<double> size) {
        return std::string(" type=\"") + type + "\" size=\"" + numbers(size) + "\"";
    };
    const Vec3& size = shape.size;
    switch (shape.kind) {
    case ShapeKind::Sphere: return with("sphere", {size.x()});
    case ShapeKind::Cylinder: return with("cylinder", {size.x(), size.y() / 2});
    case ShapeKind::Capsule: return with("capsule", {size.x(), size.y() / 2});
    case ShapeKind::Hull: return " type=\"mesh\" mesh=\"" + mesh + "\"";
    case ShapeKind::Box: break;
    }
    return with("box", {size.x() / 2, size.y() / 2, size.z() / 2});
}

std::string mesh_name(std::size_t kind, std::size_t part)
{
    return "hull_" + std::to_string(kind + 1) + "_" + std::to_string(part + 1);
}

std::string mesh_assets(const Robot& robot, std::size_t kind)
{
    std::string text;
    for (std::size_t part = 0; part < robot.parts.size(); ++part) {
        if (robot.parts[part].shape.kind != ShapeKind::Hull) continue;
        std::string vertices;
        for (const Vec3& vertex : robot.parts[part].hull_vertices)
            for (const double value : {vertex.x(), vertex.y(), vertex.z()}) append(vertices, value);
        text += "    <mesh name=\"" + mesh_name(kind, part) + "\" vertex=\"" + vertices + "\"/>\n";
    }
    return text;
}

std::string inertial(const RobotInertia& inertia)
{
    const Vec3& at = inertia.centre;
    const Mat3& t = inertia.tensor;
    return "      <inertial pos=\"" + numbers({at.x(), at.y(), at.z()}) + "\" mass=\"" + numbers({inertia.mass}) +
           "\" fullinertia=\"" + numbers({t(0, 0), t(1, 1), t(2, 2), t(0, 1), t(0, 2), t(1, 2)}) + "\"/>\n";
}

std::string body(const RobotStart& start, const Robot& robot, std::size_t kind, const RobotInertia* inertia)
{
    const std::string name = xml_escaped(start.name);
    std::string text = "    <body name=\"" + name + "\"" + place({start.position, rotation_from(start.rpy)}) +
                       ">\n      <freejoint name=\"" + name + "\"/>\n";
    if (inertia != nullptr) text += inertial(*inertia);
    for (std::size_t part = 0; part < robot.parts.size(); ++part) {
        const Shape& shape = robot.parts[part].shape;
        const bool is_hull = shape.kind == ShapeKind::Hull;  // its corners are in the robot's frame
        text += "      <geom" + shape_attributes(shape, mesh_name(kind, part)) +
                (is_hull ? std::string() : place(shape.pose)) + "/>\n";
    }
    return text + "    </body>\n";
}

}  // namespace

std::string mujoco_bodies(std::span<const RobotStart> robots, std::span<const Robot> kinds,
                          std::span<const std::size_t> kind_of)
{
    return mujoco_bodies(robots, kinds, kind_of, {});
}

std::string mujoco_bodies(std::span<const RobotStart> robots, std::span<const Robot> kinds,
                          std::span<const std::size_t> kind_of, std::span<const std::optional<RobotInertia>> inertias)
{
    if (!inertias.empty() && inertias.size() != kinds.size())
        throw ArgumentError("mujoco_bodies", "size of inertias", double(inertias.size()), "one for each kind, or none");
    if (kind_of.size() != robots.size())
        throw ArgumentError("mujoco_bodies", "size of kind_of", double(kind_of.size()), "one kind for each robot");
    std::string assets, bodies, keys;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) assets += mesh_assets(kinds[kind], kind);
    for (std::size_t i = 0; i < robots.size(); ++i) {
        const RobotInertia* const inertia = !inertias.empty() && inertias[kind_of[i]] ? &*inertias[kind_of[i]]
                                                                                      : nullptr;
        bodies += body(robots[i], kinds[kind_of[i]], kind_of[i], inertia);
        append_qpos(keys, robots[i], {});
    }
    return "<!-- " + made_by(robots.size()) +
           ": their collision shapes; m, right-handed, x forward, y left, z up -->\n" +
           "<!-- Bodies with <inertial> have the mass and the inertia of the robot's file. All others have those of "
           "their "
           "shapes, with MuJoCo's default density. -->\n" +
           "<mujoco model=\"fleet\">\n" + (assets.empty() ? "" : "  <asset>\n" + assets + "  </asset>\n") +
           "  <worldbody>\n" + bodies + "  </worldbody>\n" +
           (robots.empty() ? "" : "  <keyframe>\n" + key("spawns", keys) + "  </keyframe>\n") + "</mujoco>\n";
}

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

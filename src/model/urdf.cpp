#include "model/jointed_model.h"

#include "base/input_file.h"
#include "base/number.h"
#include "base/xml.h"
#include "model/joints.h"

#include <spawnfield/error.h>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>
#include <Eigen/Geometry>

#include <cmath>

namespace spawnfield {
namespace {

Pose pose_of(const urdf::Pose& pose)
{
    const urdf::Rotation& q = pose.rotation;
    return {Vec3(pose.position.x, pose.position.y, pose.position.z),
            Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix()};
}

/// Keeps the messages of urdfdom away from standard error, and remembers its first error. Its warnings are only about
/// appearance.
class UrdfdomErrors : public console_bridge::OutputHandler {
public:
    UrdfdomErrors() { console_bridge::useOutputHandler(this); }
    UrdfdomErrors(const UrdfdomErrors&) = delete;
    UrdfdomErrors& operator=(const UrdfdomErrors&) = delete;
    ~UrdfdomErrors() override { console_bridge::restorePreviousOutputHandler(); }

    void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override
    {
        if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
    }
    const std::string& first() const { return first_; }

private:
    std::string first_;
};

Joint joint_of(const urdf::Joint& joint)
{
    using Motion = Joint::Motion;
    Joint out;
    out.name = joint.name;
    switch (joint.type) {
    case urdf::Joint::REVOLUTE: out.motion = Motion::Turning, out.type = "revolute"; break;
    case urdf::Joint::CONTINUOUS: out.motion = Motion::Turning, out.type = "continuous"; break;
    case urdf::Joint::PRISMATIC: out.motion = Motion::Sliding, out.type = "prismatic"; break;
    case urdf::Joint::FLOATING: out.motion = Motion::Other, out.type = "floating"; break;
    case urdf::Joint::PLANAR: out.motion = Motion::Other, out.type = "planar"; break;
    default: out.type = "fixed"; break;
    }
    if (joint.limits && joint.type != urdf::Joint::CONTINUOUS) {
        out.lower = joint.limits->lower;
        out.upper = joint.limits->upper;
    }
    if (joint.mimic) out.mimic = Joint::Mimic{joint.mimic->joint_name, joint.mimic->multiplier, joint.mimic->offset};
    return out;
}

CollisionGeometry geometry_of(const urdf::Geometry& geometry, const std::filesystem::path& folder)
{
    CollisionGeometry out;
    if (geometry.type == urdf::Geometry::BOX) {
        const auto& box = static_cast<const urdf::Box&>(geometry);
        out.kind = CollisionGeometry::Kind::Box;
        out.size = {box.dim.x, box.dim.y, box.dim.z};
    } else if (geometry.type == urdf::Geometry::SPHERE) {
        out.kind = CollisionGeometry::Kind::Sphere;
        out.size[0] = static_cast<const urdf::Sphere&>(geometry).radius;
    } else if (geometry.type == urdf::Geometry::CYLINDER) {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
        out.kind = CollisionGeometry::Kind::Cylinder;
        out.size = {cylinder.radius, cylinder.length, 1};
    } else {
        const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
        out.kind = CollisionGeometry::Kind::Mesh;
        out.size = {mesh.scale.x, mesh.scale.y, mesh.scale.z};
        out.uri = mesh.filename;
        out.folder = folder;
    }
    return out;
}

class UrdfReader {
public:
    UrdfReader(std::filesystem::path file, const std::vector<JointPosition>& joints)
        : file_(std::move(file)), joints_(joints)
    {
    }

    JointedModel read()
    {
        const std::string text = read_file(file_);
        if (text.find("<xacro:") != std::string::npos)
            throw FileError(file_.string(), "contains xacro macros; expand them first: xacro " +
                                                file_.filename().string() + " > robot.urdf");
        check_xml();
        UrdfdomErrors errors;
        const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
        // urdfdom continues after an error in a link. The link would lack parts, and the robot would be too small.
        if (!errors.first().empty()) throw FileError(file_.string(), "is not valid URDF: " + errors.first());
        if (!model || !model->getRoot()) throw FileError(file_.string(), "is not valid URDF");
        out_.name = model->getName();
        std::vector<Joint> joints;
        for (const auto& entry : model->joints_) joints.push_back(joint_of(*entry.second));
        positions_ = joint_positions(file_.string(), joints, joints_, out_.notices);
        add_links(*model);
        if (out_.bodies.empty())
            throw FileError(file_.string(), "has no <collision>, needs at least one (<visual> elements are not used)");
        return std::move(out_);
    }

private:
    /// Checks for errors that urdfdom reports without a line, or not at all.
    void check_xml() const
    {
        const auto document = read_xml(file_, "a <robot> element");
        for_each_element(*document->RootElement(), [&](const Xml& element) {
            const std::string name = element.Name();
            const auto refuse = [&](const std::string& what) { fail(element, what); };
            if (name == "origin" && element.Attribute("quat_xyzw") != nullptr && element.Attribute("rpy") == nullptr)
                refuse("<origin quat_xyzw> cannot be read here; write the rotation as rpy");
            const char* const parent = element.Parent()->Value();  // nullptr: the document
            if (name != "geometry" || parent == nullptr || parent != std::string("collision")) return;
            std::size_t shapes = 0;
            for_each_child(element, nullptr, [&](const Xml&) { ++shapes; });
            if (shapes > 1)
                refuse("<geometry> contains " + std::to_string(shapes) +
                       " shapes, needs one; give each a <collision> of its own");
        });
        require_tree(*document->RootElement());
    }

    /// Refuses links that form no tree (http://wiki.ros.org/urdf/XML/joint). urdfdom accepts a link with two parents,
    /// and leaks a cycle.
    void require_tree(const Xml& robot) const
    {
        const auto refuse = [&](const Xml& joint, const std::string& what) {
            fail(joint, "joint \"" + attribute_of(joint, "name") + "\": " + what +
                            "; the links of a robot form a tree: each is the child of one joint, except the root");
        };
        std::map<std::string, const Xml*> joint_above;  // by name of the link
        for_each_child(robot, "joint", [&](const Xml& joint) {
            const std::string child = link_at(joint, "child");
            if (child.empty()) return;  // urdfdom refuses it
            const auto [known, is_new] = joint_above.emplace(child, &joint);
            if (!is_new)
                refuse(joint, "link \"" + known->first + "\" is already the child of joint \"" +
                                  attribute_of(*known->second, "name") + "\"");
        });
        std::map<std::string, const Xml*> visited_from;  // the joint whose way to the root came here first, by link
        for (const auto& [child, joint] : joint_above) {
            std::string link = child;
            for (auto above = joint_above.find(link); above != joint_above.end(); above = joint_above.find(link)) {
                const auto [first, is_new] = visited_from.emplace(link, joint);
                if (!is_new && first->second == joint)
                    refuse(*above->second, "link \"" + link + "\" is in a cycle of joints");
                if (!is_new) break;
                link = link_at(*above->second, "parent");
            }
        }
    }

    static std::string link_at(const Xml& joint, const char* end)
    {
        const Xml* const element = joint.FirstChildElement(end);
        return element == nullptr ? "" : attribute_of(*element, "link");
    }

    /// Adds the collisions of all links. A link comes before its children. There is no recursion, because a chain of
    /// links may be longer than the call stack.
    void add_links(const urdf::ModelInterface& model)
    {
        std::vector<std::pair<const urdf::Link*, Pose>> open{{model.getRoot().get(), {}}};
        while (!open.empty()) {
            const auto [link, robot_from_link] = open.back();
            open.pop_back();
            add_collisions(*link, robot_from_link);
            add_mass(*link, robot_from_link);
            for (auto joint = link->child_joints.rbegin(); joint != link->child_joints.rend(); ++joint)
                open.emplace_back(model.links_.at((*joint)->child_link_name).get(),
                                  robot_from_child(*link, robot_from_link, **joint));
        }
    }

    /// Returns the pose of the link at the other end of a joint. Adds its axle if it can turn without limits.
    Pose robot_from_child(const urdf::Link& link, const Pose& robot_from_link, const urdf::Joint& joint)
    {
        const Pose robot_from_joint = robot_from_link * pose_of(joint.parent_to_joint_origin_transform);
        if (joint.type == urdf::Joint::CONTINUOUS)
            out_.axles[joint.child_link_name] = robot_from_joint.rotation *
                                                Vec3(joint.axis.x, joint.axis.y, joint.axis.z);
        return robot_from_joint * motion_of(link, joint);
    }

    void add_collisions(const urdf::Link& link, const Pose& robot_from_link)
    {
        for (const auto& collision : link.collision_array) {
            if (!collision || !collision->geometry) fail(link, "has a <collision> without geometry");
            require_positive(link, *collision->geometry);
            out_.bodies.push_back({{out_.name, link.name, collision->name},
                                   robot_from_link * pose_of(collision->origin),
                                   geometry_of(*collision->geometry, file_.parent_path())});
        }
    }

    void add_mass(const urdf::Link& link, const Pose& robot_from_link)
    {
        if (!link.inertial) return;
        const urdf::Inertial& inertial = *link.inertial;
        const double mass = inertial.mass;
        if (!(mass >= 0) || !std::isfinite(mass)) fail(link, "<mass> is " + number(mass) + ", needs >= 0 kg");
        Mat3 about_centre;
        about_centre << inertial.ixx, inertial.ixy, inertial.ixz,  //
            inertial.ixy, inertial.iyy, inertial.iyz,              //
            inertial.ixz, inertial.iyz, inertial.izz;
        out_.add_mass(mass, robot_from_link * pose_of(inertial.origin), about_centre);
    }

    Pose motion_of(const urdf::Link& link, const urdf::Joint& joint) const
    {
        const auto value = positions_.find(joint.name);
        if (value == positions_.end() || value->second == 0) return {};
        const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
        if (!(axis.norm() > 1e-6))
            fail(link, "joint \"" + joint.name + "\" has an <axis> of length 0, needs a direction");
        return joint_motion(joint_of(joint).motion, axis.normalized(), value->second);
    }

    void require_positive(const urdf::Link& link, const urdf::Geometry& geometry) const
    {
        const CollisionGeometry found = geometry_of(geometry, {});
        if (found.kind == CollisionGeometry::Kind::Mesh) return;
        const char* const what = found.kind == CollisionGeometry::Kind::Box      ? "<box size>"
                                 : found.kind == CollisionGeometry::Kind::Sphere ? "<sphere radius>"
                                                                                 : "<cylinder>";
        for (const double side : found.size)
            if (!(side > 0) || !std::isfinite(side))
                fail(link, std::string(what) + " is " + number(side) + ", needs > 0");
    }

    [[noreturn]] void fail(const Xml& element, const std::string& what) const
    {
        throw FileError(file_.string(), line_of(element) + what);
    }

    [[noreturn]] void fail(const urdf::Link& link, const std::string& what) const
    {
        throw FileError(file_.string(), "link \"" + link.name + "\": " + what);
    }

    const std::filesystem::path file_;
    const std::vector<JointPosition>& joints_;
    JointedModel out_;
    std::map<std::string, double> positions_;  ///< by name of the joint
};

}  // namespace

JointedModel read_urdf_model(const std::filesystem::path& file, const std::vector<JointPosition>& joints)
{
    return UrdfReader(file, joints).read();
}

}  // namespace spawnfield

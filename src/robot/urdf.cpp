#include "robot/urdf.h"

#include "base/number.h"
#include "robot/joints.h"
#include "robot/mesh_parts.h"

#include <spawnfield/error.h>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>
#include <Eigen/Geometry>

#include <cmath>
#include <fstream>
#include <sstream>

namespace spawnfield {
namespace {

Pose pose_of(const urdf::Pose& pose)
{
    const urdf::Rotation& q = pose.rotation;
    return {Vec3(pose.position.x, pose.position.y, pose.position.z),
            Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix()};
}

/// Keeps what urdfdom says from standard error, and the first error of it; warnings are about looks.
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

class UrdfReader {
public:
    UrdfReader(std::filesystem::path file, const RobotOptions& options) : file_(std::move(file)), options_(options) {}

    Robot read()
    {
        std::ifstream stream(file_, std::ios::binary);
        if (!stream || !std::filesystem::is_regular_file(file_))
            throw FileError(file_.string(), "does not exist; is the path right?");
        std::stringstream text;
        text << stream.rdbuf();
        if (text.str().find("<xacro:") != std::string::npos)
            throw FileError(file_.string(), "holds xacro macros; expand them first: xacro " + file_.filename().string() + " > robot.urdf");
        UrdfdomErrors errors;
        const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text.str());
        // urdfdom goes on with a link that it could not read to its end, and that would make the robot smaller.
        if (!errors.first().empty()) throw FileError(file_.string(), "is no valid URDF: " + errors.first());
        if (!model || !model->getRoot()) throw FileError(file_.string(), "is no valid URDF");
        robot_.name = model->getName();
        std::vector<Joint> joints;
        for (const auto& entry : model->joints_) joints.push_back(joint_of(*entry.second));
        positions_ = joint_positions(file_.string(), joints, options_.joints, robot_.notices);
        add_link(*model->getRoot(), {});
        if (robot_.parts.empty()) throw FileError(file_.string(), "has no <collision>, needs at least one (<visual> does not count)");
        return std::move(robot_);
    }

private:
    void add_link(const urdf::Link& link, const Pose& robot_from_link)
    {
        for (const auto& collision : link.collision_array) {
            if (!collision || !collision->geometry) fail(link, "has a <collision> without geometry");
            add_collision(link, *collision->geometry, robot_from_link * pose_of(collision->origin));
        }
        for (const auto& joint : link.child_joints) {
            for (const auto& child : link.child_links)
                if (child->name == joint->child_link_name)
                    add_link(*child, robot_from_link * pose_of(joint->parent_to_joint_origin_transform) * motion_of(link, *joint));
        }
    }

    Pose motion_of(const urdf::Link& link, const urdf::Joint& joint) const
    {
        const auto value = positions_.find(joint.name);
        if (value == positions_.end() || value->second == 0) return {};
        const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
        if (!(axis.norm() > 1e-6)) fail(link, "joint \"" + joint.name + "\" has an <axis> of no length");
        return joint_motion(joint_of(joint).motion, axis.normalized(), value->second);
    }

    void add_collision(const urdf::Link& link, const urdf::Geometry& geometry, const Pose& pose)
    {
        RobotPart part;
        part.shape.pose = pose;
        if (geometry.type == urdf::Geometry::BOX) {
            const auto& box = static_cast<const urdf::Box&>(geometry);
            part.shape.kind = ShapeKind::Box;
            part.shape.size = {box.dim.x, box.dim.y, box.dim.z};
            require_positive(link, "<box size>", part.shape.size.minCoeff());
        } else if (geometry.type == urdf::Geometry::SPHERE) {
            part.shape.kind = ShapeKind::Sphere;
            part.shape.size[0] = static_cast<const urdf::Sphere&>(geometry).radius;
            require_positive(link, "<sphere radius>", part.shape.size[0]);
        } else if (geometry.type == urdf::Geometry::CYLINDER) {
            const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
            part.shape.kind = ShapeKind::Cylinder;
            part.shape.size = {cylinder.radius, cylinder.length, 0};
            require_positive(link, "<cylinder>", std::min(cylinder.radius, cylinder.length));
        } else {
            add_mesh(link, static_cast<const urdf::Mesh&>(geometry), pose);
            return;
        }
        part.name = link.name;
        robot_.parts.push_back(std::move(part));
    }

    void add_mesh(const urdf::Link& link, const urdf::Mesh& mesh, const Pose& pose)
    {
        const std::filesystem::path file = resolve(link, mesh.filename);
        const Vec3 scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
        try {
            // As Gazebo takes COLLADA: its <unit> counts, its <up_axis> does not.
            append_mesh(robot_, {link.name, file, placed(read_mesh(file).nodes, scale, pose)}, options_.mesh_parts);
        } catch (const std::domain_error& error) {
            fail(link, "<mesh> cannot be used: " + file.string() + ": its convex hull has no volume: " + error.what());
        } catch (const FileError& error) {
            fail(link, std::string("<mesh> cannot be used: ") + error.what());
        }
    }

    std::filesystem::path resolve(const urdf::Link& link, const std::string& uri) const
    {
        const std::string package = "package://", local = "file://";
        if (uri.starts_with(local)) return uri.substr(local.size());
        if (!uri.starts_with(package)) return file_.parent_path() / uri;
        const std::filesystem::path inside = uri.substr(package.size());
        std::vector<std::filesystem::path> folders = options_.package_paths;
        const auto absolute = std::filesystem::absolute(file_).lexically_normal();
        for (auto folder = absolute.parent_path(); folder != folder.root_path(); folder = folder.parent_path())
            folders.push_back(folder);
        for (const auto& folder : folders)
            if (std::filesystem::is_regular_file(folder / inside)) return folder / inside;
        fail(link, uri + " is found neither in --package-path nor in the folders above the file");
    }

    void require_positive(const urdf::Link& link, const std::string& what, double value) const
    {
        if (!(value > 0) || !std::isfinite(value)) fail(link, what + " is " + number(value) + ", needs > 0");
    }

    [[noreturn]] void fail(const urdf::Link& link, const std::string& what) const
    {
        throw FileError(file_.string(), "link \"" + link.name + "\": " + what);
    }

    const std::filesystem::path file_;
    const RobotOptions& options_;
    Robot robot_;
    std::map<std::string, double> positions_;  ///< of joints
};

}  // namespace

Robot read_urdf(const std::filesystem::path& file, const RobotOptions& options) { return UrdfReader(file, options).read(); }

}  // namespace spawnfield

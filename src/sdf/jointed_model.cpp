#include "model/jointed_model.h"

#include "model/joints.h"
#include "model/sdf_includes.h"
#include "model/sdf_module.h"
#include "sdf/sdf_parser.h"

#include <spawnfield/error.h>

#include <Eigen/Geometry>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

Joint::Motion motion_of(sdf::JointType type)
{
    switch (type) {
    case sdf::JointType::FIXED: return Joint::Motion::None;
    case sdf::JointType::REVOLUTE:
    case sdf::JointType::CONTINUOUS: return Joint::Motion::Turning;
    case sdf::JointType::PRISMATIC: return Joint::Motion::Sliding;
    default: return Joint::Motion::Other;
    }
}

class JointedModelReader {
public:
    JointedModelReader(const fs::path& file, ModelPaths& paths, const std::vector<JointPosition>& joints)
        : file_(file), paths_(paths), joints_(joints)
    {
    }

    JointedModel read()
    {
        check_includes(file_, *read_sdf_xml(file_), paths_);
        const SdfSession session(paths_, file_.parent_path());
        sdf::Root root;
        check(load(root, file_, std::nullopt, session.config()));
        if (root.Model() == nullptr)
            throw FileError(file_.string(), root.WorldCount() > 0 ? "contains a <world>, needs a <model> to be a robot"
                                                                  : "has no <model>");
        const sdf::Model& model = *root.Model();
        out_.name = model.Name();
        if (model.RawPose() != ignition::math::Pose3d::Zero)
            out_.notices.push_back(file_.string() + ": the <pose> of model \"" + model.Name() +
                                   "\" is ignored: poses are in its own frame");
        collect(model, {}, "");
        for (const Hinge& hinge : hinges_)
            if (hinge.joint.motion == Joint::Motion::Turning && std::isinf(hinge.joint.lower) &&
                std::isinf(hinge.joint.upper))
                out_.axles[hinge.child] = hinge.axis;
        move_links(model);
        for (const Link& link : links_) add_link(link);
        return std::move(out_);
    }

private:
    struct Link {
        std::string name;  ///< with the names of the nested models that contain it: "arm::hand"
        const sdf::Link* link;
        Pose robot_from_link;
    };
    /// A joint at its zero position.
    struct Hinge {
        Joint joint;
        std::string parent, child;  ///< names of links
        Vec3 origin, axis;          ///< in the robot frame
    };

    /// Adds one notice for all harmless errors, and one for each unknown element. Throws FileError for any other error.
    void check(const sdf::Errors& errors)
    {
        const sdf::Error* first = nullptr;
        std::size_t harmless = 0;
        for (const sdf::Error& error : errors) {
            const SdfErrorKind kind = kind_of(error);
            if (kind == SdfErrorKind::Unknown) {
                out_.notices.push_back(text_of_error(error, file_.string()));
                continue;
            }
            if (kind != SdfErrorKind::Harmless)
                throw FileError(text_of_error(error, file_.string()), "the model cannot be read without it");
            if (harmless++ == 0) first = &error;
        }
        if (first == nullptr) return;
        out_.notices.push_back(text_of_error(*first, file_.string()) + " (this does not move any collision" +
                               (harmless > 1 ? "; and " + std::to_string(harmless - 1) + " more of this kind" : "") +
                               ")");
    }

    void collect(const sdf::Model& model, const Pose& robot_from_model, const std::string& prefix)
    {
        for (std::uint64_t k = 0; k < model.LinkCount(); ++k) {
            const sdf::Link& link = *model.LinkByIndex(k);
            links_.push_back({prefix + link.Name(), &link, robot_from_model * resolved(link.SemanticPose())});
        }
        for (std::uint64_t k = 0; k < model.JointCount(); ++k)
            hinges_.push_back(hinge_of(*model.JointByIndex(k), robot_from_model, prefix));
        for (std::uint64_t k = 0; k < model.ModelCount(); ++k) {
            const sdf::Model& inner = *model.ModelByIndex(k);
            collect(inner, robot_from_model * resolved(inner.SemanticPose()), prefix + inner.Name() + "::");
        }
    }

    Pose resolved(const sdf::SemanticPose& semantic, const std::string& frame = "__model__")
    {
        ignition::math::Pose3d pose;
        check(semantic.Resolve(pose, frame));
        return pose_of(pose);
    }

    Hinge hinge_of(const sdf::Joint& joint, const Pose& robot_from_model, const std::string& prefix)
    {
        Hinge hinge;
        hinge.joint.name = prefix + joint.Name();
        hinge.joint.motion = motion_of(joint.Type());
        hinge.joint.type = joint.Element()->Get<std::string>("type");
        check(joint.ResolveParentLink(hinge.parent));
        check(joint.ResolveChildLink(hinge.child));
        if (hinge.parent != "world") hinge.parent = prefix + hinge.parent;
        hinge.child = prefix + hinge.child;
        hinge.origin = (robot_from_model * resolved(joint.SemanticPose())).position;
        hinge.axis = Vec3::UnitZ();
        const sdf::JointAxis* const axis = joint.Axis();
        if (axis == nullptr) return hinge;
        ignition::math::Vector3d xyz;
        check(axis->ResolveXyz(xyz, "__model__"));
        hinge.axis = (robot_from_model.rotation * vector_of(xyz)).normalized();
        constexpr double unlimited = 1e15;  // libsdformat's default limits are 1e16
        if (axis->Lower() > -unlimited) hinge.joint.lower = axis->Lower();
        if (axis->Upper() < unlimited) hinge.joint.upper = axis->Upper();
        if (joint.Type() == sdf::JointType::CONTINUOUS)
            hinge.joint.upper = -(hinge.joint.lower = -std::numeric_limits<double>::infinity());
        return hinge;
    }

    /// Moves every link by the positions of the joints between it and the root. Then moves all links together so that
    /// the canonical link is where it was, because the model's frame is attached to it.
    void move_links(const sdf::Model& model)
    {
        std::vector<Joint> joints;
        for (const Hinge& hinge : hinges_) joints.push_back(hinge.joint);
        positions_ = joint_positions(file_.string(), joints, joints_, out_.notices);
        const bool moved = std::any_of(positions_.begin(), positions_.end(),
                                       [](const auto& entry) { return entry.second != 0; });
        if (!moved) return;
        const Pose canonical = motion_of_link(model.CanonicalLinkAndRelativeName().second, 0);
        const Mat3 back = canonical.rotation.transpose();
        const Pose still{-(back * canonical.position), back};  // inverse of `canonical`
        for (Link& link : links_) link.robot_from_link = still * motion_of_link(link.name, 0) * link.robot_from_link;
    }

    /// Returns how the joints between a link and the root move it, in the robot's frame. `depth` is the number of
    /// joints on the way so far. Throws FileError if the joints form a closed chain.
    Pose motion_of_link(const std::string& link, std::size_t depth) const
    {
        const Hinge* above = nullptr;
        for (const Hinge& hinge : hinges_) {
            if (hinge.child != link) continue;
            if (above != nullptr || depth > hinges_.size())
                throw FileError(file_.string(),
                                "joints cannot be given: link \"" + link + "\" is in a closed chain of joints");
            above = &hinge;
        }
        if (above == nullptr) return {};
        const auto value = positions_.find(above->joint.name);
        const Pose to_axis{above->origin, Mat3::Identity()}, from_axis{-above->origin, Mat3::Identity()};
        const Pose turned = value == positions_.end() ? Pose()
                                                      : joint_motion(above->joint.motion, above->axis, value->second);
        return motion_of_link(above->parent, depth + 1) * to_axis * turned * from_axis;
    }

    void add_link(const Link& link)
    {
        // libsdformat gives a link without <inertial> a mass of 1 kg.
        if (link.link->Element()->HasElement("inertial")) {
            const ignition::math::Inertiald& inertial = link.link->Inertial();
            const ignition::math::Matrix3d& moments = inertial.MassMatrix().Moi();
            Mat3 about_centre;
            for (int row = 0; row < 3; ++row)
                for (int col = 0; col < 3; ++col) about_centre(row, col) = moments(std::size_t(row), std::size_t(col));
            out_.add_mass(inertial.MassMatrix().Mass(), link.robot_from_link * pose_of(inertial.Pose()), about_centre);
        }
        for (std::uint64_t k = 0; k < link.link->CollisionCount(); ++k) {
            const sdf::Collision& collision = *link.link->CollisionByIndex(k);
            if (touches_nothing(collision)) {
                out_.notices.push_back(file_.string() + ": \"" + link.name + "::" + collision.Name() +
                                       "\" is ignored: by its <surface> it touches nothing");
                continue;
            }
            // With an empty frame name, libsdformat resolves the pose of a collision in the frame of its link.
            out_.bodies.push_back({{out_.name, link.name, collision.Name()},
                                   link.robot_from_link * resolved(collision.SemanticPose(), ""),
                                   geometry_of(*collision.Geom(), {file_, link.name + "::" + collision.Name(),
                                                                   collision.Element()->LineNumber()})});
        }
    }

    const fs::path file_;
    ModelPaths& paths_;
    const std::vector<JointPosition>& joints_;
    JointedModel out_;
    std::vector<Link> links_;
    std::vector<Hinge> hinges_;
    std::map<std::string, double> positions_;  ///< by name of the joint
};

}  // namespace

JointedModel sdf_module::read_model(const fs::path& file, ModelPaths& paths, const std::vector<JointPosition>& joints)
{
    return without_foreign_exceptions(file, [&] { return JointedModelReader(file, paths, joints).read(); });
}

}  // namespace spawnfield

#include "robot/sdf_robot.h"

#include "base/number.h"
#include "robot/ellipsoid.h"
#include "robot/joints.h"
#include "robot/mesh_parts.h"
#include "scene/model_paths.h"
#include "scene/sdf_includes.h"

#include <spawnfield/error.h>

#include <sdf/sdf.hh>
#include <Eigen/Geometry>

#include <cmath>
#include <mutex>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;

Vec3 vector_of(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

Pose pose_of(const ignition::math::Pose3d& pose)
{
    const auto& q = pose.Rot();
    return {vector_of(pose.Pos()), Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized().toRotationMatrix()};
}

/// libsdformat finds files through a global callback and prints on its own: both are held while one file is read.
class SdfSession {
public:
    explicit SdfSession(std::function<std::string(const std::string&)> find) : lock_(mutex())
    {
        sdf::Console::Instance()->SetQuiet(true);
        config_.SetFindCallback(find);
        config_.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);
        sdf::setFindCallback(std::move(find));  // nested includes ask this one
    }
    SdfSession(const SdfSession&) = delete;
    SdfSession& operator=(const SdfSession&) = delete;
    ~SdfSession()
    {
        sdf::setFindCallback([](const std::string&) { return std::string(); });
    }

    const sdf::ParserConfig& config() const { return config_; }

private:
    static std::mutex& mutex()
    {
        static std::mutex one;
        return one;
    }

    std::lock_guard<std::mutex> lock_;
    sdf::ParserConfig config_;
};

/// Where an error of libsdformat is and what it says; the file only if it is another than the one asked for.
std::string words_of(const sdf::Error& error, const fs::path& file)
{
    std::string text;
    if (error.FilePath() && *error.FilePath() != file.string()) text += *error.FilePath() + ": ";
    if (error.LineNumber()) text += "line " + std::to_string(*error.LineNumber()) + ": ";
    else if (error.XmlPath() && !error.XmlPath()->empty()) text += *error.XmlPath() + ": ";
    text += error.Message();
    if (error.Code() == sdf::ErrorCode::URI_LOOKUP) text += "; --model-path, GZ_SIM_RESOURCE_PATH or GAZEBO_MODEL_PATH tell where models are";
    return text;
}

/// What is about mass and age of the file, not about where collisions are.
bool is_harmless(sdf::ErrorCode code)
{
    switch (code) {
    case sdf::ErrorCode::LINK_INERTIA_INVALID:
    case sdf::ErrorCode::ATTRIBUTE_DEPRECATED:
    case sdf::ErrorCode::ELEMENT_DEPRECATED:
    case sdf::ErrorCode::VERSION_DEPRECATED: return true;
    default: return false;
    }
}

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

class SdfReader {
public:
    SdfReader(fs::path file, const RobotOptions& options)
        : file_(std::move(file)), options_(options), folders_(model_folders(options.model_paths, file_))
    {
        folders_.insert(folders_.end(), options.package_paths.begin(), options.package_paths.end());
    }

    Robot read()
    {
        const SdfSession session([this](const std::string& uri) { return find_uri(uri, file_.parent_path(), folders_).string(); });
        if (fs::is_directory(file_)) file_ = file_in(file_);
        refuse_cyclic_includes(file_, folders_);
        sdf::Root root;
        check(root.Load(file_.string(), session.config()));
        if (root.Model() == nullptr)
            throw FileError(file_.string(), root.WorldCount() > 0 ? "holds a <world>, needs a <model> to be a robot" : "has no <model>");
        const sdf::Model& model = *root.Model();
        robot_.name = model.Name();
        if (model.RawPose() != ignition::math::Pose3d::Zero)
            robot_.notices.push_back(file_.string() + ": the <pose> of model \"" + model.Name() + "\" does not count: poses are those of its own frame");
        collect(model, {}, "");
        move_links(model);
        for (const Link& link : links_) add_link(link);
        if (robot_.parts.empty()) throw FileError(file_.string(), "has no <collision>, needs at least one (<visual> does not count)");
        return std::move(robot_);
    }

private:
    struct Link {
        std::string name;  ///< with the nested models that it is in: "arm::hand"
        const sdf::Link* link;
        Pose robot_from_link;
    };
    /// A joint at its zero position.
    struct Hinge {
        Joint joint;
        std::string parent, child;  ///< links
        Vec3 origin, axis;          ///< robot frame
    };

    static fs::path file_in(const fs::path& folder)
    {
        if (!fs::is_regular_file(folder / "model.config")) throw FileError(folder.string(), "is a folder without model.config, so no SDF model");
        const fs::path file = sdf::getModelFilePath(folder.string());
        if (!fs::is_regular_file(file)) throw FileError((folder / "model.config").string(), "names no <sdf> file that is there");
        return file;
    }

    /// Harmless errors become one notice, all others an end.
    void check(const sdf::Errors& errors)
    {
        const sdf::Error* first = nullptr;
        std::size_t harmless = 0;
        for (const sdf::Error& error : errors) {
            if (!is_harmless(error.Code())) throw FileError(file_.string(), words_of(error, file_));
            if (harmless++ == 0) first = &error;
        }
        if (first == nullptr) return;
        robot_.notices.push_back(file_.string() + ": " + words_of(*first, file_) + " (where collisions are it does not change" +
                                 (harmless > 1 ? "; and " + std::to_string(harmless - 1) + " more such" : "") + ")");
    }

    void collect(const sdf::Model& model, const Pose& robot_from_model, const std::string& prefix)
    {
        for (std::uint64_t k = 0; k < model.LinkCount(); ++k) {
            const sdf::Link& link = *model.LinkByIndex(k);
            links_.push_back({prefix + link.Name(), &link, robot_from_model * resolved(link.SemanticPose())});
        }
        for (std::uint64_t k = 0; k < model.JointCount(); ++k) hinges_.push_back(hinge_of(*model.JointByIndex(k), robot_from_model, prefix));
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
        if (joint.Type() == sdf::JointType::CONTINUOUS) hinge.joint.upper = -(hinge.joint.lower = -std::numeric_limits<double>::infinity());
        return hinge;
    }

    /// Every link where the joints above it bring it; the canonical link, whose frame the model's hangs on, stays.
    void move_links(const sdf::Model& model)
    {
        std::vector<Joint> joints;
        for (const Hinge& hinge : hinges_) joints.push_back(hinge.joint);
        positions_ = joint_positions(file_.string(), joints, options_.joints, robot_.notices);
        const bool moved = std::any_of(positions_.begin(), positions_.end(), [](const auto& entry) { return entry.second != 0; });
        if (!moved) return;
        const Pose canonical = motion_of_link(model.CanonicalLinkAndRelativeName().second, 0);
        const Mat3 back = canonical.rotation.transpose();
        const Pose still{-(back * canonical.position), back};
        for (Link& link : links_) link.robot_from_link = still * motion_of_link(link.name, 0) * link.robot_from_link;
    }

    Pose motion_of_link(const std::string& link, std::size_t depth) const
    {
        const Hinge* above = nullptr;
        for (const Hinge& hinge : hinges_) {
            if (hinge.child != link) continue;
            if (above != nullptr || depth > hinges_.size())
                throw FileError(file_.string(), "joints cannot be given: link \"" + link + "\" hangs on several joints, a closed chain");
            above = &hinge;
        }
        if (above == nullptr) return {};
        const auto value = positions_.find(above->joint.name);
        const Pose to_axis{above->origin, Mat3::Identity()}, from_axis{-above->origin, Mat3::Identity()};
        const Pose turned = value == positions_.end() ? Pose() : joint_motion(above->joint.motion, above->axis, value->second);
        return motion_of_link(above->parent, depth + 1) * to_axis * turned * from_axis;
    }

    void add_link(const Link& link)
    {
        for (std::uint64_t k = 0; k < link.link->CollisionCount(); ++k) {
            const sdf::Collision& collision = *link.link->CollisionByIndex(k);
            // A resolved pose of a collision is in its link's frame.
            add_collision(link.name, collision, link.robot_from_link * resolved(collision.SemanticPose(), ""));
        }
    }

    void add_collision(const std::string& link, const sdf::Collision& collision, const Pose& pose)
    {
        const sdf::Geometry& geometry = *collision.Geom();
        const Place place{link, collision};
        RobotPart part;
        part.shape.pose = pose;
        switch (geometry.Type()) {
        case sdf::GeometryType::BOX:
            part.shape.size = positive(place, "<box> <size>", vector_of(geometry.BoxShape()->Size()));
            break;
        case sdf::GeometryType::SPHERE:
            part.shape.kind = ShapeKind::Sphere;
            part.shape.size = {positive(place, "<sphere> <radius>", geometry.SphereShape()->Radius()), 0, 0};
            break;
        case sdf::GeometryType::CYLINDER:
            part.shape.kind = ShapeKind::Cylinder;
            part.shape.size = {positive(place, "<cylinder> <radius>", geometry.CylinderShape()->Radius()),
                               positive(place, "<cylinder> <length>", geometry.CylinderShape()->Length()), 0};
            break;
        case sdf::GeometryType::CAPSULE:
            part.shape.kind = ShapeKind::Capsule;
            part.shape.size = {positive(place, "<capsule> <radius>", geometry.CapsuleShape()->Radius()),
                               positive(place, "<capsule> <length>", geometry.CapsuleShape()->Length()), 0};
            break;
        case sdf::GeometryType::ELLIPSOID: {
            const Vec3 radii = positive(place, "<ellipsoid> <radii>", vector_of(geometry.EllipsoidShape()->Radii()));
            part = ellipsoid_hull(radii, pose);
            tell_ellipsoid(place, part, radii);
            break;
        }
        case sdf::GeometryType::MESH: return add_mesh(place, *geometry.MeshShape(), pose);
        case sdf::GeometryType::PLANE: fail(place, "is a <plane>, which no robot can be made of: it has no end");
        case sdf::GeometryType::HEIGHTMAP: fail(place, "is a <heightmap>, which no robot can be made of: it has no thickness");
        case sdf::GeometryType::EMPTY: {
            const std::string kind = kind_of(collision);
            if (kind == "empty") return;
            fail(place, "is a <" + kind + ">, which is not known here; known: box, sphere, cylinder, capsule, ellipsoid, mesh");
        }
        }
        part.name = link;
        robot_.parts.push_back(std::move(part));
    }

    struct Place {
        const std::string& link;
        const sdf::Collision& collision;
    };

    void tell_ellipsoid(const Place& place, const RobotPart& part, const Vec3& radii)
    {
        const double growth = ellipsoid_growth(part, radii);
        char text[120];
        std::snprintf(text, sizeof text, "its ellipsoid counts as a polyhedron around it, %.1f %% more in volume", 100 * growth);
        robot_.notices.push_back(file_.string() + ": link \"" + place.link + "\": collision \"" + place.collision.Name() + "\": " + text);
    }

    void add_mesh(const Place& place, const sdf::Mesh& mesh, const Pose& pose)
    {
        const fs::path base = mesh.FilePath().empty() ? file_.parent_path() : fs::path(mesh.FilePath()).parent_path();
        const fs::path found = find_uri(mesh.Uri(), base, folders_);
        if (found.empty())
            fail(place, "<mesh> " + mesh.Uri() + " is not found; model:// is looked for in --model-path, GZ_SIM_RESOURCE_PATH, GAZEBO_MODEL_PATH and the "
                                                 "folders above the file, other names beside it");
        try {
            // As Gazebo takes COLLADA: its <unit> counts, its <up_axis> does not.
            append_mesh(robot_, {place.link, found, placed(chosen_nodes(mesh, read_mesh(found)), vector_of(mesh.Scale()), pose)},
                        options_.mesh_parts);
        } catch (const std::domain_error& error) {
            fail(place, "<mesh> cannot be used: " + found.string() + ": its convex hull has no volume: " + error.what());
        } catch (const FileError& error) {
            fail(place, std::string("<mesh> cannot be used: ") + error.what());
        }
    }

    /// All nodes, or those of the <submesh>, if so wished with the centre of their box at the origin.
    static std::vector<FileMesh::Node> chosen_nodes(const sdf::Mesh& mesh, FileMesh file)
    {
        if (mesh.Submesh().empty()) return std::move(file.nodes);
        std::vector<FileMesh::Node> out;
        std::string names;
        for (FileMesh::Node& node : file.nodes) {
            names += (names.empty() ? "" : ", ") + node.name;
            if (node.name == mesh.Submesh()) out.push_back(std::move(node));
        }
        if (out.empty()) throw FileError(mesh.Uri(), "has no submesh \"" + mesh.Submesh() + "\"; it has " + names);
        if (!mesh.CenterSubmesh()) return out;
        Bounds bounds;
        for (const FileMesh::Node& node : out)
            for (const Vec3& vertex : node.vertices) bounds.extend(vertex);
        for (FileMesh::Node& node : out)
            for (Vec3& vertex : node.vertices) vertex -= (bounds.min + bounds.max) / 2;
        return out;
    }

    static std::string kind_of(const sdf::Collision& collision)
    {
        const sdf::ElementPtr geometry = collision.Element()->GetElement("geometry");
        const sdf::ElementPtr shape = geometry ? geometry->GetFirstElement() : nullptr;
        return shape ? shape->GetName() : "empty";
    }

    double positive(const Place& place, const std::string& what, double value) const
    {
        if (!(value > 0) || !std::isfinite(value)) fail(place, what + " is " + number(value) + ", needs > 0");
        return value;
    }

    Vec3 positive(const Place& place, const std::string& what, const Vec3& value) const
    {
        for (const double x : value) positive(place, what, x);
        return value;
    }

    [[noreturn]] void fail(const Place& place, const std::string& what) const
    {
        const auto line = place.collision.Element()->LineNumber();
        throw FileError(file_.string(), "link \"" + place.link + "\": collision \"" + place.collision.Name() + "\": " + what +
                                            (line ? " (line " + std::to_string(*line) + ")" : ""));
    }

    fs::path file_;
    const RobotOptions& options_;
    std::vector<fs::path> folders_;
    Robot robot_;
    std::vector<Link> links_;
    std::vector<Hinge> hinges_;
    std::map<std::string, double> positions_;  ///< of joints
};

}  // namespace

Robot read_sdf_robot(const fs::path& file_or_folder, const RobotOptions& options) { return SdfReader(file_or_folder, options).read(); }

}  // namespace spawnfield

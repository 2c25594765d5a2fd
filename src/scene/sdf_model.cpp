#include "scene/sdf_model.h"

#include "base/number.h"

#include <spawnfield/error.h>

#include <console_bridge/console.h>
#include <sdf/sdf.hh>

#include <cmath>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;
using Kind = CollisionGeometry::Kind;

Vec3 vector_of(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

Pose pose_of(const ignition::math::Pose3d& pose)
{
    const ignition::math::Matrix3d m(pose.Rot());
    Pose out;
    out.position = vector_of(pose.Pos());
    for (unsigned row = 0; row < 3; ++row)
        for (unsigned col = 0; col < 3; ++col) out.rotation(row, col) = m(row, col);
    return out;
}

/// libsdformat and the URDF parser that it tries on what it does not understand both print; their words come as errors too.
class Silence {
public:
    Silence() : level_(console_bridge::getLogLevel())
    {
        sdf::Console::Instance()->SetQuiet(true);
        console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
    }
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;
    ~Silence()
    {
        console_bridge::setLogLevel(level_);
        sdf::Console::Instance()->SetQuiet(false);
    }

private:
    console_bridge::LogLevel level_;
};

/// The parser's search for includes, for as long as this lives: nested ones ask the global callback alone.
class IncludeSearch {
public:
    IncludeSearch(ModelPaths& paths, const fs::path& folder)
    {
        const auto find = [&paths, folder](const std::string& uri) { return paths.find(uri, folder).string(); };
        config_.SetFindCallback(find);
        sdf::setFindCallback(find);
    }
    IncludeSearch(const IncludeSearch&) = delete;
    IncludeSearch& operator=(const IncludeSearch&) = delete;
    ~IncludeSearch() { sdf::setFindCallback({}); }

    const sdf::ParserConfig& config() const { return config_; }

private:
    sdf::ParserConfig config_;
};

std::string words_of(const sdf::Error& error, const std::string& file)
{
    std::string out = error.FilePath().value_or(file);
    if (error.LineNumber()) out += ": line " + std::to_string(*error.LineNumber());
    if (error.XmlPath()) out += ": " + *error.XmlPath();
    return out + ": " + error.Message();
}

/// Poses are wrong, or lost, where frames are not understood.
bool is_about_frames(sdf::ErrorCode code)
{
    switch (code) {
    case sdf::ErrorCode::FRAME_ATTACHED_TO_INVALID:
    case sdf::ErrorCode::FRAME_ATTACHED_TO_CYCLE:
    case sdf::ErrorCode::POSE_RELATIVE_TO_INVALID:
    case sdf::ErrorCode::POSE_RELATIVE_TO_CYCLE:
    case sdf::ErrorCode::MODEL_PLACEMENT_FRAME_INVALID: return true;
    default: return false;
    }
}

bool is_of_no_account(const sdf::Error& error)
{
    // What is missing is told by who looked for it; that the world "failed to load" only repeats the errors before.
    return error.Code() == sdf::ErrorCode::URI_LOOKUP || error.Code() == sdf::ErrorCode::URI_INVALID ||
           error.Message() == "Failed to load a world." || error.Message() == "Failed to load a model.";
}

class SdfReader {
public:
    SdfReader(const fs::path& file, ModelPaths& paths) : file_(file), search_(paths, file.parent_path()) {}

    SdfContent read(const std::optional<std::string>& text)
    {
        sdf::Root root;
        sdf::Errors errors = text ? root.LoadSdfString(*text, search_.config()) : root.Load(file_.string(), search_.config());
        if (root.WorldCount() == 0 && root.Model() == nullptr) {
            if (text && !errors.empty()) errors = sdf::Root().Load(file_.string(), search_.config());  // for the lines of the file itself
            if (!errors.empty()) throw FileError(words_of(errors[0], file_.string()), "cannot be read as SDF");
            throw FileError(file_.string(), "has no <world> and no <model>, needs one of them");
        }
        if (root.WorldCount() > 1)
            throw FileError(file_.string(), "has " + std::to_string(root.WorldCount()) + " worlds, needs one: a simulator runs one at a time");
        sort(errors);
        if (root.WorldCount() == 1) add_world(*root.WorldByIndex(0));
        else add_lone_model(*root.Model());
        return std::move(content_);
    }

private:
    void sort(const sdf::Errors& errors)
    {
        std::size_t inertias = 0;
        for (const sdf::Error& error : errors) {
            if (is_about_frames(error.Code())) throw FileError(words_of(error, file_.string()), "no pose can be told");
            if (error.Code() == sdf::ErrorCode::LINK_INERTIA_INVALID) ++inertias;
            else if (!is_of_no_account(error)) content_.complaints.push_back(words_of(error, file_.string()));
        }
        if (inertias > 0)
            content_.complaints.push_back(file_.string() + ": " + std::to_string(inertias) + (inertias == 1 ? " link has" : " links have") +
                                          " an invalid <inertia>: it counts for nothing here, but Gazebo may refuse it");
    }

    void add_world(const sdf::World& world)
    {
        content_.name = world.Name();
        content_.model_count = world.ModelCount();
        for (std::uint64_t m = 0; m < world.ModelCount(); ++m) {
            const sdf::Model& model = *world.ModelByIndex(m);
            names_ = {model.Name()};
            add_model(model, resolved(model.SemanticPose()));
        }
    }

    void add_lone_model(const sdf::Model& model)
    {
        content_.name = model.Name();
        content_.model_count = 1;
        content_.is_plain_model = model.PlacementFrameName().empty() && model.PoseRelativeTo().empty();
        content_.pose = pose_of(model.RawPose());
        names_ = {model.Name()};
        add_model(model, {});
    }

    /// `pose` is that of the model in the content's frame; `names_` ends with the model's.
    void add_model(const sdf::Model& model, const Pose& pose)
    {
        const std::size_t before = content_.bodies.size();
        for (std::uint64_t l = 0; l < model.LinkCount(); ++l) {
            const sdf::Link& link = *model.LinkByIndex(l);
            names_.push_back(link.Name());
            add_link(link, pose * resolved(link.SemanticPose()));
            names_.pop_back();
        }
        for (std::uint64_t m = 0; m < model.ModelCount(); ++m) {
            const sdf::Model& nested = *model.ModelByIndex(m);
            names_.push_back(nested.Name());
            add_model(nested, pose * resolved(nested.SemanticPose()));
            names_.pop_back();
        }
        if (content_.bodies.size() == before && names_.size() == 1) content_.bare_models.push_back(model.Name());
    }

    void add_link(const sdf::Link& link, const Pose& pose)
    {
        for (std::uint64_t c = 0; c < link.CollisionCount(); ++c) {
            const sdf::Collision& collision = *link.CollisionByIndex(c);
            names_.push_back(collision.Name());
            content_.bodies.push_back({names_, pose * resolved(collision.SemanticPose()), {}});
            if (collision.Geom() != nullptr) content_.bodies.back().geometry = geometry_of(*collision.Geom());
            names_.pop_back();
        }
    }

    Pose resolved(const sdf::SemanticPose& semantic) const
    {
        ignition::math::Pose3d pose;
        const sdf::Errors errors = semantic.Resolve(pose);
        if (!errors.empty()) throw FileError(file_.string(), place() + ": its pose cannot be told: " + errors[0].Message());
        if (!pose.IsFinite()) throw FileError(file_.string(), place() + ": its pose has numbers that are not finite");
        return pose_of(pose);
    }

    CollisionGeometry geometry_of(const sdf::Geometry& from) const
    {
        CollisionGeometry out;
        switch (from.Type()) {
        case sdf::GeometryType::BOX: set(out, Kind::Box, "<box> <size>", vector_of(from.BoxShape()->Size())); break;
        case sdf::GeometryType::SPHERE: set(out, Kind::Sphere, "<sphere> <radius>", Vec3(from.SphereShape()->Radius(), 1, 1)); break;
        case sdf::GeometryType::CYLINDER:
            set(out, Kind::Cylinder, "<cylinder> <radius>, <length>", Vec3(from.CylinderShape()->Radius(), from.CylinderShape()->Length(), 1));
            break;
        case sdf::GeometryType::CAPSULE:
            set(out, Kind::Capsule, "<capsule> <radius>, <length>", Vec3(from.CapsuleShape()->Radius(), from.CapsuleShape()->Length(), 1));
            break;
        case sdf::GeometryType::ELLIPSOID: set(out, Kind::Ellipsoid, "<ellipsoid> <radii>", vector_of(from.EllipsoidShape()->Radii())); break;
        case sdf::GeometryType::PLANE:
            set(out, Kind::Plane, "<plane> <size>", Vec3(from.PlaneShape()->Size().X(), from.PlaneShape()->Size().Y(), 1));
            out.normal = vector_of(from.PlaneShape()->Normal());
            if (!(out.normal.norm() > 0) || !out.normal.allFinite()) fail("<plane> <normal> is (" + list(out.normal) + "), needs a direction");
            break;
        case sdf::GeometryType::MESH: set_mesh(out, *from.MeshShape()); break;
        case sdf::GeometryType::HEIGHTMAP: set_heightmap(out, *from.HeightmapShape()); break;
        default: set_by_element(out, from.Element());
        }
        return out;
    }

    void set(CollisionGeometry& out, Kind kind, const std::string& what, const Vec3& size) const
    {
        constexpr double largest = 1e6;  // m: beyond it, a slip of the pen
        for (const double side : size)
            if (!(side > 0) || side > largest) fail(what + " is " + number(side) + ", needs > 0 and at most 1000 km");
        out.kind = kind;
        out.size = size;
    }

    void set_mesh(CollisionGeometry& out, const sdf::Mesh& mesh) const
    {
        out.kind = Kind::Mesh;
        out.uri = mesh.Uri();
        out.folder = folder_of(mesh.FilePath());
        out.size = vector_of(mesh.Scale());
        out.submesh = mesh.Submesh();
        out.is_centred = mesh.CenterSubmesh();
        if (!out.size.allFinite() || out.size.cwiseAbs().minCoeff() == 0) fail("<mesh> <scale> is (" + list(out.size) + "), needs three numbers that are not 0");
    }

    void set_heightmap(CollisionGeometry& out, const sdf::Heightmap& map) const
    {
        set(out, Kind::Heightmap, "<heightmap> <size>", vector_of(map.Size()).cwiseAbs());
        out.uri = map.Uri();
        out.folder = folder_of(map.FilePath());
        out.position = vector_of(map.Position());
        out.sampling = map.Sampling();
        if (out.sampling < 1 || out.sampling > 16) fail("<heightmap> <sampling> is " + std::to_string(out.sampling) + ", needs 1 to 16");
    }

    /// What libsdformat 12 has no class for.
    void set_by_element(CollisionGeometry& out, const sdf::ElementPtr& element) const
    {
        if (!element || !element->HasElement("polyline")) {
            const sdf::ElementPtr child = element ? element->GetFirstElement() : nullptr;
            if (child) out.element = child->GetName();
            return;
        }
        double height = 0;
        for (sdf::ElementPtr line = element->GetElement("polyline"); line; line = line->GetNextElement("polyline")) {
            if (height == 0) height = line->Get<double>("height");  // of the first, as Gazebo has it
            auto& outline = out.outlines.emplace_back();
            for (sdf::ElementPtr point = line->HasElement("point") ? line->GetElement("point") : nullptr; point; point = point->GetNextElement("point")) {
                const auto at = point->Get<ignition::math::Vector2d>();
                outline.push_back({at.X(), at.Y()});
            }
        }
        set(out, Kind::Polyline, "<polyline> <height>", Vec3(height, 1, 1));
    }

    /// A file's text that was given has a name in brackets.
    fs::path folder_of(const std::string& named) const
    {
        return named.empty() || named.front() == '<' || !fs::exists(named) ? file_.parent_path() : fs::path(named).parent_path();
    }

    static std::string list(const Vec3& v) { return number(v.x()) + ", " + number(v.y()) + ", " + number(v.z()); }

    std::string place() const
    {
        std::string out;
        for (const std::string& name : names_) out += (out.empty() ? "" : "::") + name;
        return "\"" + out + "\"";
    }

    [[noreturn]] void fail(const std::string& what) const { throw FileError(file_.string(), place() + ": " + what); }

    const fs::path file_;
    const Silence silence_;
    const IncludeSearch search_;
    SdfContent content_;
    std::vector<std::string> names_;  ///< of what is being read, from the outermost model in
};

}  // namespace

std::string scoped_name(const CollisionBody& body)
{
    std::string out;
    for (const std::string& name : body.names) out += (out.empty() ? "" : "::") + name;
    return out;
}

SdfContent read_sdf_file(const fs::path& file, ModelPaths& paths, const std::optional<std::string>& text)
{
    return SdfReader(file, paths).read(text);
}

}  // namespace spawnfield

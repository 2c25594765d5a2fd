#include "sdf/sdf_parser.h"

#include "base/number.h"
#include "base/text.h"

#include <spawnfield/error.h>
#include <spawnfield/input_file.h>

#include <console_bridge/console.h>

namespace spawnfield {
namespace {

namespace fs = std::filesystem;
using Kind = CollisionGeometry::Kind;

std::mutex& one_at_a_time()
{
    static std::mutex mutex;
    return mutex;
}

std::string list(const Vec3& v) { return number(v.x()) + ", " + number(v.y()) + ", " + number(v.z()); }

class GeometryReader {
public:
    explicit GeometryReader(const SdfPlace& place) : place_(place) {}

    CollisionGeometry read(const sdf::Geometry& from) const
    {
        CollisionGeometry out;
        out.line = place_.line;
        check_count(from.Element());
        switch (from.Type()) {
        case sdf::GeometryType::BOX: set(out, Kind::Box, "<box> <size>", vector_of(from.BoxShape()->Size())); break;
        case sdf::GeometryType::SPHERE:
            set(out, Kind::Sphere, "<sphere> <radius>", Vec3(from.SphereShape()->Radius(), 1, 1));
            break;
        case sdf::GeometryType::CYLINDER:
            set(out, Kind::Cylinder, "<cylinder> <radius>, <length>",
                Vec3(from.CylinderShape()->Radius(), from.CylinderShape()->Length(), 1));
            break;
        case sdf::GeometryType::CAPSULE:
            set(out, Kind::Capsule, "<capsule> <radius>, <length>",
                Vec3(from.CapsuleShape()->Radius(), from.CapsuleShape()->Length(), 1));
            break;
        case sdf::GeometryType::ELLIPSOID:
            set(out, Kind::Ellipsoid, "<ellipsoid> <radii>", vector_of(from.EllipsoidShape()->Radii()));
            break;
        case sdf::GeometryType::PLANE:
            out.kind = Kind::Plane;
            out.size = Vec3::Zero();
            out.normal = vector_of(from.PlaneShape()->Normal());
            if (!(out.normal.norm() > 0) || !out.normal.allFinite())
                fail("<plane> <normal> is (" + list(out.normal) + "), needs a direction");
            break;
        case sdf::GeometryType::MESH: set_mesh(out, *from.MeshShape()); break;
        case sdf::GeometryType::HEIGHTMAP: set_heightmap(out, *from.HeightmapShape()); break;
        default: set_by_element(out, from.Element());
        }
        return out;
    }

private:
    /// Throws FileError if a <geometry> contains shapes of several kinds. It may contain several <polyline>.
    void check_count(const sdf::ElementPtr& geometry) const
    {
        std::string shapes;
        for (sdf::ElementPtr shape = geometry ? geometry->GetFirstElement() : nullptr; shape;
             shape = shape->GetNextElement(""))
            if (const std::string name = "<" + shape->GetName() + ">"; shapes.find(name) == std::string::npos)
                shapes += (shapes.empty() ? "" : ", ") + name;
        if (shapes.find(',') != std::string::npos)
            fail("<geometry> contains " + shapes + ", needs one shape; give each a <collision> of its own");
    }

    void set(CollisionGeometry& out, Kind kind, const std::string& what, const Vec3& size) const
    {
        constexpr double largest = 1e6;  // m; a larger number is most likely a typing error
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
        if (!out.size.allFinite() || out.size.cwiseAbs().minCoeff() == 0)
            fail("<mesh> <scale> is (" + list(out.size) + "), needs three numbers that are not 0");
    }

    void set_heightmap(CollisionGeometry& out, const sdf::Heightmap& map) const
    {
        set(out, Kind::Heightmap, "<heightmap> <size>", vector_of(map.Size()));
        out.uri = map.Uri();
        out.folder = folder_of(map.FilePath());
        out.position = vector_of(map.Position());
        out.sampling = map.Sampling();
        if (out.sampling < 1 || out.sampling > 16)
            fail("<heightmap> <sampling> is " + std::to_string(out.sampling) + ", needs 1 to 16");
    }

    /// Reads geometry for which libsdformat 12 has no class.
    void set_by_element(CollisionGeometry& out, const sdf::ElementPtr& element) const
    {
        if (!element || !element->HasElement("polyline")) {
            const sdf::ElementPtr child = element ? element->GetFirstElement() : nullptr;
            if (child) out.element = child->GetName();
            return;
        }
        double height = 0;
        for (sdf::ElementPtr line = element->GetElement("polyline"); line; line = line->GetNextElement("polyline")) {
            if (height == 0) height = line->Get<double>("height");  // of the first <polyline>, as in Gazebo
            auto& outline = out.outlines.emplace_back();
            for (sdf::ElementPtr point = line->HasElement("point") ? line->GetElement("point") : nullptr; point;
                 point = point->GetNextElement("point")) {
                const auto xy = point->Get<ignition::math::Vector2d>();
                outline.push_back({xy.X(), xy.Y()});
            }
        }
        set(out, Kind::Polyline, "<polyline> <height>", Vec3(height, 1, 1));
    }

    /// Returns the folder of the file that contains the geometry. libsdformat gives text in memory a name in angle
    /// brackets. Then this is the folder of the file in SdfPlace.
    fs::path folder_of(const std::string& named) const
    {
        return named.empty() || named.front() == '<' || !does_exist(named) ? place_.file.parent_path()
                                                                           : fs::path(named).parent_path();
    }

    [[noreturn]] void fail(const std::string& what) const
    {
        throw FileError(place_.file.string(), "\"" + place_.name + "\": " + what +
                                                  (place_.line ? " (line " + std::to_string(*place_.line) + ")" : ""));
    }

    const SdfPlace& place_;
};

/// Returns an <sdf> element that can be filled. libsdformat copies the descriptions of the elements in it before it
/// fills them, so all documents share them.
sdf::ElementPtr empty_document()
{
    static const sdf::SDFPtr all_elements = [] {
        sdf::SDFPtr out(new sdf::SDF);
        sdf::init(out);
        return out;
    }();
    const sdf::ElementPtr from = all_elements->Root(), out(new sdf::Element);
    out->SetName(from->GetName());
    out->SetRequired(from->GetRequired());
    out->SetDescription(from->GetDescription());
    for (const sdf::ParamPtr& attribute : from->GetAttributes())
        out->AddAttribute(attribute->GetKey(), attribute->GetTypeName(), attribute->GetDefaultAsString(),
                          attribute->GetRequired(), attribute->GetDescription());
    for (unsigned int k = 0; k < from->GetElementDescriptionCount(); ++k)
        out->AddElementDescription(from->GetElementDescription(k));
    return out;
}

}  // namespace

SdfSession::SdfSession(ModelPaths& paths, const fs::path& folder)
    : lock_(one_at_a_time()), log_level_(console_bridge::getLogLevel())
{
    const auto find = [&paths, folder](const std::string& uri) { return paths.find(uri, folder).string(); };
    config_.SetFindCallback(find);
    config_.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
    sdf::setFindCallback(find);
    sdf::Console::Instance()->SetQuiet(true);
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
}

SdfSession::~SdfSession()
{
    console_bridge::setLogLevel(console_bridge::LogLevel(log_level_));
    sdf::setFindCallback([](const std::string&) { return std::string(); });
}

sdf::Errors load(sdf::Root& root, const fs::path& file, const std::optional<std::string>& text,
                 const sdf::ParserConfig& config)
{
    const sdf::SDFPtr document(new sdf::SDF);
    document->Root(empty_document());
    sdf::Errors errors;
    const bool is_read = text ? sdf::readString(*text, config, document, errors)
                              : sdf::readFile(path_for_libsdformat(file), config, document, errors);
    if (!is_read) {
        errors.emplace_back(sdf::ErrorCode::FILE_READ, "Unable to read file:" + path_for_libsdformat(file));
        return errors;
    }
    const sdf::Errors of_content = root.Load(document, config);
    errors.insert(errors.end(), of_content.begin(), of_content.end());
    return errors;
}

SdfErrorKind kind_of(const sdf::Error& error)
{
    switch (error.Code()) {
    case sdf::ErrorCode::FRAME_ATTACHED_TO_INVALID:
    case sdf::ErrorCode::FRAME_ATTACHED_TO_CYCLE:
    case sdf::ErrorCode::POSE_RELATIVE_TO_INVALID:
    case sdf::ErrorCode::POSE_RELATIVE_TO_CYCLE:
    case sdf::ErrorCode::MODEL_PLACEMENT_FRAME_INVALID: return SdfErrorKind::Frames;
    case sdf::ErrorCode::DUPLICATE_NAME: return SdfErrorKind::Duplicate;
    case sdf::ErrorCode::LINK_INERTIA_INVALID:
    case sdf::ErrorCode::ATTRIBUTE_DEPRECATED:
    case sdf::ErrorCode::ELEMENT_DEPRECATED:
    case sdf::ErrorCode::VERSION_DEPRECATED: return SdfErrorKind::Harmless;
    case sdf::ErrorCode::URI_LOOKUP:
    case sdf::ErrorCode::URI_INVALID:
        return SdfErrorKind::Repeated;  // the code that looks for a file reports that it is missing
    default: break;
    }
    const std::string words = error.Message();
    if (words.find("not defined in SDF") != std::string::npos) return SdfErrorKind::Unknown;
    return words == "Failed to load a world." || words == "Failed to load a model." ? SdfErrorKind::Repeated
                                                                                    : SdfErrorKind::Other;
}

std::string path_for_libsdformat(const fs::path& file) { return fs::absolute(file).string(); }

std::string text_of_error(const sdf::Error& error, const std::string& file)
{
    std::string out = error.FilePath().value_or(file);
    if (out.empty() || out.front() == '<' || out == path_for_libsdformat(file))
        out = file;  // libsdformat gives text in memory a name in angle brackets
    if (error.LineNumber()) out += ": line " + std::to_string(*error.LineNumber());
    if (error.XmlPath()) out += ": " + *error.XmlPath();
    const SdfErrorKind kind = kind_of(error);
    if (kind == SdfErrorKind::Unknown)
        return out + ": is not an SDF element at this place, so it is ignored; is it misspelt?";
    out += ": " + trimmed(error.Message());
    if (kind == SdfErrorKind::Duplicate) out += " It is ignored; give it a name of its own";
    if (error.Code() == sdf::ErrorCode::URI_LOOKUP)
        out += "; give the folder of the models with --model-path, GZ_SIM_RESOURCE_PATH or GAZEBO_MODEL_PATH";
    return out;
}

Vec3 vector_of(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

Pose pose_of(const ignition::math::Pose3d& pose)
{
    const ignition::math::Matrix3d m(pose.Rot().Normalized());
    Pose out;
    out.position = vector_of(pose.Pos());
    for (unsigned row = 0; row < 3; ++row)
        for (unsigned col = 0; col < 3; ++col) out.rotation(row, col) = m(row, col);
    return out;
}

bool touches_nothing(const sdf::Collision& collision)
{
    const sdf::Surface* const surface = collision.Surface();
    if (surface == nullptr || surface->Contact() == nullptr) return false;
    const sdf::ElementPtr contact = surface->Contact()->Element();
    const bool without = contact && contact->HasElement("collide_without_contact") &&
                         contact->Get<bool>("collide_without_contact");
    return without || surface->Contact()->CollideBitmask() == 0;
}

bool is_empty(const sdf::Geometry& geometry)
{
    if (geometry.Type() != sdf::GeometryType::EMPTY) return false;
    const sdf::ElementPtr shape = geometry.Element() ? geometry.Element()->GetFirstElement() : nullptr;
    return !shape || shape->GetName() == "empty";
}

CollisionGeometry geometry_of(const sdf::Geometry& geometry, const SdfPlace& place)
{
    return GeometryReader(place).read(geometry);
}

}  // namespace spawnfield

#include "export/part_surfaces.h"
#include "export/tessellation.h"
#include "picture/palette.h"

#include <spawnfield/error.h>
#include <spawnfield/frames.h>
#include <spawnfield/map_export.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <cmath>

namespace spawnfield {
namespace {

using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Point rounded(const Vec3& point, const Vec3& origin)
{
    const Vec3 p = point_in(Frame::Gltf, point - origin);
    return {float(p.x()), float(p.y()), float(p.z())};
}

// ---------------------------------------------------------------- the file

/// A JSON array that is kept as text, because a million nodes as objects would take gigabytes.
class JsonArray {
public:
    std::size_t add(const Json& json)
    {
        text_ += (size_ > 0 ? "," : "") + dumped(json);
        return size_++;
    }
    std::size_t size() const { return size_; }
    std::string take() { return "[" + std::move(text_) + "]"; }

private:
    std::string text_;
    std::size_t size_ = 0;
};

/// Returns the light of a colour channel, which glTF needs, from the value for a screen (sRGB, IEC 61966-2-1). Four
/// digits are more than a screen can show.
double linear(std::uint32_t channel)
{
    const double c = double(channel) / 255;
    return std::round(1e4 * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4))) / 1e4;
}

class GlbFile {
public:
    JsonArray nodes;

    std::size_t material(const std::string& name, std::uint32_t colour, double alpha = 1)
    {
        const auto known = std::find(material_names_.begin(), material_names_.end(), name);
        if (known != material_names_.end()) return std::size_t(known - material_names_.begin());
        material_names_.push_back(name);
        const Json light{linear(colour >> 16), linear(colour >> 8 & 255), linear(colour & 255), alpha};
        Json json{{"name", name},
                  {"pbrMetallicRoughness", {{"baseColorFactor", light}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
                  {"doubleSided", true}};
        if (alpha < 1) json["alphaMode"] = "BLEND";
        return materials_.add(json);
    }

    /// Adds the corners and indices of a surface to the file. Returns the primitive for a mesh.
    Json primitive(const Surface& surface, std::size_t material)
    {
        Point low = surface.points().front(), high = low;
        for (const Point& point : surface.points())
            for (std::size_t axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], point[axis]);
                high[axis] = std::max(high[axis], point[axis]);
            }
        const std::size_t position = accessors_.add({{"bufferView", 0},
                                                     {"byteOffset", points_.size()},
                                                     {"componentType", 5126},
                                                     {"count", surface.points().size()},
                                                     {"type", "VEC3"},
                                                     {"min", low},
                                                     {"max", high}});
        const std::size_t index = accessors_.add({{"bufferView", 1},
                                                  {"byteOffset", indices_.size()},
                                                  {"componentType", 5125},
                                                  {"count", surface.indices().size()},
                                                  {"type", "SCALAR"}});
        append(points_, surface.points());
        append(indices_, surface.indices());
        return {{"attributes", {{"POSITION", position}}}, {"indices", index}, {"material", material}};
    }

    std::size_t mesh(const std::string& name, const Json& primitives)
    {
        return meshes_.add({{"name", name}, {"primitives", primitives}});
    }

    void write(const Map& map, std::size_t root, const std::function<void(std::string_view)>& sink)
    {
        std::string json = head(map, root);
        json.resize((json.size() + 3) / 4 * 4, ' ');
        const std::uint64_t data = points_.size() + indices_.size();  // both are multiples of 4
        const std::uint64_t total = 12 + 8 + json.size() + (data > 0 ? 8 + data : 0);
        if (total > 0xffffffff)
            throw OutputError(map.name + " as GLB",
                              "would have " + std::to_string(total) +
                                  " bytes, the format holds at most 4294967295; leave parts out of the scene");
        const auto word = [](std::uint64_t value) {
            const auto typed = std::uint32_t(value);
            return std::string(reinterpret_cast<const char*>(&typed), sizeof typed);
        };
        sink("glTF" + word(2) + word(total) + word(json.size()) + "JSON" + json);
        if (data == 0) return;
        sink(word(data) + std::string("BIN\0", 4));
        for (const std::string* part : {&points_, &indices_}) {
            constexpr std::size_t piece = 1 << 20;
            for (std::size_t begin = 0; begin < part->size(); begin += piece)
                sink(std::string_view(*part).substr(begin, piece));
        }
    }

private:
    template <class T>
    static void append(std::string& bytes, const std::vector<T>& values)
    {
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }

    std::string head(const Map& map, std::size_t root)
    {
        Json json{{"asset",
                   {{"version", "2.0"},
                    {"generator", "spawnfield " + version()},
                    {"extras", {{"map", map.name}, {"map_hash", map.hash}}}}},
                  {"scene", 0},
                  {"scenes", {{{"nodes", {root}}}}}};
        std::string text = dumped(json);
        text.pop_back();
        text += ",\"nodes\":" + nodes.take();
        if (meshes_.size() > 0) {
            json = {
                {{"buffer", 0}, {"byteLength", points_.size()}, {"byteStride", sizeof(Point)}, {"target", 34962}},
                {{"buffer", 0}, {"byteOffset", points_.size()}, {"byteLength", indices_.size()}, {"target", 34963}}};
            text += ",\"materials\":" + materials_.take() + ",\"meshes\":" + meshes_.take() +
                    ",\"accessors\":" + accessors_.take();
            text += ",\"bufferViews\":" + dumped(json) +
                    ",\"buffers\":[{\"byteLength\":" + std::to_string(points_.size() + indices_.size()) + "}]";
        }
        return text + "}";
    }

    std::vector<std::string> material_names_;
    JsonArray materials_, meshes_, accessors_;
    std::string points_, indices_;
};

// ---------------------------------------------------------------- parts

struct Look {
    std::uint32_t colour;
    double alpha;
};

/// Returns the look of a label. Labels differ in lightness. Terrain and obstacles are nearly grey, unlike the verdicts.
Look look_of(Label label)
{
    switch (label) {
    case Label::Terrain: return {0xd9d4c7, 1};
    case Label::Obstacle: return {0x666666, 1};
    default: return {0x0072b2, 0.6};
    }
}

/// Adds a node with the part's name and returns its number; nothing if the whole part is ignored.
std::optional<std::size_t> add_part(GlbFile& file, const std::string& name, const PartSurfaces& surfaces)
{
    Json list = Json::array();
    for (std::size_t label = 0; label < surfaces.size(); ++label) {
        if (surfaces[label].empty()) continue;
        const auto [colour, alpha] = look_of(Label(label));
        list.push_back(file.primitive(surfaces[label], file.material(to_string(Label(label)), colour, alpha)));
    }
    if (list.empty()) return std::nullopt;
    return file.nodes.add({{"name", name}, {"mesh", file.mesh(name, list)}});
}

// ---------------------------------------------------------------- markers

Surface marker_surface(const Robot* robot)
{
    Surface out;
    const Vec3 origin = Vec3::Zero();
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        out.add(rounded(a, origin), rounded(b, origin), rounded(c, origin));
    };
    if (robot == nullptr) {
        tessellate_cone(origin, Vec3::UnitX(), 0.25, 16, add);
        return out;
    }
    for (const RobotPart& part : robot->parts) tessellate(part, 32, add);
    const Bounds bounds = robot->bounds();
    const double length = bounds.max.x() - bounds.min.x();
    const Vec3 centre = (bounds.min + bounds.max) / 2, top(centre.x(), centre.y(), bounds.max.z() + length / 8);
    tessellate_cone(top, top + Vec3(length / 2, 0, 0), length / 8, 16, add);
    return out;
}

/// Adds the markers of poses to a file. The meshes of all verdicts share their corners.
class Markers {
public:
    Markers(GlbFile& file, const GlbMarkers& markers) : file_(file), markers_(markers)
    {
        if (!markers.poses.empty()) primitive_ = file.primitive(marker_surface(markers.robot), 0);
    }

    std::size_t add(std::size_t pose, const Vec3& origin)
    {
        const auto& [position, rotation] = markers_.poses[pose];
        const Vec3 place = point_in(Frame::Gltf, position - origin);
        Eigen::Quaterniond q(rotation_in(Frame::Gltf, rotation));
        if (q.w() < 0) q.coeffs() = -q.coeffs();
        q.coeffs().array() += 0.0;  // turns -0 into 0
        Json json{{"name", markers_.names.empty() ? "spawn " + std::to_string(pose) : markers_.names[pose]},
                  {"mesh", mesh_of(pose)},
                  {"translation", {place.x(), place.y(), place.z()}},
                  {"rotation", {q.x(), q.y(), q.z(), q.w()}}};
        if (!markers_.verdicts.empty()) json["extras"] = {{"verdict", to_string(markers_.verdicts[pose])}};
        return file_.nodes.add(json);
    }

private:
    std::size_t mesh_of(std::size_t pose)
    {
        const std::size_t verdict = std::size_t(markers_.verdicts.empty() ? Verdict::Valid : markers_.verdicts[pose]);
        std::optional<std::size_t>& mesh = meshes_[verdict];
        if (mesh) return *mesh;
        const std::string name = markers_.verdicts.empty() ? "spawn"
                                                           : std::string("spawn ") + to_string(Verdict(verdict));
        primitive_["material"] = file_.material(name, verdict_palette[verdict]);
        mesh = file_.mesh(name, Json::array({primitive_}));
        return *mesh;
    }

    GlbFile& file_;
    const GlbMarkers& markers_;
    Json primitive_;
    std::array<std::optional<std::size_t>, verdict_count> meshes_;
};

void check(const GlbMarkers& markers)
{
    const std::size_t poses = markers.poses.size();
    const auto fits = [&](const char* name, std::size_t size) {
        if (size != 0 && size != poses)
            throw ArgumentError("write_glb", name, double(size),
                                "one for each of the " + std::to_string(poses) + " poses, or none");
    };
    fits("markers.verdicts", markers.verdicts.size());
    fits("markers.names", markers.names.size());
}

}  // namespace

void write_glb(const Map& map, const GlbMarkers& markers, const std::function<void(std::string_view)>& sink,
               int threads, const Progress& progress)
{
    check(markers);
    const Bounds& bounds = map.geometry.bounds();
    const Vec3 origin = bounds.is_empty() ? Vec3::Zero() : Vec3(((bounds.min + bounds.max) / 2).array().round());
    const std::vector<Part>& parts = map.geometry.parts();
    GlbFile file;
    std::vector<std::size_t> children;
    const auto to_point = [&](const Vec3& corner) { return rounded(corner, origin); };
    for_each_part(map.geometry, to_point, threads, [&](std::size_t part, const PartSurfaces& surfaces) {
        if (const auto node = add_part(file, parts[part].name, surfaces)) children.push_back(*node);
        if (progress) progress(double(part + 1) / double(parts.size()));
    });
    if (!markers.poses.empty()) {
        Markers drawn(file, markers);
        std::vector<std::size_t> spawns;
        for (std::size_t pose = 0; pose < markers.poses.size(); ++pose) spawns.push_back(drawn.add(pose, origin));
        children.push_back(file.nodes.add({{"name", "spawns"}, {"children", spawns}}));
    }
    const Vec3 place = point_in(Frame::Gltf, origin);
    Json root{{"name", map.name}};
    if (!children.empty()) root["children"] = children;
    if (place != Vec3::Zero()) root["translation"] = {place.x(), place.y(), place.z()};
    file.write(map, file.nodes.add(root), sink);
}

}  // namespace spawnfield

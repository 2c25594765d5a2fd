#include "base/parallel.h"
#include "export/tessellation.h"
#include "geometry/geometry_impl.h"
#include "picture/palette.h"

#include <spawnfield/error.h>
#include <spawnfield/frames.h>
#include <spawnfield/map_export.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <unordered_map>

namespace spawnfield {
namespace {

using Json = nlohmann::ordered_json;
using Point = std::array<float, 3>;

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

// ---------------------------------------------------------------- the scene's elements, in its order

struct CornersOfTriangle {
    std::array<Point, 3> corners;  ///< y up, relative to the file's origin
    std::uint32_t part = 0;
    Label label = Label::Terrain;
};

struct Elements {
    std::vector<CornersOfTriangle> triangles;
    std::vector<Primitive> primitives;
};

Point rounded(const Vec3& point, const Vec3& origin)
{
    const Vec3 p = point_in(Frame::Gltf, point - origin);
    return {float(p.x()), float(p.y()), float(p.z())};
}

/// Calls visit(tile, element) for each element of the scene, on several threads.
template <class Visit>
void for_each_element(const Geometry::Impl& geometry, int threads, const Visit& visit)
{
    geometry.for_each_tree([&](const Forest& forest, std::size_t tree) {
        parallel_for(forest.trees[tree].boxes().size(), threads, {}, [&](std::size_t t) {
            const Tile tile = geometry.open(forest, tree, t);
            for (const std::uint32_t id : tile.ids)
                if (id >= geometry.next.element) forest.tiles.fail_inconsistent();
            for_each_bit(tile.alive, [&](std::uint32_t element) { visit(tile, element); });
        });
    });
}

/// Returns the scene's elements in the scene's order. Tiles have another order; the numbers of elements are ascending
/// in the scene, but some may be missing in a changed scene.
Elements elements_of(const Geometry& geometry, const Vec3& origin, int threads)
{
    enum class Kind : std::uint8_t { None, Triangle, Primitive };
    const auto kind_of = [](const Tile& tile, std::uint32_t element) {
        return tile.is_triangle(element) ? Kind::Triangle : Kind::Primitive;
    };
    const Geometry::Impl& impl = geometry.impl();
    impl.expect_all();
    std::vector<Kind> kinds(impl.next.element, Kind::None);
    for_each_element(impl, threads, [&](const Tile& tile, std::uint32_t element) {
        kinds[tile.ids[element]] = kind_of(tile, element);
    });
    std::vector<std::uint32_t> places(kinds.size());
    std::uint32_t triangles = 0, primitives = 0;
    for (std::size_t id = 0; id < kinds.size(); ++id)
        if (kinds[id] != Kind::None) places[id] = kinds[id] == Kind::Triangle ? triangles++ : primitives++;
    Elements out;
    out.triangles.resize(triangles);
    out.primitives.resize(primitives);
    for_each_element(impl, threads, [&](const Tile& tile, std::uint32_t element) {
        const std::uint32_t id = tile.ids[element], place = places[id];
        if (kinds[id] != kind_of(tile, element))
            impl.forests.front()->tiles.fail_inconsistent();  // two have one number
        if (tile.is_triangle(element)) {
            CornersOfTriangle& to = out.triangles[place];
            const auto corners = tile.corners(element);
            for (std::size_t c = 0; c < 3; ++c) to.corners[c] = rounded(corners[c], origin);
            to.part = tile.part(element);
            to.label = tile.label(element);
        } else {
            const TilePrimitive& from = tile.primitive(element);
            out.primitives[place] = {from.shape(), from.part, from.label};
        }
    });
    return out;
}

/// Returns the number of sides of round solids: fewer if there are many, because each has many triangles.
int sides_for(const Elements& elements)
{
    const auto round = std::count_if(elements.primitives.begin(), elements.primitives.end(),
                                     [](const Primitive& p) { return p.shape.kind != ShapeKind::Box; });
    return round > 20000 ? 8 : round > 2000 ? 16 : 32;
}

// ---------------------------------------------------------------- the file

struct PointHash {
    std::size_t operator()(const Point& p) const
    {
        std::size_t hash = 0;
        for (const float x : p) hash = hash * 1000003 + std::bit_cast<std::uint32_t>(x);
        return hash;
    }
};

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

/// The triangles of one material, with equal corners welded. Triangles with two equal corners, after rounding to
/// float32, are left out.
class Surface {
public:
    void add(const Point& a, const Point& b, const Point& c)
    {
        if (a == b || b == c || c == a) return;
        for (const Point& corner : {a, b, c}) indices_.push_back(number_of(corner));
    }
    bool empty() const { return indices_.empty(); }
    const std::vector<Point>& points() const { return points_; }
    const std::vector<std::uint32_t>& indices() const { return indices_; }

private:
    std::uint32_t number_of(const Point& point)
    {
        const auto [entry, is_new] = numbers_.try_emplace(point, std::uint32_t(points_.size()));
        if (is_new) points_.push_back(point);
        return entry->second;
    }
    std::unordered_map<Point, std::uint32_t, PointHash> numbers_;
    std::vector<Point> points_;
    std::vector<std::uint32_t> indices_;
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

/// The elements of a part, which are consecutive: from `from` to before `to`.
struct Range {
    std::size_t from = 0, to = 0;
};

template <class Element>
std::vector<Range> ranges_by_part(const std::vector<Element>& elements, std::size_t parts)
{
    std::vector<Range> out(parts);
    for (std::size_t e = 0; e < elements.size(); ++e) {
        Range& range = out[elements[e].part];
        if (range.to == 0) range.from = e;
        range.to = e + 1;
    }
    return out;
}

/// Adds a node with the part's name and returns its number; nothing if the whole part is ignored.
std::optional<std::size_t> add_part(GlbFile& file, const Elements& elements, const Range& triangles,
                                    const Range& primitives, const std::string& name, const Vec3& origin, int sides)
{
    std::array<Surface, 3> surfaces;  // by label
    for (std::size_t e = triangles.from; e < triangles.to; ++e) {
        const auto& [corners, part, label] = elements.triangles[e];
        surfaces[std::size_t(label)].add(corners[0], corners[1], corners[2]);
    }
    for (std::size_t e = primitives.from; e < primitives.to; ++e) {
        const Primitive& primitive = elements.primitives[e];
        tessellate(primitive.shape, sides, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
            surfaces[std::size_t(primitive.label)].add(rounded(a, origin), rounded(b, origin), rounded(c, origin));
        });
    }
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
    {
        const Elements elements = elements_of(map.geometry, origin, threads);
        const int sides = sides_for(elements);
        const std::vector<Range> triangles = ranges_by_part(elements.triangles, parts.size());
        const std::vector<Range> primitives = ranges_by_part(elements.primitives, parts.size());
        for (std::size_t part = 0; part < parts.size(); ++part) {
            const auto node = add_part(file, elements, triangles[part], primitives[part], parts[part].name, origin,
                                       sides);
            if (node) children.push_back(*node);
            if (progress) progress(double(part + 1) / double(parts.size()));
        }
    }
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

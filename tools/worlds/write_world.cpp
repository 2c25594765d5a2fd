#include "world.h"

#include <spawnfield/output_file.h>

#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

using namespace spawnfield;

namespace worlds {
namespace {

namespace fs = std::filesystem;

/// Returns the value rounded to `decimals` decimals, without trailing zeros.
std::string decimal(double value, int decimals)
{
    const double unit = std::pow(10.0, decimals), rounded = std::round(value * unit) / unit + 0.0;  // -0 becomes 0
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, rounded).ptr};
}

std::string length(double value) { return decimal(value, 5); }

std::string list(const Vec3& v) { return "[" + length(v.x()) + ", " + length(v.y()) + ", " + length(v.z()) + "]"; }

std::string pose_text(const Pose& pose)
{
    const Mat3& r = pose.rotation;
    std::string text;
    if (!pose.position.isZero(0)) text += ", xyz: " + list(pose.position);
    if (r.isIdentity(0)) return text;
    const double roll = std::atan2(r(2, 1), r(2, 2)), pitch = std::asin(-r(2, 0)), yaw = std::atan2(r(1, 0), r(0, 0));
    return text + ", rpy: [" + decimal(roll, 9) + ", " + decimal(pitch, 9) + ", " + decimal(yaw, 9) + "]";
}

std::string shape_text(const Shape& shape)
{
    const std::string round = "{radius: " + length(shape.size[0]) + ", length: " + length(shape.size[1]) + "}";
    switch (shape.kind) {
    case ShapeKind::Box: return "box: " + list(shape.size);
    case ShapeKind::Sphere: return "sphere: " + length(shape.size[0]);
    case ShapeKind::Cylinder: return "cylinder: " + round;
    case ShapeKind::Capsule: return "capsule: " + round;
    case ShapeKind::Hull: break;
    }
    throw std::runtime_error("write_world: a hull cannot be written to a scene file");
}

/// The primitives and pieces of a part.
struct PartItems {
    std::vector<const Primitive*> primitives;
    std::vector<const Piece*> pieces;
};

std::vector<PartItems> items_of(const Scene& scene)
{
    std::vector<PartItems> items(scene.parts.size());
    for (const Primitive& primitive : scene.primitives) items[primitive.part].primitives.push_back(&primitive);
    for (const Piece& piece : scene.pieces) items[piece.part].pieces.push_back(&piece);
    return items;
}

class Writer {
public:
    Writer(const Scene& scene, const fs::path& folder) : scene_(scene), folder_(folder) {}

    std::string scene_text()
    {
        std::string text = "format: spawnfield-scene/1\nname: " + scene_.name + "\nparts:\n";
        const std::vector<PartItems> items = items_of(scene_);
        for (std::size_t i = 0; i < items.size(); ++i) add_part(scene_.parts[i], items[i], text);
        return text;
    }

private:
    void add_part(const Part& part, const PartItems& items, std::string& text)
    {
        const std::string start = ", label: " + std::string(to_string(part.label)) + ", ";
        for (std::size_t i = 0; i < items.primitives.size(); ++i) {
            const Shape& shape = items.primitives[i]->shape;
            text += "  - {name: " + part.name + (i > 0 ? "-" + std::to_string(i + 1) : "") + start + shape_text(shape) +
                    pose_text(shape.pose) + "}\n";
        }
        if (!items.pieces.empty())
            text += "  - {name: " + part.name + start +
                    (part.kind == "plane" ? plane_text(*items.pieces[0]) : mesh_text(part, items.pieces)) + "}\n";
    }

    Bounds bounds_of(const Piece& piece) const
    {
        Bounds bounds;
        for (std::uint32_t t = 0; t < piece.triangle_count; ++t)
            for (const std::uint32_t v : scene_.triangles[piece.first_triangle + t]) bounds.extend(scene_.vertices[v]);
        return bounds;
    }

    std::string plane_text(const Piece& piece) const
    {
        const Bounds bounds = bounds_of(piece);
        const Vec3 size = bounds.max - bounds.min;
        return "plane: [" + length(size.x()) + ", " + length(size.y()) + "]" +
               pose_text({(bounds.min + bounds.max) / 2, Mat3::Identity()});
    }

    /// Returns the text of a mesh, and writes its file. Meshes that differ only in their place share a file.
    std::string mesh_text(const Part& part, const std::vector<const Piece*>& pieces)
    {
        Vec3 place = scene_.vertices[scene_.triangles[pieces[0]->first_triangle][0]];
        for (double& x : place) x = std::round(x * 1e5) / 1e5;
        const auto [found, is_new] = files_.try_emplace(obj_text(pieces, place), "meshes/" + part.name + ".obj");
        if (is_new) {
            fs::create_directories(folder_ / "meshes");
            write_file_atomically(folder_ / found->second, found->first);
        }
        const bool is_sheet = part.solid_pieces == 0;
        return "mesh: " + found->second + pose_text({place, Mat3::Identity()}) + (is_sheet ? ", solid: false" : "");
    }

    std::string obj_text(const std::vector<const Piece*>& pieces, const Vec3& origin) const
    {
        std::string vertices, faces;
        std::size_t count = 0;
        for (std::size_t p = 0; p < pieces.size(); ++p) {
            std::map<std::uint32_t, std::size_t> numbers;
            faces += "o piece" + std::to_string(p) + "\n";
            for (std::uint32_t t = 0; t < pieces[p]->triangle_count; ++t) {
                faces += "f";
                for (const std::uint32_t v : scene_.triangles[pieces[p]->first_triangle + t]) {
                    const auto [found, is_new] = numbers.try_emplace(v, count + 1);
                    if (is_new) {
                        const Vec3 vertex = scene_.vertices[v] - origin;
                        vertices += "v " + length(vertex.x()) + " " + length(vertex.y()) + " " + length(vertex.z()) +
                                    "\n";
                        ++count;
                    }
                    faces += " " + std::to_string(found->second);
                }
                faces += "\n";
            }
        }
        return vertices + faces;
    }

    const Scene& scene_;
    const fs::path folder_;
    std::map<std::string, std::string> files_;  ///< from the contents to the name of the file
};

std::string landmarks_text(const std::vector<Landmark>& landmarks)
{
    std::string text = "name,x0,y0,z0,x1,y1,z1\n";
    for (const auto& [name, where] : landmarks) {
        text += name;
        for (const Vec3& corner : {where.min, where.max})
            for (const double x : corner) text += "," + length(x);
        text += "\n";
    }
    return text;
}

}  // namespace

void write_world(const World& world, const fs::path& folder)
{
    fs::create_directories(folder);
    write_file_atomically(folder / "scene.yaml", Writer(world.scene, folder).scene_text());
    if (!world.landmarks.empty()) write_file_atomically(folder / "landmarks.csv", landmarks_text(world.landmarks));
}

}  // namespace worlds

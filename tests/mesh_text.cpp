#include "mesh_text.h"

#include "base/number.h"

#include <zlib.h>

#include <cstring>
#include <stdexcept>
#include <utility>

using spawnfield::append_number;
using spawnfield::number;

namespace mesh_text {
namespace {

std::string little_endian(std::uint64_t value, int bytes)
{
    std::string out;
    for (int k = 0; k < bytes; ++k) out += char(value >> 8 * k & 255);
    return out;
}

std::string deflated(const std::string& text)
{
    std::string out(text.size() + 100, '\0');
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = uInt(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    if (deflate(&stream, Z_FINISH) != Z_STREAM_END) throw std::runtime_error("cannot compress a file for tests");
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

/// Returns a compressed ZIP archive of these files.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files)
{
    std::string out, directory;
    for (const auto& [name, text] : files) {
        const std::string packed = deflated(text);
        const std::string common = little_endian(20, 2) + little_endian(0, 2) + little_endian(8, 2) +
                                   little_endian(0, 4) +
                                   little_endian(
                                       crc32(0, reinterpret_cast<const Bytef*>(text.data()), uInt(text.size())), 4) +
                                   little_endian(packed.size(), 4) + little_endian(text.size(), 4) +
                                   little_endian(name.size(), 2) + little_endian(0, 2);
        directory += "PK\1\2" + little_endian(20, 2) + common + little_endian(0, 2) + little_endian(0, 2) +
                     little_endian(0, 2) + little_endian(0, 4) + little_endian(out.size(), 4) + name;
        out += "PK\3\4" + common + name + packed;
    }
    const std::string count = little_endian(files.size(), 2);
    const std::size_t start = out.size();
    return out + directory + "PK\5\6" + little_endian(0, 4) + count + count + little_endian(directory.size(), 4) +
           little_endian(start, 4) + little_endian(0, 2);
}

std::string spaced(const std::vector<double>& values)
{
    std::string out;
    for (const double value : values) out += (out.empty() ? "" : " ") + number(value);
    return out;
}

std::string coordinates(const hand::Mesh& mesh)
{
    std::vector<double> values;
    for (const auto& v : mesh.vertices) values.insert(values.end(), v.data(), v.data() + 3);
    return spaced(values);
}

void append_geometry(std::string& text, const Node& node)
{
    if (node.mesh.triangles.empty()) return;
    const std::string& id = node.name;
    const std::size_t count = node.mesh.vertices.size();
    text += "<geometry id=\"" + id + "-mesh\" name=\"" + id + "\"><mesh><source id=\"" + id +
            "-positions\"><float_array id=\"" + id + "-array\" count=\"" + std::to_string(3 * count) + "\">" +
            coordinates(node.mesh) + "</float_array><technique_common><accessor source=\"#" + id + "-array\" count=\"" +
            std::to_string(count) +
            "\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
            "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source><vertices id=\"" +
            id + "-vertices\"><input semantic=\"POSITION\" source=\"#" + id +
            "-positions\"/></vertices><triangles material=\"" + node.material + "-symbol\" count=\"" +
            std::to_string(node.mesh.triangles.size()) + "\"><input semantic=\"VERTEX\" source=\"#" + id +
            "-vertices\" offset=\"0\"/><p>";
    for (const auto& triangle : node.mesh.triangles)
        for (const auto corner : triangle) text += std::to_string(corner) + " ";
    text += "</p></triangles></mesh></geometry>\n";
}

void append_node(std::string& text, const Node& node)
{
    // Ids differ from names on purpose, as in files of Blender.
    text += "<node id=\"" + node.name + "-id\" name=\"" + node.name + "\">";
    if (!node.matrix.empty()) text += "<matrix sid=\"transform\">" + spaced(node.matrix) + "</matrix>";
    if (!node.mesh.triangles.empty())
        text += "<instance_geometry url=\"#" + node.name +
                "-mesh\"><bind_material><technique_common><instance_material symbol=\"" + node.material +
                "-symbol\" target=\"#" + node.material +
                "-id\"/></technique_common></bind_material></instance_geometry>";
    for (const Node& child : node.children) append_node(text, child);
    text += "</node>\n";
}

template <class Visit>
void for_each(const std::vector<Node>& nodes, const Visit& visit)
{
    for (const Node& node : nodes) {
        visit(node);
        for_each(node.children, visit);
    }
}

std::string base64(const std::string& bytes)
{
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

/// The arrays of a glTF file while it is built.
struct Gltf {
    std::string nodes, meshes, materials, accessors, views, buffer;
    int node_count = 0, mesh_count = 0, view_count = 0;

    static void append(std::string& list, const std::string& entry) { list += (list.empty() ? "" : ",") + entry; }

    template <class T>
    void add_view(const std::vector<T>& values, int component, const char* type, std::size_t count,
                  const std::string& range)
    {
        const std::size_t size = values.size() * sizeof(T);
        append(views, "{\"buffer\":0,\"byteOffset\":" + std::to_string(buffer.size()) +
                          ",\"byteLength\":" + std::to_string(size) + "}");
        append(accessors, "{\"bufferView\":" + std::to_string(view_count++) +
                              ",\"componentType\":" + std::to_string(component) +
                              ",\"count\":" + std::to_string(count) + ",\"type\":\"" + type + "\"" + range + "}");
        buffer.append(reinterpret_cast<const char*>(values.data()), size);
    }

    int add_mesh(const Node& node)
    {
        std::vector<float> positions;
        std::vector<std::uint32_t> indices;
        Eigen::Vector3d low = node.mesh.vertices[0], high = low;
        for (const auto& v : node.mesh.vertices) {
            for (const double x : v) positions.push_back(float(x));
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
        for (const auto& triangle : node.mesh.triangles)
            indices.insert(indices.end(), triangle.begin(), triangle.end());
        const auto list = [](const Eigen::Vector3d& v) {
            return "[" + number(v.x()) + "," + number(v.y()) + "," + number(v.z()) + "]";
        };
        append(meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":" + std::to_string(view_count) +
                           "},\"indices\":" + std::to_string(view_count + 1) +
                           ",\"material\":" + std::to_string(mesh_count) + "}]}");
        append(materials, "{\"name\":\"" + node.material + "\"}");
        add_view(positions, 5126, "VEC3", node.mesh.vertices.size(),
                 ",\"min\":" + list(low) + ",\"max\":" + list(high));
        add_view(indices, 5125, "SCALAR", indices.size(), "");
        return mesh_count++;
    }

    int add_node(const Node& node)
    {
        std::string children;
        for (const Node& child : node.children) append(children, std::to_string(add_node(child)));
        std::string entry = "{\"name\":\"" + node.name + "\"";
        if (!node.mesh.triangles.empty()) entry += ",\"mesh\":" + std::to_string(add_mesh(node));
        if (!node.matrix.empty()) {
            std::string columns;  // glTF writes column after column
            for (std::size_t i = 0; i < 16; ++i) append(columns, number(node.matrix[i % 4 * 4 + i / 4]));
            entry += ",\"matrix\":[" + columns + "]";
        }
        if (!children.empty()) entry += ",\"children\":[" + children + "]";
        append(nodes, entry + "}");
        return node_count++;
    }
};

}  // namespace

std::string obj(const std::vector<Node>& nodes)
{
    std::string text;
    std::size_t base = 1;
    for (const Node& node : nodes) {
        text += "o " + node.name + "\nusemtl " + node.material + "\n";
        for (const auto& v : node.mesh.vertices) text += "v " + spaced({v.x(), v.y(), v.z()}) + "\n";
        for (const auto& t : node.mesh.triangles)
            text += "f " + std::to_string(base + t[0]) + " " + std::to_string(base + t[1]) + " " +
                    std::to_string(base + t[2]) + "\n";
        base += node.mesh.vertices.size();
    }
    return text;
}

std::string obj(const hand::Mesh& mesh) { return obj({{.mesh = mesh}}); }

std::string stl(const hand::Mesh& mesh)
{
    std::string text = "solid thing\n";
    for (const auto& triangle : mesh.triangles) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const auto corner : triangle) {
            const auto& v = mesh.vertices[corner];
            text += "vertex " + spaced({v.x(), v.y(), v.z()}) + "\n";
        }
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid thing\n";
}

std::string dae(const std::vector<Node>& nodes, const DaeOptions& options)
{
    std::string text =
        "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"
        "<asset><unit name=\"unit\" meter=\"" +
        number(options.unit) + "\"/>";
    if (!options.up.empty()) text += "<up_axis>" + options.up + "</up_axis>";
    text +=
        "</asset>\n<library_effects><effect id=\"effect\"><profile_COMMON><technique "
        "sid=\"common\"><lambert/></technique>"
        "</profile_COMMON></effect></library_effects>\n<library_materials>";
    for_each(nodes, [&](const Node& node) {
        text += "<material id=\"" + node.material + "-id\" name=\"" + node.material +
                "\"><instance_effect url=\"#effect\"/></material>\n";
    });
    text += "</library_materials>\n<library_geometries>";
    for_each(nodes, [&](const Node& node) { append_geometry(text, node); });
    text += "</library_geometries>\n<library_visual_scenes><visual_scene id=\"scene\">\n";
    for (const Node& node : nodes) append_node(text, node);
    return text +
           "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#scene\"/></scene></COLLADA>\n";
}

std::string gltf(const std::vector<Node>& nodes)
{
    Gltf file;
    std::string roots;
    for (const Node& node : nodes) Gltf::append(roots, std::to_string(file.add_node(node)));
    return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[" + roots + "]}],\"nodes\":[" +
           file.nodes + "],\"meshes\":[" + file.meshes + "],\"materials\":[" + file.materials + "],\"accessors\":[" +
           file.accessors + "],\"bufferViews\":[" + file.views +
           "],\"buffers\":[{\"byteLength\":" + std::to_string(file.buffer.size()) +
           ",\"uri\":\"data:application/octet-stream;base64," + base64(file.buffer) + "\"}]}\n";
}

hand::Mesh box(const spawnfield::Vec3& low, const spawnfield::Vec3& high)
{
    return hand::moved(hand::box(high - low), {(low + high) / 2, spawnfield::Mat3::Identity()});
}

std::string package_3mf(const std::string& attributes, const std::string& objects, const std::string& extra)
{
    return zip(
        {{"[Content_Types].xml", "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"/>"},
         {"_rels/.rels",
          "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
          "Id=\"a\" "
          "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\" "
          "Target=\"/3D/3dmodel.model\"/></Relationships>"},
         {"3D/3dmodel.model", "<?xml version=\"1.0\"?><model " + attributes +
                                  " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>" +
                                  objects + "</resources><build><item objectid=\"1\"/></build></model>"},
         {"extra", extra}});
}

const std::string wedge_3mf =
    "<object id=\"1\" type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"4\" y=\"0\" "
    "z=\"0\"/><vertex x=\"0\" y=\"2\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles><triangle "
    "v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" "
    "v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh></object>";

}  // namespace mesh_text

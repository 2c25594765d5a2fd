#include "catch.h"
#include "mesh_text.h"
#include "temp_folder.h"

#include <spawnfield/error.h>
#include <spawnfield/scene.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstring>

using namespace spawnfield;

namespace {

/// Returns the error message of reading the bytes as a mesh, without the name of the file; "" if it can be read.
std::string complaint(const TempFolder& folder, const std::string& name, const std::string& bytes)
{
    const std::filesystem::path file = folder.write(name, bytes);
    try {
        load_scene(file);
    } catch (const FileError& error) {
        const std::string what = error.what(), start = file.string() + ": ";
        REQUIRE(what.starts_with(start));
        return what.substr(start.size());
    }
    return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// Checks that a file that is cut at every step-th byte, or has that byte altered, is read or refused by name, and
/// never ends the program.
void check_harmed(const TempFolder& folder, const std::string& name, const std::string& good, std::size_t step = 1)
{
    for (std::size_t at = 0; at < good.size(); at += step) {
        complaint(folder, name, good.substr(0, at));
        for (const int bits : {0x41, 0x80, 0xff}) {
            std::string bad = good;
            bad[at] = char(bad[at] ^ bits);
            complaint(folder, name, bad);
        }
    }
    CHECK(complaint(folder, name, good) == "");
}

const std::string ply_head =
    "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
const std::string ply_square = ply_head + "0 0 0\n4 0 0\n4 3 0\n0 3 0\n3 0 1 2\n3 0 2 3\n";

/// Returns a COLLADA text with one triangle. `nodes` are added to the scene beside the node that has it.
std::string collada(const std::string& nodes = "", const std::string& library = "")
{
    return "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
           "version=\"1.4.1\">\n"
           "<asset><unit meter=\"1\"/><up_axis>Z_UP</up_axis></asset>\n<library_geometries><geometry id=\"g\"><mesh>\n"
           "<source id=\"s\"><float_array id=\"a\" count=\"9\">0 0 0 5 0 0 5 5 0</float_array>\n"
           "<technique_common><accessor source=\"#a\" count=\"3\" stride=\"3\"><param name=\"X\" "
           "type=\"float\"/><param name=\"Y\" type=\"float\"/>"
           "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>\n"
           "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#s\"/></vertices>\n"
           "<polylist count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><vcount>3</vcount>\n<p>0 1 "
           "2</p></polylist>\n"
           "</mesh></geometry></library_geometries>\n<library_nodes>" +
           library +
           "</library_nodes>\n"
           "<library_visual_scenes><visual_scene id=\"vs\">\n<node id=\"n\"><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 "
           "1</matrix><instance_geometry url=\"#g\"/></node>\n" +
           nodes +
           "</visual_scene></library_visual_scenes>\n<scene><instance_visual_scene url=\"#vs\"/></scene></COLLADA>\n";
}

/// Returns a glTF text with one triangle in meshes[0]. `nodes` and the nodes of the scene are JSON.
std::string gltf(const std::string& nodes, const std::string& scene = "0", const std::string& more = "")
{
    return "{\"asset\": {\"version\": \"2.0\"}, " + more + "\"scene\": 0, \"scenes\": [{\"nodes\": [" + scene +
           "]}], \"nodes\": [" + nodes +
           "], \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1}]}],\n\"buffers\": "
           "[{\"byteLength\": 44, \"uri\": "
           "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACgQAAAAAAAAAAAAAAAAAAAAAAAAKDAAAABAAIAAAA=\"}],\n"
           "\"bufferViews\": [{\"buffer\": 0, \"byteOffset\": 0, \"byteLength\": 36}, {\"buffer\": 0, \"byteOffset\": "
           "36, \"byteLength\": 6}],\n"
           "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", \"min\": "
           "[0, 0, -5], \"max\": [5, 0, 0]},\n"
           "{\"bufferView\": 1, \"componentType\": 5123, \"count\": 3, \"type\": \"SCALAR\"}]}\n";
}

template <class T>
std::string bytes_of_value(T value, bool big)
{
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return big ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

/// Returns the square as binary PLY with one quad, colours among the coordinates, and an unrelated element before both.
std::string binary_square(bool big, const std::string& line_end = "\n")
{
    std::string head = std::string("ply|format binary_") + (big ? "big" : "little") +
                       "_endian 1.0|element camera 1|property list ushort double view|"
                       "element vertex 4|property double x|property uchar red|property float y|property short z|"
                       "element face 1|property uchar flags|property list uint ushort vertex_index|property list uchar "
                       "float texcoord|end_header|";
    std::string bytes;
    for (const char c : head) bytes += c == '|' ? line_end : std::string(1, c);
    bytes += bytes_of_value(std::uint16_t(1), big) + bytes_of_value(2.5, big);
    for (const auto& [x, y] : {std::pair{0, 0}, std::pair{4, 0}, std::pair{4, 3}, std::pair{0, 3}})
        bytes += bytes_of_value(double(x), big) + '\x0a' + bytes_of_value(float(y), big) +
                 bytes_of_value(std::int16_t(-7), big);
    bytes += '\x0d' + bytes_of_value(std::uint32_t(4), big);
    for (std::uint16_t corner = 0; corner < 4; ++corner) bytes += bytes_of_value(corner, big);
    return bytes + '\x01' + bytes_of_value(0.5f, big);
}

}  // namespace

TEST_CASE("JSON without the end of a glTF file is refused")
{
    const TempFolder folder;
    CHECK_THROWS_WITH(
        load_scene(folder.write("region.geojson", std::string(200000, '['))),
        (folder / "region.geojson").string() +
            ": cannot be read as a mesh: it contains JSON, but \".geojson\" is not an extension of glTF (.gltf, .glb)");
}

TEST_CASE("PLY is read as text and in both byte orders, with any additional elements")
{
    const TempFolder folder;
    const auto bounds = [&](const std::string& bytes) {
        const Scene scene = load_scene(folder.write("square.ply", bytes));
        CHECK(scene.triangles.size() == 2);
        return scene.bounds();
    };
    CHECK(bounds(ply_square).max == Vec3(4, 3, 0));
    std::string other_lines = ply_square;
    for (std::size_t at = other_lines.find('\n'); at != std::string::npos; at = other_lines.find('\n', at + 2))
        other_lines.replace(at, 1, "\r\n");
    CHECK(bounds(other_lines + "\r\n \r\n").max == Vec3(4, 3, 0));
    for (const bool big : {false, true})
        for (const char* line_end : {"\n", "\r\n", "\r"}) {
            const Bounds read = bounds(binary_square(big, line_end));
            CHECK(read.min == Vec3(0, 0, -7));
            CHECK(read.max == Vec3(4, 3, -7));
        }
}

TEST_CASE("a strip of a PLY file has a triangle for each corner after its second, all with the same orientation")
{
    const TempFolder folder;
    const std::string strips =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n9 0 1 2 3 -1 2 3 4 5\n";
    const Scene scene = load_scene(folder.write("strip.ply", strips));
    REQUIRE(scene.triangles.size() == 4);
    for (const Triangle& t : scene.triangles) {
        const Vec3 a = scene.vertices[t[1]] - scene.vertices[t[0]], b = scene.vertices[t[2]] - scene.vertices[t[0]];
        CHECK(a.cross(b).z() == 1);
    }
}

TEST_CASE("a damaged PLY file is refused by line, value and limit")
{
    const TempFolder folder;
    const auto said = [&](const std::string& from, const std::string& to) {
        return complaint(folder, "a.ply", replaced(ply_square, from, to));
    };
    CHECK(said("3 0 2 3\n", "3 0 2 40\n") == "line 16: a face has the corner 40, needs one of the 4 vertices, 0 .. 3");
    CHECK(said("3 0 2 3\n", "3 0 2 -1\n") == "line 16: a face has the corner -1, needs one of the 4 vertices, 0 .. 3");
    CHECK(said("3 0 2 3\n", "3 0 2 2000000000\n") ==
          "line 16: a face has the corner 2e+09, needs one of the 4 vertices, 0 .. 3");
    CHECK(said("3 0 2 3\n", "3 0 2 1.5\n") ==
          "line 16: a face has the corner 1.5, needs one of the 4 vertices, 0 .. 3");
    CHECK(said("3 0 2 3\n", "3 0 2 abc\n") == "line 16: \"abc\" is not a number; element face, row 2 of 2");
    CHECK(said("3 0 2 3\n", "0\n") == "line 16: a face has 0 corners, needs 3 or more");
    CHECK(said("3 0 2 3\n", "-3 0 2 3\n") ==
          "line 16: the list vertex_indices has the count -3, needs a whole number of 0 .. 2147483647");
    CHECK(said("3 0 2 3\n", "3 0 2\n") == "line 16: ends before its last number; element face, row 2 of 2");
    CHECK(said("3 0 2 3\n", "2 0 2 3\n") ==
          "line 16: \"3\" comes after the last number of the row; element face, row 2 of 2");
    CHECK(said("3 0 2 3\n", "") == "ends before element face, row 2 of 2; is it cut short?");
    CHECK(said("3 0 2 3\n", "3 0 2 3\n3 0 1 3\n") ==
          "line 17: comes after the last row that the header declares; are the counts of its elements right?");
    CHECK(said("4 3 0\n", "4 3\n") == "line 13: ends before its last number; element vertex, row 3 of 4");
    CHECK(said("vertex 4", "vertex 4294967295") ==
          "line 4: element \"vertex\" has the count \"4294967295\", needs a whole number of 0 .. 2147483647");
    CHECK(said("vertex 4", "vertex 2000000000") ==
          "line 4: element vertex has 2000000000 rows, for which the file is too short (40 bytes remaining, needs at "
          "least "
          "11999999999); is it cut short?");
    CHECK(said("property float z\n", "") == "line 4: element vertex has no property z");
    CHECK(said("float z", "flaot z").starts_with("line 7: the type \"flaot\" is unknown; known types: char"));
    CHECK(said("list uchar", "list float") == "line 9: a list is counted in \"float\", needs whole numbers");
    CHECK(said("int vertex_indices", "int corners") == "line 8: element face has no property list … vertex_indices");
    CHECK(said("ascii 1.0", "ascii 2.0").starts_with("line 2: the format is unknown"));
    CHECK(said("end_header\n", "end_haeder\n").starts_with("line 10: \"end_haeder\" is not a keyword of a PLY header"));
    CHECK(said("ply\n", "pyl\n") == "is not a PLY file: its first line is not \"ply\"");
    CHECK(complaint(folder, "a.ply", "") == "is not a PLY file: its first line is not \"ply\"");
    CHECK(complaint(folder, "a.ply", "ply\nformat ascii 1.0\n") ==
          "ends within its header, before end_header; is it cut short?");
    const std::string binary = binary_square(false);
    CHECK(complaint(folder, "a.ply", binary.substr(0, binary.size() - 6)) ==
          "element face, row 1 of 1: the file ends within it; is it cut short?");
    CHECK(complaint(folder, "a.ply", binary + "abc") ==
          "has 3 bytes after the last row that the header declares; are the counts of its elements right?");
    CHECK(complaint(folder, "a.stl", replaced(ply_square, "2 3\n", "2 9\n")) ==
          "line 16: a face has the corner 9, needs one of the 4 vertices, 0 .. 3");
}

TEST_CASE("PLY files are read or refused wherever they are cut or altered")
{
    const TempFolder folder;
    check_harmed(folder, "a.ply", ply_square);
    check_harmed(folder, "a.ply", binary_square(false));
    check_harmed(folder, "a.ply", binary_square(true));
}

TEST_CASE("an STL file that is cut short is refused, as text and as binary")
{
    const TempFolder folder;
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    const std::string text = "solid a\n" + facet + facet + "endsolid a\n";
    CHECK(complaint(folder, "a.stl", text) == "");
    CHECK(complaint(folder, "a.stl", text + text) == "");
    const std::string missing =
        "has no endsolid after its last facet; is it cut short? If it is whole, add a line endsolid";
    for (std::size_t size = 1 + text.find("endfacet"); size < text.rfind("endsolid") + 8; ++size)
        CHECK(complaint(folder, "a.stl", text.substr(0, size)) == missing);
    CHECK(complaint(folder, "a.stl", text + "solid b\n" + facet) == missing);

    for (const std::string begin : {"made by hand", "solid made by hand"}) {  // both occur in binary files
        std::string binary = begin + std::string(80 - begin.size(), ' ') + bytes_of_value(std::uint32_t(2), false);
        for (int f = 0; f < 2; ++f) {
            for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
                binary += bytes_of_value(value, false);
            binary += std::string(2, '\0');
        }
        CHECK(complaint(folder, "a.stl", binary) == "");
        const std::string declared = "declares 2 facets, for which a binary STL file has 184 bytes, but it has ";
        for (std::size_t size = 84; size < binary.size(); ++size)
            CHECK(complaint(folder, "a.stl", binary.substr(0, size)) ==
                  declared + std::to_string(size) + "; is it cut short?");
        CHECK(complaint(folder, "a.stl", binary + "more") == declared + "188; export it again");
        check_harmed(folder, "a.stl", binary);
    }
    CHECK(complaint(folder, "a.stl", "made by hand") ==
          "is an STL file of 12 bytes, needs at least 84; is it cut short?");
    check_harmed(folder, "a.stl", text);
}

TEST_CASE("an OBJ or OFF file whose last line has no line break is read with a notice")
{
    const TempFolder folder;
    const auto notices = [&](const std::string& name, const std::string& text) {
        return load_scene(folder.write(name, text)).notices;
    };
    for (const auto& [name, text] : {std::pair{"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
                                     std::pair{"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}}) {
        const std::string whole = text, cut = whole.substr(0, whole.size() - 1);
        const std::vector<std::string> before = notices(name, whole), after = notices(name, cut);
        REQUIRE(after.size() == before.size() + 1);
        CHECK(std::find(after.begin(), after.end(),
                        (folder / name).string() + ": its last line has no line break; if the file was cut short, a "
                                                   "part of its geometry is missing") != after.end());
    }
}

TEST_CASE("COLLADA nodes that contain themselves, are nested too deep or are too many are refused")
{
    const TempFolder folder;
    const auto said = [&](const std::string& nodes, const std::string& library = "") {
        return complaint(folder, "a.dae", collada(nodes, library));
    };
    const auto node = [](int id, const std::string& inside) {
        return "<node id=\"n" + std::to_string(id) + "\">" + inside + "</node>\n";
    };
    const auto instance = [](int id) { return "<instance_node url=\"#n" + std::to_string(id) + "\"/>"; };
    CHECK(said(node(1, instance(1))) ==
          "line 14: <node> \"n1\" contains itself through <instance_node>; remove the circle");
    CHECK(said(instance(1), node(1, instance(2)) + node(2, node(3, instance(1)))) ==
          "line 11: <node> \"n1\" contains itself through <instance_node>; remove the circle");
    CHECK(said("<node id=\"a\" name=\"n1\">" + instance(1) + "</node>", node(1, "")) ==
          "");  // the id refers to the node of the library, not to the one with that name
    CHECK(said("<node id=\"a\" name=\"n1\">" + instance(1) + "</node>") ==
          "line 14: <node> \"n1\" contains itself through <instance_node>; remove the circle");
    const auto chain = [&](int length, int times) {
        std::string library;
        for (int i = 1; i < length; ++i) {
            std::string inside;
            for (int t = 0; t < times; ++t) inside += instance(i + 1);
            library += node(i, inside);
        }
        return library + node(length, "<instance_geometry url=\"#g\"/>");
    };
    CHECK(said(node(0, instance(1)), chain(450, 1)) == "");
    CHECK(said(node(0, instance(1)), chain(20000, 1)) ==
          "line 509: <node> \"n499\" is nested more than 500 deep, counting <instance_node>; merge nodes");
    CHECK(said(node(0, instance(1)), chain(5, 4)) == "");
    CHECK(said(node(0, instance(1)), chain(28, 2)) ==
          "line 19: <node> \"n9\" has more than 1000000 nodes, counting all that its <instance_node>s repeat; merge "
          "nodes, or use fewer instances");
    std::string open, close;
    for (int i = 0; i < 20000; ++i) open += "<node>", close += "</node>";
    CHECK(said(open + close) == "line 14: elements are nested more than 100 deep; merge nodes");
    CHECK(complaint(folder, "a.zae", "PK").starts_with("is a packed COLLADA file"));
}

TEST_CASE("numbers of COLLADA that are invalid, too few or too many are refused by line and element")
{
    const TempFolder folder;
    CHECK(complaint(folder, "a.dae", collada()) == "");
    const auto said = [&](const std::string& from, const std::string& to) {
        return complaint(folder, "a.dae", replaced(collada(), from, to));
    };
    const std::string whole = ", needs whole numbers of 0 .. 2147483647 with spaces between";
    CHECK(said("<p>0 1 2", "<p>0 1,5 2") == "line 9: <p> has \"1,5\"" + whole);
    CHECK(said("<p>0 1 2", "<p>0 -1 2") == "line 9: <p> has \"-1\"" + whole);
    CHECK(said("<p>0 1 2", "<p>0 1.5 2") == "line 9: <p> has \"1.5\"" + whole);
    CHECK(said("<p>0 1 2", "<p>0 x 2") == "line 9: <p> has \"x\"" + whole);
    CHECK(said("<p>0 1 2", "<p>0 99999999999999999999 2") == "line 9: <p> has \"99999999999999999999\"" + whole);
    CHECK(said("<p>0 1 2", "<p>0 1") == "line 8: <polylist> has 2 numbers in <p>, needs 3 for its 1 faces");
    CHECK(said("<vcount>3", "<vcount>2") == "line 8: <polylist> has 3 numbers in <p>, needs 2 for its 1 faces");
    CHECK(said("<vcount>3", "<vcount>0") ==
          "line 8: <vcount> has \"0\", needs whole numbers of 1 .. 2147483647 with spaces between");
    CHECK(said("<vcount>3", "<vcount>3 3") ==
          "line 8: <polylist> has count 1, but 2 numbers in <vcount>; is the file damaged?");
    CHECK(said("polylist count=\"1\"", "polylist count=\"-1\"") ==
          "line 8: <polylist> has count \"-1\", needs a whole number of 0 .. 2147483647");
    CHECK(said("offset=\"0\"", "offset=\"4294967295\"") ==
          "line 8: <input> has offset \"4294967295\", needs a whole number of 0 .. 255");
    CHECK(said("0 0 0 5", "0 0 a 5") == "line 5: <float_array> has \"a\", needs numbers with spaces between");
    CHECK(said("0 0 0 5", "0,5 0 0 5") == "line 5: <float_array> has \"0,5\", needs numbers with spaces between");
    CHECK(said("0 0 0 5", "0 0 5") == "line 5: <float_array> has count 9, but contains 8; is the file damaged?");
    CHECK(said("count=\"9\"", "count=\"8\"") ==
          "line 5: <float_array> has count 8, but contains 9; is the file damaged?");
    CHECK(said("stride=\"3\"", "stride=\"4\"") ==
          "line 6: <accessor> needs 11 values (offset + (count - 1) stride + params) of \"#a\", which has 9");
    CHECK(said("0 0 0 1</matrix>", "0 0 1</matrix>") == "line 13: <matrix> has 15 numbers, needs 16");
    CHECK(said("0 0 0 1</matrix>", "0 0 0 1e</matrix>") ==
          "line 13: <matrix> has \"1e\", needs numbers with spaces between");
    CHECK(said("</mesh>", "</mush>")
              .starts_with(
                  "cannot be read as a mesh: line 4: not valid XML (xml error mismatched element); is it cut short?"));
    const auto effect = [&](const char* color) {
        return complaint(folder, "a.dae",
                         replaced(collada(), "<library_nodes>",
                                  "<library_effects><effect id=\"e\"><profile_COMMON><technique sid=\"t\"><phong>"
                                  "<diffuse><color>" +
                                      std::string(color) +
                                      "</color></diffuse></phong></technique></profile_COMMON></effect>"
                                      "</library_effects><library_nodes>"));
    };
    for (const char* const color : {"1 0 0 1", " 0.3 0.2 0.1 1", "\n0.3 0.2 0.1 1\n", "1 0 0", "1 0 0x10 1",
                                    "0,3 0,2 0,1 1", "red", "", "nan nan nan 1", "<!-- none -->"}) {
        CAPTURE(color);
        CHECK(effect(color) == "");
    }
    std::string strip = replaced(replaced(collada(), "<polylist", "<tristrips"), "</polylist", "</tristrips");
    strip = replaced(strip, "<vcount>3</vcount>", "");
    CHECK(complaint(folder, "a.dae", strip) == "");
    CHECK(complaint(folder, "a.dae", replaced(strip, "<p>0 1 2", "<p>0 1")) ==
          "line 9: <p> has 2 numbers, needs 1 for each corner and 3 corners or more");
}

TEST_CASE("a COLLADA unit that is not a length is refused")
{
    const TempFolder folder;
    for (const char* bad : {"0", "-1", "abc", "nan", "", "1,5", "1e999"})
        CHECK(complaint(folder, "a.dae", replaced(collada(), "meter=\"1\"", "meter=\"" + std::string(bad) + "\"")) ==
              "line 3: <unit> has meter \"" + std::string(bad) + "\", needs a number > 0 (metres per unit)");
    CHECK(complaint(folder, "a.dae", replaced(collada(), "meter=\"1\"", "meter=\" 0.01 \"")) == "");
    CHECK(complaint(folder, "a.dae", replaced(collada(), "<unit meter=\"1\"/>", "")) == "");
}

TEST_CASE("COLLADA files are read or refused wherever they are cut or altered")
{
    const TempFolder folder;
    check_harmed(folder, "a.dae",
                 collada("<node name=\"b\"><instance_node url=\"#l\"/></node>",
                         "<node id=\"l\"><instance_geometry url=\"#g\"/></node>"));
}

TEST_CASE("glTF nodes that are not trees, and JSON that is nested too deep, are refused")
{
    const TempFolder folder;
    const auto said = [&](const std::string& nodes, const std::string& scene = "0") {
        return complaint(folder, "a.gltf", gltf(nodes, scene));
    };
    CHECK(said("{\"mesh\": 0}") == "");
    CHECK(said("{\"children\": [1, 2]}, {\"mesh\": 0}, {\"mesh\": 0, \"extras\": {\"children\": [0]}}") == "");
    CHECK(said("{\"mesh\": 0, \"children\": [0]}") ==
          "scenes[0].nodes has nodes[0], which is a child of nodes[0], needs nodes without a parent");
    CHECK(said("{\"mesh\": 0}, {\"children\": [2]}, {\"children\": [1]}") ==
          "nodes[1] is below itself through children; remove the circle");
    CHECK(
        said("{\"mesh\": 0, \"children\": [1, 1]}, {\"mesh\": 0}") ==
        "nodes[1] is a child of nodes[0] and again of nodes[0], needs one parent; give each parent a node of its own");
    CHECK(said("{\"children\": [2]}, {\"children\": [2]}, {\"mesh\": 0}", "0, 1")
              .starts_with("nodes[2] is a child of nodes[0] and again of nodes[1], "));
    CHECK(said("{\"mesh\": 0}", "0, 0") == "scenes[0].nodes has nodes[0] twice, needs it once");
    CHECK(said("{\"mesh\": 0}", "1") == "scenes[0].nodes has \"1\", which is not one of the 1 nodes");
    CHECK(said("{\"mesh\": 0, \"children\": [-1]}") == "nodes[0].children has \"-1\", which is not one of the 1 nodes");
    const auto chain = [](int length) {
        std::string nodes;
        for (int i = 1; i < length; ++i) nodes += "{\"children\": [" + std::to_string(i) + "]}, ";
        return nodes + "{\"mesh\": 0}";
    };
    CHECK(said(chain(500)) == "");
    CHECK(said(chain(20000)) == "nodes[500] is nested more than 500 deep; merge nodes");
    const std::string twice = replaced(gltf("{\"mesh\": 0}"), "\"meshes\"", "\"nodes\": [], \"meshes\"");
    CHECK(complaint(folder, "a.gltf", twice) == "has the key \"nodes\" twice, needs it once");
    const auto nested = [](int depth) {
        return "\"extras\": " + std::string(depth, '[') + std::string(depth, ']') + ", ";
    };
    CHECK(complaint(folder, "a.gltf", gltf("{\"mesh\": 0}", "0", nested(199))) == "");
    CHECK(complaint(folder, "a.gltf", gltf("{\"mesh\": 0}", "0", nested(200))) ==
          "its JSON is nested more than 200 deep, in \"extras\"");
    CHECK(complaint(folder, "a.gltf", std::string(200000, '[')) == "its JSON is nested more than 200 deep");
    CHECK(complaint(folder, "a.gltf", gltf("{\"mesh\": 0},"))
              .starts_with("cannot be read as a mesh: not valid JSON: parse error at line 1, column "));
    std::string binary = "glTF";
    const std::string json = gltf("{\"mesh\": 0, \"children\": [0]}");
    for (const std::size_t word : {std::size_t(2), json.size() + 20, json.size(), std::size_t(0x4e4f534a)})
        binary += bytes_of_value(std::uint32_t(word), false);
    CHECK(complaint(folder, "a.glb", binary + json).starts_with("scenes[0].nodes has nodes[0], which is a child"));
    CHECK(complaint(folder, "a.glb", binary + json.substr(1)).starts_with("ends within its JSON ("));
}

TEST_CASE("glTF primitives that repeat their accessors too often are refused")
{
    const TempFolder folder;
    const std::string primitive = "{\"attributes\": {\"POSITION\": 0}, \"indices\": 1}";
    const auto repeated = [&](int times, const std::string& count) {
        std::string all = primitive;
        for (int i = 1; i < times; ++i) all += "," + primitive;
        const std::string text = replaced(gltf("{\"mesh\": 0}"), primitive, all);
        return complaint(
            folder, "a.gltf",
            replaced(text, "\"count\": 3, \"type\": \"VEC3\"", "\"count\": " + count + ", \"type\": \"VEC3\""));
    };
    CHECK(repeated(1000, "3") == "");
    CHECK(repeated(1000, "1000000") ==
          "its primitives have more than 300000000 vertices and corners, counted once for each use of an accessor; "
          "needs fewer: repeat meshes by nodes, or bake parts of the file");
    CHECK(repeated(2, "18446744073709551615").starts_with("its primitives have more than"));
}

TEST_CASE("glTF files are read or refused wherever they are cut or altered")
{
    const TempFolder folder;
    check_harmed(folder, "a.gltf", gltf("{\"children\": [1, 2]}, {\"mesh\": 0}, {\"mesh\": 0}"));
}

TEST_CASE("a small file with too many triangles is refused")
{
    const TempFolder folder;
    std::string text = collada(), numbers, sizes, indices;  // 300 triangles in each of 400000 nodes
    for (int i = 0; i < 300; ++i) sizes += "3 ", indices += "0 1 2 ";
    text = replaced(
        replaced(replaced(text, "polylist count=\"1\"", "polylist count=\"300\""), "<vcount>3", "<vcount>" + sizes),
        "<p>0 1 2", "<p>" + indices);
    std::string thousand, library;
    for (int i = 0; i < 1000; ++i) thousand += "<instance_geometry url=\"#g\"/>";
    for (int i = 0; i < 400; ++i) library += "<instance_node url=\"#many\"/>";
    text = replaced(replaced(text, "<library_nodes>", "<library_nodes><node id=\"many\">" + thousand + "</node>"),
                    "<node id=\"n\">", "<node id=\"n\">" + library);
    CHECK(complaint(folder, "a.dae", text) ==
          "its nodes repeat 300 triangles to more than 100000000, needs fewer; remove instances, or bake parts of the "
          "file");
}

#include "catch.h"
#include "mesh_text.h"
#include "temp_folder.h"

#include <spawnfield/error.h>
#include <spawnfield/scene.h>

#include <Eigen/Geometry>

#include <cstring>

using namespace spawnfield;

namespace {

/// What reading the bytes as a mesh says, without the file's name: "" if it reads them.
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

/// A file cut at every step-th byte, and with that byte altered, is read or refused by name, and never the end of the program.
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

const std::string ply_head = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                             "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
const std::string ply_square = ply_head + "0 0 0\n4 0 0\n4 3 0\n0 3 0\n3 0 1 2\n3 0 2 3\n";

template <class T>
std::string bytes_of_value(T value, bool big)
{
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return big ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

/// The square with a quad for a face, colours among the coordinates, and an element that is no concern of ours before both.
std::string binary_square(bool big, const std::string& line_end = "\n")
{
    std::string head = std::string("ply|format binary_") + (big ? "big" : "little") + "_endian 1.0|element camera 1|property list ushort double view|"
                       "element vertex 4|property double x|property uchar red|property float y|property short z|"
                       "element face 1|property uchar flags|property list uint ushort vertex_index|property list uchar float texcoord|end_header|";
    std::string bytes;
    for (const char c : head) bytes += c == '|' ? line_end : std::string(1, c);
    bytes += bytes_of_value(std::uint16_t(1), big) + bytes_of_value(2.5, big);
    for (const auto& [x, y] : {std::pair{0, 0}, std::pair{4, 0}, std::pair{4, 3}, std::pair{0, 3}})
        bytes += bytes_of_value(double(x), big) + '\x0a' + bytes_of_value(float(y), big) + bytes_of_value(std::int16_t(-7), big);
    bytes += '\x0d' + bytes_of_value(std::uint32_t(4), big);
    for (std::uint16_t corner = 0; corner < 4; ++corner) bytes += bytes_of_value(corner, big);
    return bytes + '\x01' + bytes_of_value(0.5f, big);
}

}  // namespace

TEST_CASE("PLY is read in text and in either order of bytes, whatever else it holds")
{
    const TempFolder folder;
    const auto bounds = [&](const std::string& bytes) {
        const Scene scene = load_scene(folder.write("square.ply", bytes));
        CHECK(scene.triangles.size() == 2);
        return scene.bounds();
    };
    CHECK(bounds(ply_square).max == Vec3(4, 3, 0));
    std::string other_lines = ply_square;
    for (std::size_t at = other_lines.find('\n'); at != std::string::npos; at = other_lines.find('\n', at + 2)) other_lines.replace(at, 1, "\r\n");
    CHECK(bounds(other_lines + "\r\n \r\n").max == Vec3(4, 3, 0));
    for (const bool big : {false, true})
        for (const char* line_end : {"\n", "\r\n", "\r"}) {
            const Bounds read = bounds(binary_square(big, line_end));
            CHECK(read.min == Vec3(0, 0, -7));
            CHECK(read.max == Vec3(4, 3, -7));
        }
}

TEST_CASE("a strip of a PLY file has a triangle for each corner after its second, all turned the same way")
{
    const TempFolder folder;
    const std::string strips = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
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
    const auto said = [&](const std::string& from, const std::string& to) { return complaint(folder, "a.ply", replaced(ply_square, from, to)); };
    CHECK(said("3 0 2 3\n", "3 0 2 40\n") == "line 16: a face has the corner 40, needs one of the 4 vertices, 0 .. 3");
    CHECK(said("3 0 2 3\n", "3 0 2 -1\n") == "line 16: a face has the corner -1, needs one of the 4 vertices, 0 .. 3");
    CHECK(said("3 0 2 3\n", "3 0 2 2000000000\n") == "line 16: a face has the corner 2e+09, needs one of the 4 vertices, 0 .. 3");
    CHECK(said("3 0 2 3\n", "3 0 2 1.5\n") == "line 16: a face has the corner 1.5, needs one of the 4 vertices, 0 .. 3");
    CHECK(said("3 0 2 3\n", "3 0 2 abc\n") == "line 16: \"abc\" is no number; element face, row 2 of 2");
    CHECK(said("3 0 2 3\n", "0\n") == "line 16: a face has 0 corners, needs 3 or more");
    CHECK(said("3 0 2 3\n", "-3 0 2 3\n") == "line 16: the list vertex_indices has the count -3, needs a whole number of 0 .. 2147483647");
    CHECK(said("3 0 2 3\n", "3 0 2\n") == "line 16: ends before its last number; element face, row 2 of 2");
    CHECK(said("3 0 2 3\n", "2 0 2 3\n") == "line 16: \"3\" stands after the row's last number; element face, row 2 of 2");
    CHECK(said("3 0 2 3\n", "") == "ends before element face, row 2 of 2; is it cut short?");
    CHECK(said("3 0 2 3\n", "3 0 2 3\n3 0 1 3\n") == "line 17: stands after the last row that the header tells of; are the counts of its elements right?");
    CHECK(said("4 3 0\n", "4 3\n") == "line 13: ends before its last number; element vertex, row 3 of 4");
    CHECK(said("vertex 4", "vertex 4294967295") == "line 4: element \"vertex\" has the count \"4294967295\", needs a whole number of 0 .. 2147483647");
    CHECK(said("vertex 4", "vertex 2000000000") ==
          "line 4: element vertex has 2000000000 rows, for which the file is too short (40 bytes left, needs 11999999999 or more); is it cut short?");
    CHECK(said("property float z\n", "") == "line 4: element vertex has no property z");
    CHECK(said("float z", "flaot z").starts_with("line 7: the type \"flaot\" is unknown; known: char"));
    CHECK(said("list uchar", "list float") == "line 9: a list is counted in \"float\", needs whole numbers");
    CHECK(said("int vertex_indices", "int corners") == "line 8: element face has no property list … vertex_indices");
    CHECK(said("ascii 1.0", "ascii 2.0").starts_with("line 2: the format is none that is known"));
    CHECK(said("end_header\n", "end_haeder\n").starts_with("line 10: \"end_haeder\" is no word of a PLY header"));
    CHECK(said("ply\n", "pyl\n") == "is no PLY file: its first line is not \"ply\"");
    CHECK(complaint(folder, "a.ply", "") == "is no PLY file: its first line is not \"ply\"");
    CHECK(complaint(folder, "a.ply", "ply\nformat ascii 1.0\n") == "ends within its header, before end_header; is it cut short?");
    const std::string binary = binary_square(false);
    CHECK(complaint(folder, "a.ply", binary.substr(0, binary.size() - 6)) == "element face, row 1 of 1: the file ends within it; is it cut short?");
    CHECK(complaint(folder, "a.ply", binary + "abc") == "has 3 bytes after the last row that the header tells of; are the counts of its elements right?");
    CHECK(complaint(folder, "noname", replaced(ply_square, "2 3\n", "2 9\n")) == "line 16: a face has the corner 9, needs one of the 4 vertices, 0 .. 3");
}

TEST_CASE("PLY files are read or refused wherever they are cut or altered")
{
    const TempFolder folder;
    check_harmed(folder, "a.ply", ply_square);
    check_harmed(folder, "a.ply", binary_square(false));
    check_harmed(folder, "a.ply", binary_square(true));
}

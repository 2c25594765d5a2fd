#include "catch.h"
#include "mesh_text.h"
#include "mesh_reader/obj_text.h"
#include "scene_text.h"
#include "temp_folder.h"

#include <spawnfield/error.h>
#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <cctype>

using namespace spawnfield;
using Catch::Contains;
using mesh_text::package_3mf;
using mesh_text::wedge_3mf;

namespace {

/// A corner of a box of 4 x 2 x 1, as a closed mesh. Each axis has a different length.
const std::string wedge = "o wedge\nv 0 0 0\nv 4 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

void check_wedge(const std::filesystem::path& file, const Vec3& size, const SceneOptions& options = {})
{
    const Scene scene = load_scene(file, options);
    const Bounds bounds = scene.bounds();
    CAPTURE(file, bounds.min.transpose(), bounds.max.transpose());
    CHECK(((bounds.max - bounds.min) - size).norm() < 1e-5);
    CHECK(scene.triangles.size() == 4);
    REQUIRE(scene.pieces.size() == 1);
    CHECK(scene.pieces[0].solid);
}

std::string notices_of(const Scene& scene)
{
    std::string all;
    for (const std::string& notice : scene.notices) all += notice + "\n";
    return all;
}

std::size_t count(const Scene& scene, Label label)
{
    return std::size_t(std::count(scene.triangle_labels.begin(), scene.triangle_labels.end(), label));
}

/// Returns a glTF text of a box of 4 x 2 x 1, with these members in its root.
std::string gltf_with(const std::string& members)
{
    return replaced(mesh_text::gltf({{.name = "crate", .mesh = hand::box({4, 2, 1})}}), "{", "{" + members);
}

}  // namespace

TEST_CASE("every common mesh format is read in its own unit and axes")
{
    const TempFolder folder;
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(folder.write("wedge.obj", wedge).string(), 0);
    REQUIRE(scene != nullptr);
    const auto written = [&](const char* format, const std::string& name) {
        REQUIRE(Assimp::Exporter().Export(scene, format, (folder / name).string()) == AI_SUCCESS);
        return folder / name;
    };
    const Vec3 as_it_is(4, 2, 1), turned_from_y_up(4, 1, 2);
    check_wedge(folder / "wedge.obj", as_it_is);
    check_wedge(written("stl", "text.stl"), as_it_is);
    check_wedge(written("stlb", "binary.stl"), as_it_is);
    check_wedge(written("ply", "text.ply"), as_it_is);
    check_wedge(written("plyb", "binary.PLY"), as_it_is);
    check_wedge(written("3ds", "wedge.3ds"),
                as_it_is);  // the format has z up; assimp turns it, and the reader turns it back
    check_wedge(written("glb2", "wedge.glb"), turned_from_y_up);
    check_wedge(written("gltf2", "wedge.gltf"), turned_from_y_up);
    check_wedge(written("collada", "wedge.dae"), turned_from_y_up);  // assimp writes Y_UP
}

TEST_CASE("FBX is read with its own unit and up axis")
{
    const TempFolder folder;
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(folder.write("wedge.obj", wedge).string(), 0);
    REQUIRE(Assimp::Exporter().Export(scene, "fbxa", (folder / "y.fbx").string()) == AI_SUCCESS);
    const std::string text = bytes_of(folder / "y.fbx");
    check_wedge(folder / "y.fbx", Vec3(0.04, 0.01, 0.02));  // centimetres, y up
    const std::string up = "\"UpAxis\", \"int\", \"Integer\", \"\", ",
                      unit = "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\", ";
    check_wedge(folder.write("z.fbx", replaced(text, up + "1", up + "2")), Vec3(0.04, 0.02, 0.01));
    check_wedge(folder.write("metres.fbx", replaced(text, unit + "1", unit + "100")), Vec3(4, 1, 2));
    check_wedge(folder.write("inches.fbx", replaced(replaced(text, unit + "1", unit + "2.54"), up + "1", up + "2")),
                0.0254 * Vec3(4, 2, 1));
}

TEST_CASE("a mesh in millimetres or on its side gets a notice, a plausible one gets none")
{
    const TempFolder folder;
    const auto notices = [&](const std::string& name, const Vec3& size, const SceneOptions& options) {
        std::string text = "o ground\n";
        for (const auto& [x, y] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{1, 1}, std::pair{0, 1}})
            text += "v " + std::to_string(x * size.x()) + " " + std::to_string(y * size.y()) + " " +
                    std::to_string(y * size.z()) + "\n";
        std::string all;
        for (const std::string& notice : load_scene(folder.write(name, text + "f 1 2 3 4\n"), options).notices)
            all += notice + "\n";
        return all;
    };
    const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    CHECK(!has(notices("good.obj", {100, 80, 1}, {}), "large"));
    CHECK(!has(notices("good.obj", {100, 80, 1}, {}), "side"));
    CHECK(has(notices("mm.obj", {100000, 80000, 1}, {}),
              "is 100000 x 80000 x 1 m, which is large; is it in millimetres? --scale 0.001 converts it to metres"));
    CHECK(!has(notices("mm.obj", {100000, 80000, 1}, {.scale = 0.001}), "large"));
    CHECK(has(notices("tiny.obj", {0.1, 0.2, 0.01}, {}), "which is small"));
    CHECK(has(notices("lying.obj", {100, 1, 80}, {}),
              "most of its faces look along y, few up; does it lie on its side? --up y or z"));
    CHECK(!has(notices("lying.obj", {100, 1, 80}, {.up = 'y'}), "side"));
}

TEST_CASE("glTF that requires an extension for geometry is refused, one for appearance is accepted")
{
    const TempFolder folder;
    const auto needs = [&](const std::string& extension) {
        return folder.write("a.gltf", gltf_with("\"extensionsRequired\": [\"" + extension + "\"],"));
    };
    CHECK_THROWS_WITH(load_scene(needs("KHR_mesh_quantization")),
                      Contains("a.gltf: needs the glTF extension KHR_mesh_quantization") && Contains("gltfpack -noq"));
    CHECK_THROWS_WITH(load_scene(needs("EXT_mesh_gpu_instancing")),
                      Contains("needs the glTF extension EXT_mesh_gpu_instancing"));
    CHECK_THROWS_WITH(
        load_scene(needs("KHR_draco_mesh_compression")),
        Contains("needs the glTF extension KHR_draco_mesh_compression") && Contains("gltf-transform copy"));
    CHECK_THROWS_WITH(load_scene(needs("FOO_bar")),
                      Contains("needs the glTF extension FOO_bar (extensionsRequired), which is unknown here"));
    CHECK_THROWS_AS(load_scene(needs("FOO_bar")), FileError);
    for (const char* extension :
         {"KHR_materials_unlit", "KHR_texture_transform", "KHR_lights_punctual", "EXT_texture_webp"})
        CHECK(load_scene(needs(extension)).triangles.size() == 12);
    CHECK(load_scene(folder.write("used.gltf", gltf_with("\"extensionsUsed\": [\"FOO_bar\"],"))).triangles.size() ==
          12);
}

TEST_CASE("glTF with instances or positions that are not floats is refused, required or not")
{
    const TempFolder folder;
    const std::string plain = gltf_with("");
    const std::string instances = replaced(
        plain, "\"name\":\"crate\"",
        "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{}}},\"name\":\"crate\"");
    CHECK_THROWS_WITH(load_scene(folder.write("a.gltf", instances)),
                      Contains("node \"crate\" has instances, by EXT_mesh_gpu_instancing"));
    CHECK_THROWS_WITH(
        load_scene(folder.write("a.gltf", replaced(plain, "\"componentType\":5126", "\"componentType\":5123"))),
        Contains("has positions that are not floats, because of KHR_mesh_quantization"));
    folder.write("robot.yaml", "format: spawnfield-robot/1\nparts: [{mesh: a.gltf}]\n");
    CHECK_THROWS_WITH(load_robot((folder / "robot.yaml").string()), Contains("KHR_mesh_quantization"));
}

TEST_CASE("3DS keeps its own axes, and up applies to these")
{
    const TempFolder folder;
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(folder.write("wedge.obj", wedge).string(), 0);
    REQUIRE(scene != nullptr);
    REQUIRE(Assimp::Exporter().Export(scene, "3ds", (folder / "a.3ds").string()) == AI_SUCCESS);
    const auto bounds = [&](char up) { return load_scene(folder / "a.3ds", {.up = up}).bounds(); };
    for (const char up : {char{0}, 'z'}) {
        CHECK((bounds(up).min - Vec3(0, 0, 0)).norm() < 1e-6);
        CHECK((bounds(up).max - Vec3(4, 2, 1)).norm() < 1e-6);
    }
    CHECK((bounds('y').min - Vec3(0, -1, 0)).norm() < 1e-6);  // (x, y, z) becomes (x, -z, y)
    CHECK((bounds('y').max - Vec3(4, 0, 2)).norm() < 1e-6);
    folder.write("scene.yaml",
                 "format: spawnfield-scene/1\nparts: [{name: a, mesh: a.3ds, up: y, scale: [1, 10, 100]}]\n");
    CHECK((load_scene(folder / "scene.yaml").bounds().min - Vec3(0, -100, 0)).norm() <
          1e-4);  // the scale is applied first, on the axes of the file
}

TEST_CASE("DXF, which assimp also turns, is read with its own axes")
{
    const TempFolder folder;
    std::string text = "0\nSECTION\n2\nENTITIES\n0\n3DFACE\n8\n0\n";
    for (const auto& [codes, corner] :
         {std::pair{0, "000"}, std::pair{1, "400"}, std::pair{2, "021"}, std::pair{3, "021"}})
        for (int axis = 0; axis < 3; ++axis)
            text += std::to_string(10 * (axis + 1) + codes) + "\n" + corner[axis] + "\n";
    const std::filesystem::path file = folder.write("a.dxf", text + "0\nENDSEC\n0\nEOF\n");
    const Bounds bounds = load_scene(file, {.any_mesh = true}).bounds();
    CHECK((bounds.min - Vec3(0, 0, 0)).norm() < 1e-6);
    CHECK((bounds.max - Vec3(4, 2, 1)).norm() < 1e-6);
}

TEST_CASE("a name that occurs twice in an OBJ has all its faces, and a name may contain blanks")
{
    const TempFolder folder;
    const std::string corners =
        "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 5 0 1\nv 9 0 1\nv 9 4 1\nv 5 4 1\nv 0 5 2\nv 4 5 2\nv 4 9 2\nv 0 9 2\n";
    const std::vector<LabelRule> rules{{"road*", Label::Terrain}, {"my road", Label::Terrain}, {"*", Label::Obstacle}};
    const auto terrain = [&](const std::string& text) {
        return count(load_scene(folder.write("a.obj", corners + text), {.labels = rules}), Label::Terrain);
    };
    const std::string first = "f 1 2 3 4\n", wall = "f 9 10 11 12\n", last = "f 5 6 7 8\n";
    CHECK(terrain("o road\n" + first + "o wall\n" + wall + "o road\n" + last) == 4);
    CHECK(terrain("g road\n" + first + "g wall\n" + wall + "g road\n" + last) == 4);
    CHECK(terrain("g road\n" + first + "o wall\n" + wall + "g road\n" + last) ==
          4);  // in assimp, o does not end the group
    CHECK(terrain("o road\n" + first + "g wall\n" + wall + "o road\n" + last) == 4);
    CHECK(terrain("o wall\n" + first + "o road\n" + wall + "o wall\n" + last) == 2);
    CHECK(terrain("o my road\r\n" + first + "o my wall\n" + wall + "o my road \n" + last) == 4);
    CHECK(notices_of(load_scene(folder / "a.obj", {.labels = {{"my wall", Label::Water}}})).find("matches no") ==
          std::string::npos);
}

TEST_CASE("faces under one name that is repeated stay one piece")
{
    const TempFolder folder;
    const Scene scene = load_scene(folder.write("a.obj", replaced(wedge, "f 1 2 4\n", "f 1 2 4\no wedge\n")));
    REQUIRE(scene.pieces.size() == 1);
    CHECK(scene.pieces[0].solid);
}

TEST_CASE("numbers in an OBJ may begin with a point, and lines with a blank")
{
    const TempFolder folder;
    const Scene scene = load_scene(
        folder.write("a.obj", "v 0 .25 -.5\nv 4 .25 +.5\nv 4 4. .5\nvt .5 .5\nvn .0 .0 1\nf 1/1/1 2/1/1 3/1/1\n"));
    CHECK((scene.bounds().min - Vec3(0, 0.25, -0.5)).norm() == 0);
    CHECK((scene.bounds().max - Vec3(4, 4, 0.5)).norm() == 0);
    CHECK(readable_obj("v 1.5 .5 -.5\n# a .5\nf 1 2 3\n").text == "v 1.5 0.5 -0.5\n# a .5\nf 1 2 3\n");
    CHECK(readable_obj("v 1 \\\n .5 .5\nf 1 2 3").text == "v 1 \\\n 0.5 0.5\nf 1 2 3");
    CHECK(readable_obj("").text.empty());
    CHECK(readable_obj(" v 1 1 1\n\tf 1 2 3\n \n").text == "v 1 1 1\nf 1 2 3\n\n");
    CHECK(load_scene(folder.write("indented.obj", "o a\n  v 0 0 0\n  v 4 0 0\n  v 4 4 0\n\tf 1 2 3\n"))
              .triangles.size() == 1);
}

TEST_CASE("glTF with a vertex index beyond its vertices is refused")
{
    const TempFolder folder;
    hand::Mesh mesh = hand::box({4, 2, 1});
    mesh.triangles[5][1] = 8;  // only 0 .. 7 are vertices
    CHECK_THROWS_WITH(load_scene(folder.write("a.gltf", mesh_text::gltf({{.mesh = mesh}}))),
                      Contains("1 of its 12 triangles refer to a vertex that does not exist"));
}

TEST_CASE("morph targets use the weights of their mesh; skins and weights of a node get a notice")
{
    const TempFolder folder;
    const std::string plain = mesh_text::gltf({{.name = "crate", .mesh = hand::box({4, 2, 1})}});
    const std::string attributes = "\"attributes\":{\"POSITION\":0}";
    // The target moves each corner by its own position, so weight 1 doubles the size.
    const auto with = [&](const std::string& weights) {
        return replaced(plain, "{\"primitives\":[{" + attributes,
                        "{" + weights + "\"primitives\":[{" + attributes + ",\"targets\":[{\"POSITION\":0}]");
    };
    const auto size = [&](const std::string& text) {
        const Bounds bounds = load_scene(folder.write("a.gltf", text), {.up = 'z'}).bounds();
        return Vec3(bounds.max - bounds.min);
    };
    CHECK((size(with("\"weights\":[1],")) - Vec3(8, 4, 2)).norm() < 1e-5);
    CHECK((size(with("\"weights\":[0.5],")) - Vec3(6, 3, 1.5)).norm() < 1e-5);
    CHECK((size(with("\"weights\":[0],")) - Vec3(4, 2, 1)).norm() < 1e-5);
    CHECK((size(with("")) - Vec3(4, 2, 1)).norm() < 1e-5);
    CHECK(load_scene(folder / "a.gltf").notices.size() == 1);  // the notice that everything is terrain
    const std::string posed = replaced(with("\"weights\":[1],"), "\"name\":\"crate\"",
                                       "\"weights\":[0],\"name\":\"crate\"");
    CHECK_THAT(notices_of(load_scene(folder.write("a.gltf", posed))),
               Contains("a.gltf: node \"crate\": the morph target weights of a node are ignored"));
    const std::string skinned = replaced(plain, "\"name\":\"crate\"", "\"skin\":0,\"name\":\"crate\"");
    const std::string skin = replaced(skinned, "\"materials\"", "\"skins\":[{\"joints\":[0]}],\"materials\"");
    CHECK_THROWS_WITH(load_scene(folder.write("a.gltf", skin)),
                      Contains("skin 0 has fewer inverseBindMatrices than joints"));
    const std::string matrices = replaced(
        skin, "\"joints\":[0]",
        "\"joints\":[0],\"inverseBindMatrices\":2");  // an accessor for the first 64 bytes of the corners
    const std::string accessor =
        ",{\"bufferView\":0,\"componentType\":5126,\"count\":1,\"type\":\"MAT4\"}],\"bufferViews\"";
    folder.write("a.gltf", replaced(matrices, "],\"bufferViews\"", accessor));
    CHECK_THAT(notices_of(load_scene(folder / "a.gltf")),
               Contains("node \"crate\": the joints of its skin are ignored"));
    folder.write("robot.yaml", "format: spawnfield-robot/1\nparts: [{mesh: a.gltf}]\n");
    CHECK_THAT(load_robot((folder / "robot.yaml").string()).notices[0],
               Contains("a.gltf: node \"crate\": the joints of its skin are ignored"));
}

TEST_CASE("a mesh of more than 1 km with walls gets a notice, hills get none")
{
    const TempFolder folder;
    const auto notices = [&](const Vec3& size) {
        return notices_of(load_scene(folder.write("a.obj", mesh_text::obj(hand::box(size)))));
    };
    CHECK_THAT(notices({12000, 9000, 3000}), Contains("is 12000 x 9000 x 3000 m and has a wall of 3000 m height; is it "
                                                      "in millimetres? --scale 0.001 converts it to metres"));
    CHECK_THAT(notices({12000, 9000, 830}), !Contains("millimetres"));  // as high as the highest tower
    CHECK_THAT(notices({12, 9, 3}), !Contains("millimetres"));
    const std::string slope = "v 0 0 0\nv 9000 0 0\nv 0 100 3000\nf 1 2 3\n";
    CHECK_THAT(notices_of(load_scene(folder.write("slope.obj", slope))), !Contains("millimetres"));
}

TEST_CASE("3MF and AMF are read in their unit, or else in millimetres")
{
    const TempFolder folder;
    check_wedge(folder.write("none.3mf", package_3mf("")), 0.001 * Vec3(4, 2, 1));
    check_wedge(folder.write("mm.3mf", package_3mf("unit=\"millimeter\"")), 0.001 * Vec3(4, 2, 1));
    check_wedge(folder.write("m.3MF", package_3mf("xml:lang=\"en\" requiredunits=\"\" unit = 'meter'")), Vec3(4, 2, 1));
    const auto amf = [&](const std::string& unit) {
        std::string text = "<?xml version=\"1.0\"?>\n<amf" + unit + "><object id=\"0\"><mesh><vertices>";
        for (const std::string corner : {"000", "400", "020", "001"})
            text += "<vertex><coordinates><x>" + corner.substr(0, 1) + "</x><y>" + corner.substr(1, 1) + "</y><z>" +
                    corner.substr(2) + "</z></coordinates></vertex>";
        text += "</vertices><volume>";
        for (const std::string face : {"021", "013", "032", "123"})
            text += "<triangle><v1>" + face.substr(0, 1) + "</v1><v2>" + face.substr(1, 1) + "</v2><v3>" +
                    face.substr(2) + "</v3></triangle>";
        return folder.write("a.amf", text + "</volume></mesh></object></amf>\n");
    };
    check_wedge(amf(" unit=\"feet\""), 0.3048 * Vec3(4, 2, 1), {.any_mesh = true});
    check_wedge(amf(" version=\"1.1\""), 0.001 * Vec3(4, 2, 1), {.any_mesh = true});
    check_wedge(folder.write("in.3mf", package_3mf("unit=\"inch\"")), 0.0254 * Vec3(4, 2, 1));
    CHECK_THROWS_WITH(load_scene(folder.write("bad.3mf", package_3mf("unit=\"mile\""))),
                      Contains("has the unit \"mile\", needs one of micron, millimeter"));
    const std::string good = package_3mf("unit=\"meter\"");
    for (std::size_t size = 0; size < good.size(); size += 7)  // cut at any byte: a result or a FileError
        try {
            load_scene(folder.write("cut.3mf", good.substr(0, size)));
        } catch (const FileError&) {
        }
}

TEST_CASE("only formats of the tests are read, by their extensions, unless any mesh is wanted")
{
    const TempFolder folder;
    const std::string ac3d =
        "AC3Db\nMATERIAL \"\" rgb 1 1 1 amb 0 0 0 emis 0 0 0 spec 0 0 0 shi 0 trans 0\nOBJECT poly\nnumvert 3\n"
        "0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x0\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nkids 0\n";
    const std::filesystem::path by_name = folder.write("a.ac", ac3d);
    CHECK(load_scene(by_name, {.any_mesh = true}).triangles.size() == 1);
    CHECK_THROWS_WITH(load_scene(by_name),
                      by_name.string() +
                          ": has the extension \".ac\", needs one of 3ds, 3mf, dae, fbx, glb, gltf, obj, "
                          "off, ply, stl; convert it, or read it all the same with --any-mesh");
    const std::filesystem::path robot = folder.write("robot.yaml",
                                                     "format: spawnfield-robot/1\nparts: [{mesh: a.ac}]\n");
    CHECK_THROWS_WITH(load_robot(robot.string()), Contains("--any-mesh"));
}

TEST_CASE("3MF packages that are too large, or whose components are wrong, are refused before they are unpacked")
{
    const TempFolder folder;
    const auto complaint = [&](const std::string& objects, const std::string& extra = "") {
        const std::filesystem::path file = folder.write("a.3mf", package_3mf("", objects, extra));
        try {
            load_scene(file);
        } catch (const FileError& error) {
            return std::string(error.what()).substr(file.string().size() + 2);
        }
        return std::string();
    };
    const auto object = [](int id, const std::string& parts) {
        std::string text = "<object id='" + std::to_string(id) + "'><components>";
        for (const char part : parts) text += "<component objectid='" + std::string(1, part) + "'/>";
        return text + "</components></object>";
    };
    CHECK(complaint(wedge_3mf) == "");
    CHECK(complaint(wedge_3mf + object(2, "11")) == "");
    CHECK(complaint(wedge_3mf + object(2, "13") + object(3, "2")) == "object \"2\" contains itself");
    CHECK(complaint(wedge_3mf + object(2, "17")) == "a component is object \"7\", which does not exist");
    std::string doubling = wedge_3mf, chain = wedge_3mf;
    for (int id = 2; id < 40; ++id) {
        const std::string half = "<component objectid='" + std::to_string(id - 1) + "'/>";
        doubling += "<object id='" + std::to_string(id) + "'><components>" + half + half + "</components></object>";
    }
    CHECK(complaint(doubling) ==
          "its components repeat triangles to more than 100000000, needs fewer; remove components");
    for (int id = 2; id < 2000; ++id)
        chain += "<object id='" + std::to_string(id) + "'><components><component objectid='" + std::to_string(id - 1) +
                 "'/></components></object>";
    CHECK_THAT(complaint(chain), Contains("nested more than 1000 deep"));
    CHECK_THAT(complaint(wedge_3mf, std::string(101000000, ' ')),
               Contains(" bytes unpack to 101 MB, needs at most 100"));
    CHECK(complaint(wedge_3mf, std::string(99000000, ' ')) == "");
}

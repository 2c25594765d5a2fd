#include "catch.h"
#include "temp_folder.h"

#include <spawnfield/scene.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <cctype>

using namespace spawnfield;

namespace {

/// A corner of a box of 4 x 2 x 1, closed: each axis has a length of its own.
const std::string wedge = "o wedge\nv 0 0 0\nv 4 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

void check_wedge(const std::filesystem::path& file, const Vec3& size)
{
    const Scene scene = load_scene(file);
    const Bounds bounds = scene.bounds();
    CAPTURE(file, bounds.min.transpose(), bounds.max.transpose());
    CHECK(((bounds.max - bounds.min) - size).norm() < 1e-5);
    CHECK(scene.triangles.size() == 4);
    REQUIRE(scene.pieces.size() == 1);
    CHECK(scene.pieces[0].solid);
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
    check_wedge(written("3ds", "wedge.3ds"), as_it_is);  // z up by its format; assimp turns it and so do we, back
    check_wedge(written("glb2", "wedge.glb"), turned_from_y_up);
    check_wedge(written("gltf2", "wedge.gltf"), turned_from_y_up);
    check_wedge(written("collada", "wedge.dae"), turned_from_y_up);  // assimp writes Y_UP
}

TEST_CASE("FBX is read with the unit and the up axis that it tells")
{
    const TempFolder folder;
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(folder.write("wedge.obj", wedge).string(), 0);
    REQUIRE(Assimp::Exporter().Export(scene, "fbxa", (folder / "y.fbx").string()) == AI_SUCCESS);
    const std::string text = bytes_of(folder / "y.fbx");
    check_wedge(folder / "y.fbx", Vec3(0.04, 0.01, 0.02));  // centimetres, y up
    const std::string up = "\"UpAxis\", \"int\", \"Integer\", \"\", ", unit = "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\", ";
    check_wedge(folder.write("z.fbx", replaced(text, up + "1", up + "2")), Vec3(0.04, 0.02, 0.01));
    check_wedge(folder.write("metres.fbx", replaced(text, unit + "1", unit + "100")), Vec3(4, 1, 2));
    check_wedge(folder.write("inches.fbx", replaced(replaced(text, unit + "1", unit + "2.54"), up + "1", up + "2")), 0.0254 * Vec3(4, 2, 1));
}

TEST_CASE("a mesh in millimetres or on its side gets a notice, a plausible one gets none")
{
    const TempFolder folder;
    const auto notices = [&](const std::string& name, const Vec3& size, const SceneOptions& options) {
        std::string text = "o ground\n";
        for (const auto& [x, y] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{1, 1}, std::pair{0, 1}})
            text += "v " + std::to_string(x * size.x()) + " " + std::to_string(y * size.y()) + " " + std::to_string(y * size.z()) + "\n";
        std::string all;
        for (const std::string& notice : load_scene(folder.write(name, text + "f 1 2 3 4\n"), options).notices) all += notice + "\n";
        return all;
    };
    const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
    CHECK(!has(notices("good.obj", {100, 80, 1}, {}), "large"));
    CHECK(!has(notices("good.obj", {100, 80, 1}, {}), "side"));
    CHECK(has(notices("mm.obj", {100000, 80000, 1}, {}), "is 100000 x 80000 x 1 m, which is large: is it in millimetres? --scale 0.001 makes it metres"));
    CHECK(!has(notices("mm.obj", {100000, 80000, 1}, {.scale = 0.001}), "large"));
    CHECK(has(notices("tiny.obj", {0.1, 0.2, 0.01}, {}), "which is small"));
    CHECK(has(notices("lying.obj", {100, 1, 80}, {}), "most of its faces look along y, few up: does it lie on its side? --up y or z"));
    CHECK(!has(notices("lying.obj", {100, 1, 80}, {.up = 'y'}), "side"));
}

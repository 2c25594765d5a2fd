#include "catch.h"
#include "mesh_text.h"
#include "program.h"
#include "scene_text.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>

#include <Eigen/Geometry>

#include <octomap/OcTree.h>

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

using namespace spawnfield;
using Catch::Matchers::Contains;

namespace {

constexpr double degree = std::numbers::pi / 180;
const SceneOptions by_slope{.auto_slope = 30 * degree};

Pose tilted(double degrees, const Vec3& position = Vec3::Zero())
{
    return {position, rotation_from_rpy(0, degrees * degree, 0)};
}

std::vector<double> layers_at(const Scene& scene, double x, double y)
{
    return column_at(Geometry(scene), x, y).layers;
}

/// Returns the number of terrain triangles for each name of a node.
std::map<std::string, std::uint64_t> terrain_of(const Scene& scene)
{
    std::map<std::string, std::uint64_t> out;
    for (const FaceGroup& group : scene.face_groups) out[group.node] += group.triangles[std::size_t(Label::Terrain)];
    return out;
}

std::string world_of(const std::string& models)
{
    return "<sdf version='1.9'><world name='test'>" + models + "</world></sdf>";
}

std::string model_of(const std::string& name, const std::string& geometry, const std::string& pose)
{
    return "<model name='" + name + "'><pose>" + pose +
           "</pose><static>1</static><link name='l'><collision name='c'><geometry>" + geometry +
           "</geometry></collision></link></model>";
}

std::string scan_of(octomap::OcTree& tree)
{
    std::ostringstream out;
    tree.writeBinary(out);
    return out.str();
}

}  // namespace

TEST_CASE("faces of shells that point up and are less steep than the limit are terrain, all others are obstacle")
{
    const TempFolder folder;
    std::vector<mesh_text::Node> nodes;
    for (const int slope : {0, 20, 29, 31, 60, 90})
        nodes.push_back({.name = "slope" + std::to_string(slope),
                         .mesh = moved(hand::rectangle(1, 1), tilted(slope, {3.0 * slope, 0, 0}))});
    nodes.push_back({.name = "ceiling", .mesh = hand::flipped(moved(hand::rectangle(1, 1), tilted(0, {0, 9, 3})))});
    const auto file = folder.write("office.obj", mesh_text::obj(nodes));
    const Scene scene = load_scene(file, by_slope);
    CHECK(scene.notices.empty());
    const std::map<std::string, std::uint64_t> expected = {
        {"slope0", 2}, {"slope20", 2}, {"slope29", 2}, {"slope31", 0}, {"slope60", 0}, {"slope90", 0}, {"ceiling", 0}};
    CHECK(terrain_of(scene) == expected);
    CHECK(terrain_of(load_scene(file, {.auto_slope = 65 * degree}))["slope60"] == 2);
    CHECK(layers_at(scene, 0.1, 0.2) == std::vector<double>{0});
    CHECK(layers_at(scene, 0.1, 9.2).empty());

    // A rule of --label comes first for everything that it names.
    const Scene labelled = load_scene(
        file, {.labels = {{"slope60", Label::Terrain}, {"slope0", Label::Water}}, .auto_slope = 30 * degree});
    CHECK(terrain_of(labelled)["slope60"] == 2);
    CHECK(terrain_of(labelled)["slope0"] == 0);
    CHECK(terrain_of(labelled)["slope20"] == 2);
}

TEST_CASE("a filled piece stays filled, and its winding does not matter")
{
    const TempFolder folder;
    const hand::Mesh table = mesh_text::box({0, 0, 0}, {2, 1, 0.7});
    for (const hand::Mesh& mesh : {table, hand::flipped(table)}) {
        const Scene scene = load_scene(folder.write("table.obj", mesh_text::obj(mesh)), by_slope);
        CHECK(scene.parts[0].solid_pieces == 1);
        CHECK(scene.count_labels()[std::size_t(Label::Obstacle)].triangles == 8);
        REQUIRE(layers_at(scene, 1.1, 0.4).size() == 1);
        CHECK(std::abs(layers_at(scene, 1.1, 0.4)[0] - 0.7) < 1e-6);
    }
    // A roof of 40 degrees is not terrain, a wedge of 20 degrees is.
    const auto wedge = [&](double degrees) {
        const double high = 4 * std::tan(degrees * degree);
        const hand::Mesh mesh = moved(hand::extruded({{0, 0}, {4, 0}, {4, high}}, 0, 3),
                                      {Vec3(0, 3, 0), rotation_from_rpy(std::numbers::pi / 2, 0, 0)});
        return load_scene(folder.write("wedge.obj", mesh_text::obj(mesh)), by_slope);
    };
    CHECK(layers_at(wedge(20), 2.1, 1.1).size() == 1);
    CHECK(layers_at(wedge(40), 2.1, 1.1).empty());
}

TEST_CASE("a shell that is inside out gets a notice")
{
    const TempFolder folder;
    const Scene scene = load_scene(folder.write("scan.obj", mesh_text::obj(hand::flipped(hand::rectangle(4, 3)))),
                                   by_slope);
    CHECK_FALSE(scene.has_terrain());
    REQUIRE(scene.notices.size() == 1);
    CHECK(scene.notices[0] ==
          "\"scan\": no face of its shells looks up and 12 m2 look down, so --auto-label labels them as obstacle; is "
          "the mesh inside out?");
}

TEST_CASE("auto_label in a scene file applies to its part, and the option applies to parts without a label")
{
    const TempFolder folder;
    folder.write("a.obj", mesh_text::obj({{.name = "floor", .mesh = hand::rectangle(1, 1)},
                                          {.name = "cloth", .mesh = moved(hand::rectangle(1, 1), tilted(0, {0, 0, 1}))},
                                          {.name = "wall", .mesh = moved(hand::rectangle(1, 1), tilted(90))}}));
    const auto terrain = [&](const std::string& keys, const SceneOptions& options = {}) {
        return terrain_of(load_parts(folder, "  - {name: a, mesh: a.obj" + keys + "}\n", options));
    };
    using Counts = std::map<std::string, std::uint64_t>;
    CHECK(terrain("") == Counts{{"floor", 0}, {"cloth", 0}, {"wall", 0}});
    CHECK(terrain(", auto_label: {slope: 30}, labels: [{node: cloth, label: obstacle}]") ==
          Counts{{"floor", 2}, {"cloth", 0}, {"wall", 0}});
    CHECK(terrain("", by_slope) == Counts{{"floor", 2}, {"cloth", 2}, {"wall", 0}});
    CHECK(terrain(", label: obstacle", by_slope) == Counts{{"floor", 0}, {"cloth", 0}, {"wall", 0}});
    const std::string part = "scene.yaml: part \"a\": ";
    CHECK_THROWS_WITH(
        terrain(", label: terrain, auto_label: {slope: 30}"),
        Contains(part + "auto_label is given together with label, needs only one of them (labels: is allowed)"));
    CHECK_THROWS_WITH(terrain(", auto_label: {slope: 90}"), Contains("slope is 90, needs > 0 and < 90 degrees"));
    CHECK_THROWS_WITH(terrain(", auto_label: {slope: 0}"), Contains("slope is 0, needs > 0"));
    CHECK_THROWS_WITH(terrain(", auto_label: {}"), Contains("slope is missing"));
    CHECK_THROWS_WITH(load_parts(folder, "  - {name: a, sphere: 1, auto_label: {slope: 30}}\n"),
                      Contains("auto_label"));
}

TEST_CASE("in a world, shapes that no name makes ground are labelled by their slope, one by one")
{
    const TempFolder folder;
    const std::string box = "<box><size>2 2 0.2</size></box>",
                      drum = "<cylinder><radius>0.5</radius><length>1</length></cylinder>";
    const std::string text = world_of(
        model_of("floor", "<box><size>9 9 0.1</size></box>", "0 0 -0.05 0 0 0") +
        model_of("floor_lamp", box, "5 0 3 0 0 0") + model_of("deck", box, "10 0 1 0 0 0.3") +
        model_of("slope", box, "20 0 1 0 0.4 0.3") + model_of("steep", box, "30 0 1 0 0.6 0") +
        model_of("drum", drum, "40 0 0.5 0 0 0") + model_of("log", drum, "50 0 0.5 0 1.5708 0") +
        model_of("ball", "<sphere><radius>1</radius></sphere>", "60 0 0 0 0 0"));
    const auto file = folder.write("test.world", text);
    const Scene scene = load_scene(file, by_slope);
    const double level = 1.1, ramp = 1 + 0.1 / std::cos(0.4);
    CHECK(layers_at(scene, 0.1, 0.1).size() == 1);
    CHECK(layers_at(scene, 5.1, 0.1).empty());  // its name excludes it from the ground
    CHECK(layers_at(scene, 10.1, 0.1) == std::vector<double>{level});
    REQUIRE(layers_at(scene, 20, 0).size() == 1);  // 23 degrees
    CHECK(std::abs(layers_at(scene, 20, 0)[0] - ramp) < 1e-9);
    CHECK(layers_at(scene, 30, 0).empty());  // 34 degrees
    CHECK(layers_at(scene, 40.1, 0.1) == std::vector<double>{1});
    CHECK(layers_at(scene, 50.1, 0.1).empty());
    CHECK(layers_at(scene, 60, 0).empty());
    // A tilted box becomes a filled mesh of the same size at the same place.
    const Scene plain = load_scene(file);
    CHECK((scene.bounds().min - plain.bounds().min).norm() < 1e-9);
    CHECK((scene.bounds().max - plain.bounds().max).norm() < 1e-9);
    CHECK(plain.triangles.empty());
    CHECK(scene.triangles.size() == 24);
    for (const Piece& piece : scene.pieces) CHECK(piece.solid);

    // If no name means ground, labels come from slopes, instead of terrain for everything.
    const auto desk = folder.write("desk.world",
                                   world_of(model_of("desk", box, "0 0 0 0 0 0") +
                                            model_of("ball", "<sphere><radius>1</radius></sphere>", "9 0 0 0 0 0")));
    CHECK_THAT(load_scene(desk).notices.back(),
               Contains("so everything is terrain, also walls and furniture. --auto-label slope=30 labels faces"));
    CHECK(layers_at(load_scene(desk), 9, 0).size() == 1);
    CHECK(layers_at(load_scene(desk, by_slope), 9, 0).empty());
    CHECK(layers_at(load_scene(desk, by_slope), 0.1, 0.1).size() == 1);
}

TEST_CASE("in an OctoMap floors and gentle hills are terrain, steep ones, walls and posts are not")
{
    const TempFolder folder;
    octomap::OcTree tree(0.1);
    const auto fill = [&](double x, double y, double z) { tree.updateNode(x, y, z, true, true); };
    const auto middle = [](int i) { return (i + 0.5) * 0.1; };
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 20; ++j) {
            fill(middle(i), middle(j), middle(0));  // a floor
            for (int k = 0; k < 20; ++k)
                if (i == 20 || i == 21) fill(middle(i), middle(j), middle(1 + k));  // a wall of two voxels
            fill(10 + middle(i), middle(j), middle(int(std::floor(i * std::tan(20 * degree)))));  // hills
            for (int k = 0; k < 2; ++k)
                fill(20 + middle(i), middle(j), middle(k + int(std::floor(i * std::tan(45 * degree)))));
        }
    for (int k = 1; k < 12; ++k) fill(middle(5), middle(5), middle(k));  // a post
    tree.updateInnerOccupancy();
    tree.prune();
    const auto file = folder.write("scan.bt", scan_of(tree));
    const Scene scene = load_scene(file, by_slope);
    const auto stands = [&](double x, double y, double z) {
        for (const double layer : layers_at(scene, x, y))
            if (std::abs(layer - z) < 1e-6) return true;
        return false;
    };
    int floor = 0, wall = 0, gentle = 0, steep = 0;
    for (int j = 1; j < 19; ++j) {
        for (const int i : {2, 9, 15, 25, 37}) floor += stands(middle(i), middle(j), 0.1);
        wall += !layers_at(scene, middle(20), middle(j)).empty();
        for (const int i : {3, 12, 20, 30}) {
            gentle += stands(10 + middle(i), middle(j), 0.1 * (1 + int(std::floor(i * std::tan(20 * degree)))));
            steep += !layers_at(scene, 20 + middle(i), middle(j)).empty();
        }
    }
    CHECK(floor == 90);
    CHECK(wall == 0);
    CHECK(gentle == 72);
    CHECK(steep == 0);
    CHECK(layers_at(scene, middle(5), middle(5)).empty());  // on the post
    CHECK(layers_at(load_scene(file), middle(5), middle(5)).size() == 1);
    // A room that was scanned from inside is free, and everything above its ceiling is unknown.
    octomap::OcTree room(0.1);
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j)
            for (int k = 0; k < 12; ++k) room.updateNode(middle(i), middle(j), middle(k), k == 0 || k == 11, true);
    room.updateInnerOccupancy();
    const auto scanned = folder.write("room.bt", scan_of(room));
    CHECK(layers_at(load_scene(scanned), middle(6), middle(6)).size() == 2);
    const Scene labelled = load_scene(scanned, by_slope);
    REQUIRE(layers_at(labelled, middle(6), middle(6)).size() == 1);
    CHECK(std::abs(layers_at(labelled, middle(6), middle(6))[0] - 0.1) < 1e-6);
    // A label rule applies to the OctoMap as a whole.
    CHECK_FALSE(load_scene(file, {.labels = {{"scan", Label::Obstacle}}, .auto_slope = 30 * degree}).has_terrain());
    CHECK_THROWS_WITH(
        load_parts(folder, "  - {name: a, octomap: scan.bt, auto_label: {slope: 30}, rpy: [0.1, 0, 0]}\n"),
        Contains("cannot be labelled by slope; set roll and pitch to 0"));
}

TEST_CASE("an unlabelled mesh gets a notice with options that can be pasted")
{
    const TempFolder folder;
    folder.write(
        "house.obj",
        mesh_text::obj(
            {{.name = "GroundFloor_1", .mesh = hand::rectangle(5, 5)},
             {.name = "floor[2]", .mesh = moved(hand::rectangle(5, 5), tilted(0, {0, 0, 3}))},
             {.name = "floor_lamp", .mesh = moved(hand::rectangle(1, 1), tilted(0, {0, 0, 6}))},
             {.name = "roof", .material = "asphalt", .mesh = moved(hand::rectangle(5, 5), tilted(0, {0, 0, 9}))}}));
    const std::string err = run_program(folder, "info house.obj").err;
    const std::string options = " --label '*ground*=terrain' --label 'floor\\[2]=terrain' --label '*asphalt*=terrain'";
    CHECK_THAT(err, Contains("notice: house.obj: no label is given, so everything is terrain, also walls and "
                             "furniture. --auto-label slope=30 labels faces that look up and are less steep than 30 "
                             "degrees as terrain, and the others as obstacle. These names look like ground:" +
                             options + "\n"));
    const ProgramRun pasted = run_program(folder, "info house.obj" + options);
    CHECK(pasted.err.find("matches no") == std::string::npos);
    CHECK_THAT(pasted.out, Contains("node \"floor[2]\", material \"material\": 2 triangles, z 3 to 3 m, terrain\n"));
    CHECK_THAT(pasted.out, Contains("node \"floor_lamp\", material \"material\": 2 triangles, z 6 to 6 m, obstacle\n"));
    folder.write("rock.obj", mesh_text::obj(hand::rectangle(5, 5)));
    CHECK_THAT(run_program(folder, "info rock.obj").err,
               Contains(". --label 'GLOB=terrain' labels by name (`info` lists the names)\n"));
}

TEST_CASE("bake and info accept --auto-label, and refuse it where it has no meaning")
{
    const TempFolder folder;
    folder.write("a.obj",
                 mesh_text::obj({{.name = "floor", .mesh = hand::rectangle(5, 5)},
                                 {.name = "wall", .mesh = moved(hand::rectangle(2, 2), tilted(90, {0, 0, 1}))}}));
    CHECK_THAT(run_program(folder, "info a.obj --auto-label slope=30").out,
               Contains("a: mesh, terrain and obstacle, 4 triangles"));
    CHECK(run_program(folder, "bake a.obj -o map --auto-label slope=30").status == 0);
    CHECK_THAT(run_program(folder, "info map").out,
               Contains("  terrain: 2 triangles, 0 primitives\n  obstacle: 2 triangles"));
    for (const char* const bad :
         {"30", "slope", "slope=", "slope=0", "slope=90", "slope=-5", "slope=30deg", "slope=x", "angle=30"}) {
        const ProgramRun run = run_program(folder, std::string("bake a.obj -o map --auto-label ") + bad);
        CHECK(run.status == 2);
        CHECK_THAT(run.err, Contains(std::string("--auto-label is \"") + bad +
                                     "\", needs slope=DEG with more than 0 and less than 90 degrees"));
    }
    folder.write("dem.asc", "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n1 2 3\n1 2 3\n");
    CHECK_THAT(run_program(folder, "info dem.asc --auto-label slope=30").err,
               Contains("is an elevation model: all of it is terrain"));
}

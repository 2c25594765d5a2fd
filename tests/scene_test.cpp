#include "this_build.h"
#include "catch.h"
#include "mesh_text.h"
#include "scene_text.h"
#include "shared_scenes.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>

#include <Eigen/Geometry>

#include <octomap/OcTree.h>

#include <numbers>
#include <sstream>

using namespace spawnfield;

namespace {

Vec3 size_of(const Bounds& bounds) { return bounds.max - bounds.min; }

void check_near(const Vec3& found, const Vec3& wanted, double margin = 1e-12)
{
    for (int axis = 0; axis < 3; ++axis) CHECK(found[axis] == Approx(wanted[axis]).margin(margin));
}

std::size_t count(const Scene& scene, Label label)
{
    return std::size_t(std::count(scene.triangle_labels.begin(), scene.triangle_labels.end(), label)) +
           std::size_t(std::count_if(scene.primitives.begin(), scene.primitives.end(),
                                     [&](const auto& p) { return p.label == label; }));
}

/// Returns an OctoMap file with a voxel from (0, 0, 0) to (0.5, 0.5, 0.5), a pruned cube of eight voxels at (2, 0, 0),
/// and a free voxel.
std::string octomap_bytes(bool full = false)
{
    octomap::OcTree tree(0.5);
    tree.updateNode(0.25, 0.25, 0.25, true);
    for (int i = 0; i < 8; ++i)
        tree.updateNode(2.25 + 0.5 * (i & 1), 0.25 + 0.25 * (i & 2), 0.25 + 0.125 * (i & 4), true);
    tree.updateNode(-3.25, 0.25, 0.25, false);
    tree.toMaxLikelihood();
    tree.prune();
    std::ostringstream out;
    if (full)
        tree.write(out);
    else
        tree.writeBinary(out);
    return out.str();
}

}  // namespace

TEST_CASE("every primitive is read with its size and pose")
{
    const TempFolder folder;
    const Scene scene = load_parts(folder,
                                   "  - {name: b, box: [1, 2, 3], xyz: [4, 5, 6], rpy: [0.1, -0.2, 0.3]}\n"
                                   "  - {name: s, sphere: 1.5, xyz: [-1, 0, 2]}\n"
                                   "  - {name: c, cylinder: {radius: 0.25, length: 4}}\n"
                                   "  - {name: k, capsule: {radius: 1, length: 2.5}}\n");
    REQUIRE(scene.primitives.size() == 4);
    CHECK(scene.name == "test");
    const Shape& box = scene.primitives[0].shape;
    CHECK(box.kind == ShapeKind::Box);
    CHECK(box.size == Vec3(1, 2, 3));
    CHECK(box.pose.position == Vec3(4, 5, 6));
    using Eigen::AngleAxisd;
    const Mat3 turned = (AngleAxisd(0.3, Vec3::UnitZ()) * AngleAxisd(-0.2, Vec3::UnitY()) *
                         AngleAxisd(0.1, Vec3::UnitX()))
                            .toRotationMatrix();
    CHECK(box.pose.rotation.isApprox(turned, 1e-14));

    CHECK(scene.primitives[1].shape.kind == ShapeKind::Sphere);
    CHECK(scene.primitives[1].shape.size[0] == 1.5);
    CHECK(scene.primitives[2].shape.kind == ShapeKind::Cylinder);
    CHECK(scene.primitives[2].shape.size.head<2>() == Eigen::Vector2d(0.25, 4));
    CHECK(scene.primitives[3].shape.kind == ShapeKind::Capsule);
    CHECK(scene.primitives[3].shape.size.head<2>() == Eigen::Vector2d(1, 2.5));
    for (std::uint32_t p = 0; p < 4; ++p) {
        CHECK(scene.primitives[p].part == p);
        CHECK(scene.parts[p].solid_pieces == 1);
    }
    CHECK(scene.parts[3].kind == "capsule");
    CHECK(scene.parts[3].name == "k");
}

TEST_CASE("bounds of each primitive are those of the solid itself")
{
    const TempFolder folder;
    const auto bounds = [&](const std::string& shape) {
        return load_parts(folder, "  - {name: a, " + shape + "}\n").bounds();
    };
    check_near(bounds("box: [1, 2, 3]").max, {0.5, 1, 1.5});
    check_near(size_of(bounds("box: [1, 2, 3], rpy_deg: [0, 0, 90]")), {2, 1, 3});
    check_near(bounds("sphere: 2, xyz: [1, 0, 0]").min, {-1, -2, -2});
    check_near(size_of(bounds("cylinder: {radius: 1, length: 4}, rpy_deg: [90, 0, 0]")), {2, 4, 2});
    check_near(size_of(bounds("capsule: {radius: 1, length: 4}, rpy_deg: [0, 90, 0]")), {6, 2, 2});
    // A cylinder at 45 degrees: the extents of its axis and of its disc.
    const double tilted = 4 * std::sqrt(0.5) + 2 * std::sqrt(0.5);
    check_near(size_of(bounds("cylinder: {radius: 1, length: 4}, rpy_deg: [45, 0, 0]")), {2, tilted, tilted});
}

TEST_CASE("roll, pitch and yaw turn about fixed axes, in radians or degrees")
{
    const TempFolder folder;
    const auto rotation = [&](const std::string& key) {
        return load_parts(folder, "  - {name: a, box: [1, 1, 1], " + key + "}\n").primitives[0].shape.pose.rotation;
    };
    check_near(rotation("rpy_deg: [0, 0, 90]") * Vec3::UnitX(), Vec3::UnitY());
    check_near(rotation("rpy_deg: [0, 90, 0]") * Vec3::UnitX(), -Vec3::UnitZ());
    check_near(rotation("rpy_deg: [90, 0, 90]") * Vec3::UnitY(), Vec3::UnitZ());  // roll first, about the fixed x
    CHECK(rotation("rpy_deg: [10, 20, 30]")
              .isApprox(rotation("rpy: [0.17453292519943295, 0.3490658503988659, 0.5235987755982988]"), 1e-14));
    CHECK(rotation("xyz: [1, 2, 3]") == Mat3::Identity());
}

TEST_CASE("a plane is a sheet of two triangles that face up")
{
    const TempFolder folder;
    const Scene scene = load_parts(folder,
                                   "  - {name: lake, label: water, plane: [4, 6], xyz: [1, 2, 3], sides: up}\n");
    REQUIRE(scene.triangles.size() == 2);
    REQUIRE(scene.pieces.size() == 1);
    CHECK(scene.vertices.size() == 4);
    CHECK_FALSE(scene.pieces[0].solid);
    CHECK(scene.pieces[0].sides_up);
    CHECK(scene.pieces[0].bottom == 3);
    CHECK(scene.parts[0].sheet_pieces == 1);
    CHECK(count(scene, Label::Water) == 2);
    check_near(scene.bounds().min, {-1, -1, 3});
    check_near(scene.bounds().max, {3, 5, 3});
    double area = 0;
    for (const Triangle& t : scene.triangles) {
        const Vec3 normal =
            (scene.vertices[t[1]] - scene.vertices[t[0]]).cross(scene.vertices[t[2]] - scene.vertices[t[0]]);
        CHECK(normal.z() > 0);
        area += normal.norm() / 2;
    }
    CHECK(area == Approx(24));
}

TEST_CASE("a tilted plane has the pose of its part")
{
    const TempFolder folder;
    const Scene scene = load_parts(
        folder, "  - {name: ramp, label: terrain, plane: [4, 2], xyz: [0, 0, 1], rpy_deg: [0, -30, 0]}\n");
    const Column column = column_at(Geometry(scene), 1.0, 0.5);
    REQUIRE(column.layers.size() == 1);
    CHECK(column.layers[0] == Approx(1 + std::tan(std::numbers::pi / 6)));
}

TEST_CASE("labels come from the part, and are obstacle if it has none")
{
    const TempFolder folder;
    const Scene scene = load_parts(
        folder,
        "  - {name: a, box: [1, 1, 1]}\n  - {name: b, label: terrain, box: [1, 1, 1]}\n"
        "  - {name: c, label: water, sphere: 1}\n  - {name: d, label: ignore, box: [99, 99, 99]}\n");
    REQUIRE(scene.primitives.size() == 3);
    CHECK(scene.primitives[0].label == Label::Obstacle);
    CHECK(scene.primitives[1].label == Label::Terrain);
    CHECK(scene.primitives[2].label == Label::Water);
    CHECK(scene.parts.size() == 4);
    CHECK(scene.parts[3].solid_pieces == 0);
    check_near(scene.bounds().max, {1, 1, 1});  // ignored parts do not widen the bounds
    CHECK(scene.has_terrain());
}

TEST_CASE("label rules of the call come first, the first match wins, case does not matter")
{
    const TempFolder folder;
    const std::string parts =
        "  - {name: Floor_1, label: obstacle, box: [1, 1, 1]}\n  - {name: floor_2, label: water, plane: [1, 1]}\n"
        "  - {name: wall, label: obstacle, box: [1, 1, 1]}\n";
    const SceneOptions options{.labels = {{"*_1", Label::Ignore}, {"FLOOR*", Label::Terrain}}};
    const Scene scene = load_parts(folder, parts, options);
    CHECK(scene.parts[0].label == Label::Ignore);
    CHECK(scene.parts[1].label == Label::Terrain);
    CHECK(scene.parts[2].label == Label::Obstacle);
    CHECK(count(scene, Label::Terrain) == 2);
    CHECK(count(scene, Label::Water) == 0);
}

TEST_CASE("a scene without a name has the name of its file")
{
    const TempFolder folder;
    const auto file = folder.write("yard.yaml", "format: spawnfield-scene/1\nparts: [{name: a, sphere: 1}]\n");
    CHECK(load_scene(file).name == "yard");
}

TEST_CASE("files are found beside the scene file, wherever the program runs")
{
    const TempFolder folder;
    folder.write("sub/box.obj", mesh_text::obj(hand::box({1, 1, 1})));
    const auto file = folder.write("sub/scene.yaml", "format: spawnfield-scene/1\nparts: [{name: a, mesh: box.obj}]\n");
    CHECK(load_scene(file).triangles.size() == 12);
}

TEST_CASE("each occupied leaf of an OctoMap part is a solid box of its size")
{
    const TempFolder folder;
    folder.write("scan.bt", octomap_bytes());
    const Scene scene = load_parts(
        folder, "  - {name: scan, label: terrain, octomap: scan.bt, xyz: [10, 0, 1], rpy_deg: [0, 0, 90]}\n");
    REQUIRE(scene.primitives.size() == 2);
    CHECK(scene.parts[0].solid_pieces == 2);
    CHECK(scene.parts[0].kind == "octomap");
    CHECK(count(scene, Label::Terrain) == 2);
    const Shape *small = &scene.primitives[0].shape, *large = &scene.primitives[1].shape;
    if (small->size[0] > large->size[0]) std::swap(small, large);
    CHECK(small->size == Vec3(0.5, 0.5, 0.5));
    CHECK(large->size == Vec3(1, 1, 1));
    check_near(small->pose.position, {10 - 0.25, 0.25, 1.25});  // (x, y) becomes (-y, x)
    check_near(large->pose.position, {10 - 0.5, 2.5, 1.5});
    const Column column = column_at(Geometry(scene), 9.5, 2.5);
    REQUIRE(column.layers.size() == 1);
    CHECK(column.layers[0] == Approx(2));
}

TEST_CASE("an OctoMap can be a scene: terrain with a notice, or with its label")
{
    const TempFolder folder;
    const auto file = folder.write("house.bt", octomap_bytes());
    const Scene plain = load_scene(file);
    CHECK(plain.name == "house");
    CHECK(count(plain, Label::Terrain) == 2);
    REQUIRE(plain.notices.size() == 2);
    CHECK_THAT(plain.notices[1], Contains("are unknown"));
    CHECK_THAT(plain.notices[0], Contains(file.string() + ": no label is given, so everything is terrain"));
    check_near(plain.bounds().min, {0, 0, 0});
    check_near(plain.bounds().max, {3, 1, 1});

    const Scene labelled = load_scene(file, {.labels = {{"Hou*", Label::Obstacle}, {"*", Label::Terrain}}});
    CHECK(count(labelled, Label::Obstacle) == 2);
    CHECK(labelled.notices.size() == 1);
    CHECK_THROWS_WITH(load_scene(file, {.labels = {{"*", Label::Ignore}}}),
                      file.string() + ": has no geometry: all parts are ignored");
    CHECK_THROWS_AS(load_scene(file, {.scale = 2}), ArgumentError);
    CHECK_THROWS_AS(load_scene(file, {.up = 'y'}), ArgumentError);
}

TEST_CASE("a full OctoMap has the same boxes as a binary one")
{
    const TempFolder folder;
    const Scene binary = load_scene(folder.write("a.bt", octomap_bytes())),
                full = load_scene(folder.write("a.ot", octomap_bytes(true)));
    REQUIRE(full.primitives.size() == 2);
    for (std::size_t i = 0; i < 2; ++i)
        CHECK(full.primitives[i].shape.pose.position == binary.primitives[i].shape.pose.position);
}

TEST_CASE("a mesh file without labels is terrain, with a notice")
{
    const TempFolder folder;
    const auto file = folder.write("hill.obj", mesh_text::obj(hand::box({2, 4, 6})));
    const Scene scene = load_scene(file);
    CHECK(count(scene, Label::Terrain) == 12);
    CHECK(scene.name == "hill");
    REQUIRE(scene.parts.size() == 1);
    CHECK(scene.parts[0].name == "hill");
    REQUIRE(scene.notices.size() == 1);
    CHECK_THAT(scene.notices[0], Contains("everything is terrain"));
}

TEST_CASE("a mesh file takes labels by node or material, and everything without a rule is an obstacle")
{
    const TempFolder folder;
    const auto file = folder.write(
        "town.obj", mesh_text::obj({{.name = "road", .material = "tar", .mesh = hand::box({1, 1, 1})},
                                    {.name = "pond", .material = "Blue", .mesh = hand::rectangle(1, 1)},
                                    {.name = "house", .material = "brick", .mesh = hand::box({1, 1, 1})}}));
    const Scene scene = load_scene(file, {.labels = {{"ROAD", Label::Terrain}, {"blu?", Label::Water}}});
    CHECK(count(scene, Label::Terrain) == 12);
    CHECK(count(scene, Label::Water) == 2);
    CHECK(count(scene, Label::Obstacle) == 12);
    CHECK(scene.notices.empty());
}

TEST_CASE("a mesh file is scaled, and then its up axis is applied")
{
    const TempFolder folder;
    const auto file = folder.write("a.obj", mesh_text::obj(mesh_text::box({0, 0, 0}, {1, 2, 3})));
    const Bounds bounds = load_scene(file, {.up = 'y', .scale = 0.5}).bounds();
    check_near(bounds.min, {0, -1.5, 0});
    check_near(bounds.max, {0.5, 0, 1});
}

TEST_CASE("the training arena has the heights of the thesis")
{
    const Scene scene = load_scene(std::filesystem::path(source_folder()) / "maps/training/scene.yaml");
    const Geometry geometry(scene);
    CHECK(scene.parts.size() == 16);
    const auto layers = [&](double x, double y) { return column_at(geometry, x, y).layers; };
    CHECK(layers(0, 0) == std::vector<double>{-0.1 + 0.05});
    REQUIRE(layers(-1.84, 7).size() == 1);  // the platform reaches into the floor, so there is one layer
    CHECK(layers(-1.84, 7)[0] == Approx(0.93));
    REQUIRE(layers(-7, 7).size() == 2);  // the underground box is 0.4 m below the floor
    CHECK(layers(-7, 7)[1] == Approx(-0.55));
    REQUIRE(layers(6, 2.5).size() == 2);
    CHECK(layers(6, 2.5)[0] == Approx(2.45));
    // The high end of the ramp, at smaller x, is at the height of the platform. Its low end is inside the floor.
    const double slope = std::tan(10 * std::numbers::pi / 180);
    CHECK(layers(1, 7)[0] == Approx(-0.254 + 0.5 / std::cos(10 * std::numbers::pi / 180) + 3 * slope));
    CHECK(layers(7.8, 7)[0] == Approx(-0.05));
    CHECK(column_at(geometry, 7.3, -7.4).water == std::vector<double>{1.45});
}

TEST_CASE("real scenes have as many triangles of each label as their sources document", "[real]")
{
    const auto shared = shared_scenes();
    if (!shared) return;
    struct Wanted {
        const char* file;
        std::size_t terrain, obstacle, water;
    };
    const Wanted scenes[] = {
        {"inspection/scene.yaml", 3360 + 340, 2067 + 7462,
         2},  // labels by materials; two triangles of the base station have no area
        {"kaykit_town/scene.yaml", 3642 + 720, 54985 - 3642 - 720 - 18,
         0},                                           // labels by nodes; 18 triangles are ignored or have no area
        {"interchange/scene.yaml", 448 + 900, 84, 0},  // labels by materials of an OBJ
    };
    for (const Wanted& wanted : scenes) {
        INFO(wanted.file);
        const Scene scene = load_scene(*shared / wanted.file);
        CHECK(count(scene, Label::Terrain) == wanted.terrain);
        CHECK(count(scene, Label::Obstacle) == wanted.obstacle);
        CHECK(count(scene, Label::Water) == wanted.water);
        const Part& part = scene.parts[0];
        CHECK(part.solid_pieces + part.sheet_pieces > 1);
    }
}

TEST_CASE("a label rule that matches nothing gets a notice")
{
    const TempFolder temp;
    temp.write("cube.obj", "o road_1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto file = temp.write(
        "scene.yaml",
        "format: spawnfield-scene/1\nparts:\n  - name: town\n    mesh: cube.obj\n    labels:\n"
        "      - {node: \"road*\", label: terrain}\n      - {node: \"raod*\", label: terrain}\n");
    SceneOptions options{.labels = {{"ROAD*", Label::Terrain}, {"lake*", Label::Water}}};
    const std::vector<std::string> notices = load_scene(file, options).notices;
    REQUIRE(notices.size() == 2);
    CHECK(notices[0] == file.string() + ": part \"town\": labels: node \"raod*\" matches nothing");
    CHECK_THAT(notices[1], Contains("label \"lake*\" matches no node, material or part; there are road_1"));
}

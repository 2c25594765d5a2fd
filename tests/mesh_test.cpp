#include "catch.h"
#include "mesh/face_pieces.h"
#include "mesh_text.h"
#include "scene_text.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>

#include <Eigen/Geometry>

#include <numbers>

using namespace spawnfield;
using mesh_text::box;

namespace {

void check_bounds(const Bounds& bounds, const Vec3& min, const Vec3& max, double margin = 1e-6)
{
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(bounds.min[axis] == Approx(min[axis]).margin(margin));
        CHECK(bounds.max[axis] == Approx(max[axis]).margin(margin));
    }
}

Scene load_mesh(const TempFolder& folder, const std::string& name, const std::string& bytes,
                const std::string& keys = "")
{
    folder.write(name, bytes);
    return load_parts(folder, "  - {name: thing, mesh: " + name + keys + "}\n");
}

/// Returns six times the volume if all triangles face outwards; the result is negative if they face inwards.
double signed_volume(const Scene& scene)
{
    double sum = 0;
    const Vec3 middle = (scene.bounds().min + scene.bounds().max) / 2;
    for (const Triangle& t : scene.triangles) {
        const Vec3 a = scene.vertices[t[0]] - middle, b = scene.vertices[t[1]] - middle,
                   c = scene.vertices[t[2]] - middle;
        sum += a.dot(b.cross(c));
    }
    return sum / 6;
}

std::size_t count(const Scene& scene, Label label)
{
    return std::size_t(std::count(scene.triangle_labels.begin(), scene.triangle_labels.end(), label));
}

/// Returns a box that differs in each direction: x 1..3, y 10..14, z 100..108.
hand::Mesh marker() { return box({1, 10, 100}, {3, 14, 108}); }

const std::vector<double> shifted_by_5_in_x = {1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
const std::vector<double> turned_about_z = {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // x becomes y
const std::vector<double> mirrored_in_x = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

}  // namespace

TEST_CASE("OBJ and STL are read without conversion, z up")
{
    const TempFolder folder;
    const auto [name, bytes] = GENERATE(std::pair("a.obj", mesh_text::obj(marker())),
                                        std::pair("a.stl", mesh_text::stl(marker())),
                                        std::pair("A.OBJ", mesh_text::obj(marker())));
    const Scene scene = load_mesh(folder, name, bytes);
    check_bounds(scene.bounds(), {1, 10, 100}, {3, 14, 108});
    CHECK(scene.triangles.size() == 12);
    CHECK(scene.vertices.size() == 8);  // corners are welded, also if the file repeats them
    CHECK(scene.parts[0].solid_pieces == 1);
    CHECK(scene.parts[0].open_edges == 0);
    CHECK(scene.pieces[0].bottom == 100);
    CHECK(signed_volume(scene) == Approx(64));
}

TEST_CASE("up: y converts (x, y, z) to (x, -z, y)")
{
    const TempFolder folder;
    check_bounds(load_mesh(folder, "a.obj", mesh_text::obj(marker()), ", up: y").bounds(), {1, -108, 10},
                 {3, -100, 14});
    check_bounds(load_mesh(folder, "a.obj", mesh_text::obj(marker()), ", up: z").bounds(), {1, 10, 100}, {3, 14, 108});
}

TEST_CASE("scale is one number or three, on the axes of the file")
{
    const TempFolder folder;
    check_bounds(load_mesh(folder, "a.obj", mesh_text::obj(marker()), ", scale: 0.5").bounds(), {0.5, 5, 50},
                 {1.5, 7, 54});
    check_bounds(load_mesh(folder, "a.obj", mesh_text::obj(marker()), ", scale: [2, 3, 0.1]").bounds(), {2, 30, 10},
                 {6, 42, 10.8});
    check_bounds(load_mesh(folder, "a.obj", mesh_text::obj(marker()), ", scale: [2, 3, 0.1], up: y").bounds(),
                 {2, -10.8, 30}, {6, -10, 42});
}

TEST_CASE("unit, scale, up, rpy and xyz are applied in this order")
{
    const TempFolder folder;
    const std::string bytes = mesh_text::dae({{.mesh = marker()}}, {.up = "Y_UP", .unit = 0.01});
    const Scene scene = load_mesh(folder, "a.dae", bytes,
                                  ", scale: [100, 200, 300], rpy_deg: [0, 0, 90], xyz: [1000, 2000, 3000]");
    // With unit and scale: x 1..3, y 20..28, z 300..324. With up: y -324..-300, z 20..28. A quarter turn: (x, y)
    // becomes (-y, x).
    check_bounds(scene.bounds(), {1300, 2001, 3020}, {1324, 2003, 3028}, 1e-4);
}

TEST_CASE("COLLADA's up axis is used unless the part has its own")
{
    const TempFolder folder;
    const auto bounds = [&](const std::string& axis, const std::string& keys = "") {
        return load_mesh(folder, "a.dae", mesh_text::dae({{.mesh = marker()}}, {.up = axis}), keys).bounds();
    };
    check_bounds(bounds("Z_UP"), {1, 10, 100}, {3, 14, 108});
    check_bounds(bounds("Y_UP"), {1, -108, 10}, {3, -100, 14});
    check_bounds(bounds(""), {1, -108, 10}, {3, -100, 14});        // COLLADA's default is Y_UP
    check_bounds(bounds("X_UP"), {-14, -108, 1}, {-10, -100, 3});  // x is up, -y is right, z points to the viewer
    check_bounds(bounds("Y_UP", ", up: z"), {1, 10, 100}, {3, 14, 108});
    check_bounds(bounds("Z_UP", ", up: y"), {1, -108, 10}, {3, -100, 14});
}

TEST_CASE("COLLADA's unit is applied once")
{
    const TempFolder folder;
    const std::string bytes = mesh_text::dae({{.mesh = marker(), .matrix = shifted_by_5_in_x}}, {.unit = 0.0254});
    check_bounds(load_mesh(folder, "a.dae", bytes).bounds(), {6 * 0.0254, 10 * 0.0254, 100 * 0.0254},
                 {8 * 0.0254, 14 * 0.0254, 108 * 0.0254});
}

TEST_CASE("glTF is y up and in metres")
{
    const TempFolder folder;
    const std::string bytes = mesh_text::gltf({{.mesh = marker()}});
    check_bounds(load_mesh(folder, "a.gltf", bytes).bounds(), {1, -108, 10}, {3, -100, 14});
    check_bounds(load_mesh(folder, "a.gltf", bytes, ", up: z").bounds(), {1, 10, 100}, {3, 14, 108});
}

TEST_CASE("the matrix of a node is applied before those of its parents")
{
    const TempFolder folder;
    const mesh_text::Node child{.name = "child", .mesh = box({1, 10, 100}, {3, 14, 108}), .matrix = shifted_by_5_in_x};
    const std::vector<mesh_text::Node> nodes = {{.name = "parent", .matrix = turned_about_z, .children = {child}}};
    // After the shift: x 6..8. After the turn: (x, y) becomes (-y, x).
    check_bounds(load_mesh(folder, "a.dae", mesh_text::dae(nodes)).bounds(), {-14, 6, 100}, {-10, 8, 108});
    check_bounds(load_mesh(folder, "a.gltf", mesh_text::gltf(nodes), ", up: z").bounds(), {-14, 6, 100}, {-10, 8, 108});
}

TEST_CASE("the faces of a mirrored node still point outwards")
{
    const TempFolder folder;
    const std::vector<mesh_text::Node> nodes = {{.mesh = marker(), .matrix = mirrored_in_x}};
    for (const Scene& scene :
         {load_mesh(folder, "a.gltf", mesh_text::gltf(nodes)), load_mesh(folder, "a.dae", mesh_text::dae(nodes))}) {
        CHECK(scene.bounds().max.x() == Approx(-1));
        CHECK(signed_volume(scene) == Approx(64));
        CHECK(scene.parts[0].solid_pieces == 1);
    }
    const Scene inside_out = load_mesh(folder, "b.obj", mesh_text::obj(hand::flipped(marker())));
    CHECK(signed_volume(inside_out) == Approx(-64));  // shows that the check above can fail
    CHECK(inside_out.parts[0].solid_pieces == 1);     // normals do not matter
}

TEST_CASE("a mirrored sheet with sides: up still faces up")
{
    const TempFolder folder;
    const std::vector<mesh_text::Node> nodes = {{.mesh = hand::rectangle(2, 2), .matrix = mirrored_in_x}};
    folder.write("a.dae", mesh_text::dae(nodes));
    const Scene scene = load_parts(folder, "  - {name: a, mesh: a.dae, label: terrain, sides: up}\n");
    CHECK(scene.pieces[0].sides_up);
    CHECK(column_at(Geometry(scene), 0.3, 0.2).layers == std::vector<double>{0});
}

TEST_CASE("label rules match the name of the node or the material; the first match wins, case does not matter")
{
    const TempFolder folder;
    const std::vector<mesh_text::Node> nodes = {
        {.name = "Terrain.001", .material = "Grass", .mesh = hand::rectangle(1, 1)},
        {.name = "house", .material = "Brick", .mesh = hand::box({1, 1, 1})},
        {.name = "terrain_lake", .material = "deepwater_3", .mesh = hand::rectangle(1, 1)},
        {.name = "paint", .material = "White", .mesh = hand::rectangle(3, 3)}};
    const std::string rules =
        ", labels: [{material: \"*WATER*\", label: water}, {node: \"terrain*\", label: terrain}, "
        "{material: white, label: ignore}, {node: Grass, label: ignore}, {material: house, label: ignore}]";
    const auto [name, bytes] = GENERATE_COPY(std::pair("a.dae", mesh_text::dae(nodes)),
                                             std::pair("a.gltf", mesh_text::gltf(nodes)),
                                             std::pair("a.obj", mesh_text::obj(nodes)));
    INFO(name);
    folder.write("a.mtl", "");
    const Scene scene = load_mesh(folder, name, bytes, rules);
    CHECK(count(scene, Label::Terrain) == 2);
    CHECK(count(scene, Label::Water) == 2);
    CHECK(count(scene, Label::Obstacle) == 12);
    CHECK(scene.triangles.size() == 16);
    CHECK(scene.bounds().max.x() == 0.5);  // the ignored sheet does not widen the bounds
    CHECK(scene.parts[0].label == Label::Obstacle);
}

TEST_CASE("a rule with node and material applies if both match")
{
    const TempFolder folder;
    std::vector<mesh_text::Node> nodes;
    for (const char* const name : {"floor", "table"})
        for (const char* const material : {"wood", "stone"})
            nodes.push_back(
                {.name = name + std::string("_") + material, .material = material, .mesh = hand::rectangle(1, 1)});
    const auto terrain = [&](const std::string& rules) {
        const Scene scene = load_mesh(folder, "a.obj", mesh_text::obj(nodes), ", labels: [" + rules + "]");
        std::string names;
        for (const FaceGroup& group : scene.face_groups)
            names += group.triangles[std::size_t(Label::Terrain)] > 0 ? group.node + " " : "";
        for (const std::string& notice : scene.notices) names += notice.substr(notice.find("labels:"));
        return names;
    };
    CHECK(terrain("{node: 'floor*', material: wood, label: terrain}") == "floor_wood ");
    CHECK(terrain("{material: wood, node: 'FLOOR*', label: obstacle}, {material: wood, label: terrain}") ==
          "table_wood ");
    CHECK(terrain("{node: 'floor*', label: terrain}") == "floor_wood floor_stone ");
    // Both names exist, but not together.
    CHECK(terrain("{node: floor_wood, material: stone, label: terrain}") ==
          "labels: node \"floor_wood\" with material \"stone\" matches nothing");
}

TEST_CASE("a rule matches the node that has the mesh, not its ancestors")
{
    const TempFolder folder;
    const mesh_text::Node child{.name = "slab", .mesh = hand::box({1, 1, 1})};
    const std::string bytes = mesh_text::gltf({{.name = "terrain", .matrix = shifted_by_5_in_x, .children = {child}}});
    CHECK(count(load_mesh(folder, "a.gltf", bytes, ", labels: [{node: terrain, label: terrain}]"), Label::Terrain) ==
          0);
    CHECK(count(load_mesh(folder, "a.gltf", bytes, ", labels: [{node: slab, label: terrain}]"), Label::Terrain) == 12);
}

TEST_CASE("in an OBJ, the last o or g is the node")
{
    const TempFolder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    const Scene scene = load_mesh(folder, "a.obj", corners + "o plaza\nf 1 2 3\ng road\nf 2 4 3\n",
                                  ", labels: [{node: road, label: terrain}, {node: plaza, label: water}]");
    CHECK(count(scene, Label::Terrain) == 1);
    CHECK(count(scene, Label::Water) == 1);
}

TEST_CASE("each solid piece is found: two cubes in one node are two pieces")
{
    const TempFolder folder;
    hand::Mesh cubes = hand::box({1, 1, 1});
    const hand::Mesh second = box({5, 5, 5}, {6, 6, 6});
    for (const Triangle& t : second.triangles) cubes.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    cubes.vertices.insert(cubes.vertices.end(), second.vertices.begin(), second.vertices.end());
    const Scene scene = load_mesh(folder, "a.stl", mesh_text::stl(cubes));
    REQUIRE(scene.pieces.size() == 2);
    CHECK(scene.parts[0].solid_pieces == 2);
    CHECK(scene.parts[0].sheet_pieces == 0);
    CHECK(scene.pieces[0].triangle_count == 12);
    CHECK(scene.pieces[1].first_triangle == 12);
    CHECK(scene.pieces[1].bottom == 5);
}

TEST_CASE("a cube with a missing face is a sheet, and its open edges are counted; its closed neighbour stays solid")
{
    const TempFolder folder;
    const hand::Mesh house = hand::without(hand::box({1, 1, 1}), 0, 2), shed = box({3, 0, 0}, {4, 1, 1});
    const Scene scene = load_mesh(folder, "a.obj",
                                  mesh_text::obj({{.name = "house", .mesh = house}, {.name = "shed", .mesh = shed}}));
    CHECK(scene.parts[0].solid_pieces == 1);
    CHECK(scene.parts[0].sheet_pieces == 1);
    CHECK(scene.parts[0].open_edges == 4);
    CHECK(scene.parts[0].triangles == 22);
    const Geometry geometry(scene);
    CHECK(column_at(geometry, 0.1, 0.2).spans.size() == 2);  // floor and roof of a shell
    CHECK(column_at(geometry, 3.5, 0.5).spans.size() == 1);  // filled
}

TEST_CASE("solid: false makes closed pieces hollow, solid: true fills open ones")
{
    const TempFolder folder;
    const std::string closed = mesh_text::obj(hand::box({1, 1, 1})),
                      open = mesh_text::obj(hand::without(hand::box({1, 1, 1}), 0, 2));
    CHECK(load_mesh(folder, "a.obj", closed, ", solid: auto").parts[0].solid_pieces == 1);
    CHECK(load_mesh(folder, "a.obj", closed, ", solid: true").parts[0].solid_pieces == 1);
    CHECK(load_mesh(folder, "a.obj", closed, ", solid: false").parts[0].sheet_pieces == 1);
    CHECK(load_mesh(folder, "a.obj", open, ", solid: false").parts[0].sheet_pieces == 1);
    const Scene filled = load_mesh(folder, "a.obj", open, ", solid: true");
    CHECK(filled.parts[0].solid_pieces == 1);
    CHECK(filled.parts[0].open_edges == 4);
    CHECK(column_at(Geometry(filled), 0.1, 0.2).spans.size() == 1);
}

TEST_CASE("a closed piece with faces that are water or ignored is not solid")
{
    const TempFolder folder;
    // Primitives of one node with different materials: the top of a basin is two of its twelve triangles.
    const std::string name = GENERATE("water", "ignore");
    const hand::Mesh cube = hand::box({1, 1, 1});
    std::string text = "o basin\n";
    for (const Vec3& v : cube.vertices)
        text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
    for (std::size_t t = 0; t < 12; ++t) {
        text += t == 0 ? "usemtl other\n" : t == 2 ? "usemtl wall\n" : "";
        text += "f " + std::to_string(cube.triangles[t][0] + 1) + " " + std::to_string(cube.triangles[t][1] + 1) + " " +
                std::to_string(cube.triangles[t][2] + 1) + "\n";
    }
    const Scene scene = load_mesh(folder, "a.obj", text, ", labels: [{material: other, label: " + name + "}]");
    CHECK(scene.parts[0].solid_pieces == 0);
    CHECK(scene.parts[0].sheet_pieces == 1);
    CHECK(count(scene, Label::Obstacle) == 10);
    CHECK(count(scene, Label::Water) == (name == "water" ? 2 : 0));
    CHECK(load_mesh(folder, "a.obj", text, ", labels: [{material: other, label: terrain}]").parts[0].solid_pieces == 1);
}

TEST_CASE("a part with only ignored faces has no pieces")
{
    const TempFolder folder;
    folder.write("a.obj", mesh_text::obj(hand::box({1, 1, 1})));
    const Scene scene = load_parts(folder, "  - {name: a, label: ignore, mesh: a.obj}\n  - {name: b, sphere: 1}\n");
    CHECK(scene.triangles.empty());
    CHECK(scene.vertices.empty());
    CHECK(scene.parts[0].triangles == 0);
}

TEST_CASE("triangles with equal corners are dropped, and so are lines and points")
{
    const TempFolder folder;
    const Scene scene = load_mesh(
        folder, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 1 0\nf 1 2 3\nf 1 2 4\nl 1 5\np 5\nf 2 5 3\n");
    CHECK(scene.triangles.size() == 2);
    CHECK(scene.parts[0].open_edges == 4);
}

TEST_CASE("polygons are split into triangles")
{
    const TempFolder folder;
    const Scene scene = load_mesh(folder, "a.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\n");
    CHECK(scene.triangles.size() == 3);
    double area = 0;
    for (const Triangle& t : scene.triangles)
        area +=
            (scene.vertices[t[1]] - scene.vertices[t[0]]).cross(scene.vertices[t[2]] - scene.vertices[t[0]]).norm() / 2;
    CHECK(area == Approx(3));
}

TEST_CASE("pieces are connected over edges, not over corners")
{
    const std::vector<Triangle> bow_tie = {{0, 1, 2}, {2, 3, 4}};
    CHECK(find_pieces(bow_tie).of_face == std::vector<std::uint32_t>{0, 1});
    const std::vector<Triangle> strip = {{5, 6, 7}, {0, 1, 2}, {3, 2, 1}, {6, 5, 8}};
    const FacePieces pieces = find_pieces(strip);
    CHECK(pieces.of_face == std::vector<std::uint32_t>{0, 1, 1, 0});
    CHECK(pieces.open_edges == std::vector<std::uint32_t>{4, 4});
}

TEST_CASE("an edge with four faces is closed, one with three is open")
{
    // The same triangle with both windings, as in many real files.
    const std::vector<Triangle> doubled = {{0, 1, 2}, {2, 1, 0}};
    CHECK(find_pieces(doubled).open_edges == std::vector<std::uint32_t>{0});
    const std::vector<Triangle> fin = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
    CHECK(find_pieces(fin).open_edges == std::vector<std::uint32_t>{7});
}

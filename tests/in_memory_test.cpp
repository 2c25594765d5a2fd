#include "catch.h"
#include "mesh_text.h"
#include "temp_folder.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include <spawnfield/bake.h>
#include <spawnfield/error.h>
#include <spawnfield/poses.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

using namespace spawnfield;

namespace {

bool is_same(const Scene& a, const Scene& b)
{
    const auto is_same_piece = [](const Piece& l, const Piece& r) {
        return l.first_triangle == r.first_triangle && l.triangle_count == r.triangle_count && l.solid == r.solid &&
               l.open == r.open && l.bottom == r.bottom;
    };
    return a.vertices == b.vertices && a.triangles == b.triangles && a.triangle_labels == b.triangle_labels &&
           std::equal(a.pieces.begin(), a.pieces.end(), b.pieces.begin(), b.pieces.end(), is_same_piece);
}

/// A mesh whose triangles share no vertex.
hand::Mesh unwelded(const hand::Mesh& mesh)
{
    hand::Mesh out;
    for (const Triangle& triangle : mesh.triangles) {
        const auto first = std::uint32_t(out.vertices.size());
        for (const std::uint32_t corner : triangle) out.vertices.push_back(mesh.vertices[corner]);
        out.triangles.push_back({first, first + 1, first + 2});
    }
    return out;
}

}  // namespace

TEST_CASE("a map made in memory gives the same answers as the folder that bake writes")
{
    const TempFolder temp;
    const auto file = temp.write("scene.txt", "stands for the scene's file");
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        CAPTURE(seed);
        const Scene scene = random_scene(seed);
        const BakeOptions options{.resolution = 0.3, .z = seed == 2 ? ZRange{-1, 2} : ZRange{}};
        bake(scene, file, temp / "map", options);
        const Map baked = read_map(temp / "map"), made = make_map(scene, options);
        CHECK((made.layers == baked.layers && made.bounds.min == baked.bounds.min &&
               made.bounds.max == baked.bounds.max));
        CHECK((made.resolution == baked.resolution && made.z_limits == baked.z_limits));
        REQUIRE(made.floors->size() == baked.floors->size());
        for (std::size_t f = 0; f < made.floors->size(); ++f)
            CHECK((*made.floors)[f].height == (*baked.floors)[f].height);
        const Robot robot = random_robot(seed);
        for (const Obstacles obstacles : {Obstacles::Geometry, Obstacles::Voxels}) {
            const Judge of_file(baked, robot, {.obstacles = obstacles}),
                of_memory(made, robot, {.obstacles = obstacles});
            const RasterResult there = raster(of_file, {.step = 0.7}), here = raster(of_memory, {.step = 0.7});
            CHECK(csv_of(here) == csv_of(there));
            CHECK(here.exact_checks == there.exact_checks);
            const SampleOptions wanted{.count = 40, .min_distance = 0.3, .random_yaw = true, .stance = Stance::Level};
            CHECK(spawns_csv(sample(of_memory, wanted)) == spawns_csv(sample(of_file, wanted)));
        }
    }
}

TEST_CASE("a mesh from code is welded and cut into pieces as one from a file")
{
    const TempFolder folder;
    const hand::Mesh closed = hand::moved(hand::box({2, 1, 0.5}), {{1, 2, 3}, Mat3::Identity()});
    for (const hand::Mesh& mesh : {closed, hand::without(closed, 0, 2)}) {
        const Scene read = load_scene(folder.write("a.obj", mesh_text::obj(mesh)));
        for (const hand::Mesh& given : {mesh, unwelded(mesh)}) {
            Scene made;
            add_mesh(made, "a", Label::Terrain, given.vertices, given.triangles);
            CHECK(is_same(made, read));
            CHECK((made.parts[0].solid_pieces == read.parts[0].solid_pieces &&
                   made.parts[0].open_edges == read.parts[0].open_edges));
        }
    }
    Scene hollow;
    add_mesh(hollow, "a", Label::Obstacle, closed.vertices, closed.triangles, Solid::No);
    CHECK((hollow.parts[0].sheet_pieces == 1 && hollow.parts[0].solid_pieces == 0));
}

TEST_CASE("shapes from code are those of a scene file")
{
    const TempFolder folder;
    const Scene read = load_scene(folder.write("scene.yaml",
                                               "format: spawnfield-scene/1\nparts:\n"
                                               "  - {name: floor, label: terrain, box: [4, 3, 1], xyz: [1, 2, 3]}\n"
                                               "  - {name: ball, sphere: 0.5, xyz: [0, 0, 4]}\n"
                                               "  - {name: pole, cylinder: {radius: 0.1, length: 2}}\n"
                                               "  - {name: pill, capsule: {radius: 0.2, length: 1}}\n"));
    Scene made;
    add_shape(made, "floor", Label::Terrain, box_shape({4, 3, 1}, {{1, 2, 3}}));
    add_shape(made, "ball", Label::Obstacle, sphere_shape(0.5, {0, 0, 4}));
    add_shape(made, "pole", Label::Obstacle, cylinder_shape(0.1, 2));
    add_shape(made, "pill", Label::Obstacle, capsule_shape(0.2, 1));
    REQUIRE(made.primitives.size() == read.primitives.size());
    for (std::size_t i = 0; i < made.primitives.size(); ++i) {
        const Primitive &a = made.primitives[i], &b = read.primitives[i];
        CHECK((a.shape.kind == b.shape.kind && a.shape.size == b.shape.size && a.part == b.part && a.label == b.label));
        CHECK(a.shape.pose.position == b.shape.pose.position);
        CHECK((made.parts[i].name == read.parts[i].name && made.parts[i].kind == read.parts[i].kind));
        CHECK(made.parts[i].solid_pieces == read.parts[i].solid_pieces);
    }
}

TEST_CASE("parts of a scene that make no sense are refused by name, value and limit")
{
    Scene scene;
    const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    CHECK_THROWS_WITH(add_mesh(scene, "a", Label::Terrain, corners, {{0, 1, 3}}),
                      "add_mesh: part \"a\": a triangle has vertex 3, needs less than 3");
    CHECK_THROWS_WITH(add_mesh(scene, "a", Label::Terrain, {{0, 0, std::nan("")}}, {}),
                      "add_mesh: part \"a\": a vertex is (0, 0, nan), needs coordinates within 1e7 m of 0");
    CHECK_THROWS_AS(add_shape(scene, "a", Label::Terrain, box_shape({1, 0, 1})), ArgumentError);
    CHECK_THROWS_AS(add_shape(scene, "a", Label::Terrain, sphere_shape(1, {2e7, 0, 0})), ArgumentError);
    CHECK_THROWS_AS(add_shape(scene, "a", Label::Terrain, {ShapeKind::Hull, Vec3::Zero(), {}}), ArgumentError);
    CHECK(scene.parts.empty());
    CHECK_THROWS_WITH(make_map(scene), Contains("make_map: the scene has no terrain"));
    add_mesh(scene, "a", Label::Terrain, corners, {{0, 1, 2}});
    CHECK_THROWS_WITH(make_map(scene, {.resolution = -1}), "make_map: resolution is -1, needs > 0 m (0: chosen)");
}

TEST_CASE("a robot from code is the one of a file")
{
    const Robot read = load_robot("box:0.9,0.6,0.3");
    const Robot made = make_robot("box", {shape_part(box_shape({0.9, 0.6, 0.3}, {{0, 0, 0.15}}))});
    std::vector<Vec3> corners;
    for (int corner = 0; corner < 8; ++corner)
        corners.emplace_back(corner & 1 ? 0.45 : -0.45, corner & 2 ? 0.3 : -0.3, corner & 4 ? 0.3 : 0.0);
    const Robot hull = make_robot("hull", {hull_part(corners, "body")});
    CHECK(hull.parts[0].name == "body");
    const TestMap map = map_of(random_scene(3));
    const RasterOptions options{.step = 0.6, .yaw = 0.3};
    const RasterResult expected = raster(Judge(map, read), options);
    CHECK(csv_of(raster(Judge(map, made), options)) == csv_of(expected));
    CHECK(csv_of(raster(Judge(map, hull), options)) == csv_of(expected));
}

TEST_CASE("parts of a robot that make no sense are refused")
{
    CHECK_THROWS_WITH(make_robot("none", {}), "make_robot: parts is empty, needs at least one");
    CHECK_THROWS_WITH(shape_part(box_shape({1, 1, -1})),
                      "shape_part: the shape is a box of 1 x 1 x -1 m, needs finite sizes > 0 m");
    CHECK_THROWS_WITH(shape_part(sphere_shape(NAN, {0, 0, 0}), "head"),
                      "shape_part: part \"head\" is a sphere of radius nan m, needs finite sizes > 0 m");
    CHECK_THROWS_WITH(shape_part(sphere_shape(1, {NAN, 0, 0}), "head"),
                      "shape_part: part \"head\" has a pose with a number that is not finite");
    CHECK_THROWS_AS(shape_part({ShapeKind::Hull, Vec3::Zero(), {}}), ArgumentError);
    CHECK_THROWS_WITH(hull_part({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
                      Contains("hull_part: the hull of the points has no volume"));
    CHECK_THROWS_AS(hull_part({{0, 0, std::nan("")}}), ArgumentError);
    CHECK_THROWS_WITH(make_robot("far", {shape_part(sphere_shape(1, {1500, 0, 0}))}),
                      "make_robot: reach from the origin is 1501, needs at most 1000 m");
}

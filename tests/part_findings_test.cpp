#include "catch.h"

#include <spawnfield/bake.h>
#include <spawnfield/error.h>
#include <spawnfield/part_findings.h>
#include <spawnfield/scene_parts.h>

#include <cmath>

using namespace spawnfield;

namespace {

/// Adds level ground at z = 0, `side` m long.
void add_floor(Scene& scene, double side = 10)
{
    add_shape(scene, "floor", Label::Terrain, box_shape({side, side, 0.2}, {{0, 0, -0.1}}));
}

void add_box(Scene& scene, const std::string& name, const Vec3& size, const Vec3& middle, double yaw = 0)
{
    add_shape(scene, name, Label::Obstacle, box_shape(size, {middle, rotation_from_rpy(0, 0, yaw)}));
}

/// Adds the box as a mesh of 12 triangles.
void add_mesh_box(Scene& scene, const std::string& name, const Vec3& size, const Vec3& middle, double yaw = 0,
                  Solid solid = Solid::Auto)
{
    std::vector<Vec3> corners;
    for (int k = 0; k < 8; ++k)
        corners.push_back(middle + rotation_from_rpy(0, 0, yaw) *
                                       (0.5 * Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).cwiseProduct(size)));
    const std::vector<Triangle> faces{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    add_mesh(scene, name, Label::Obstacle, corners, faces, solid);
}

PartFindings findings_in(const Scene& scene, const PartLimits& limits = {})
{
    return find_wrong_parts(make_map(scene), limits);
}

}  // namespace

TEST_CASE("a box above the floor floats, and hangs as high as it was placed")
{
    Scene scene;
    add_floor(scene);
    add_box(scene, "standing", {1, 1, 1}, {2, 0, 0.5});
    add_box(scene, "box", {1, 1, 1}, {0, 0, 0.85});
    const PartFindings found = findings_in(scene);
    CHECK(found.props == 2);
    CHECK(found.sunken.empty());
    CHECK(found.overlaps.empty());
    REQUIRE(found.floating.size() == 1);
    CHECK(found.floating[0].props == std::vector<std::string>{"box"});
    REQUIRE(found.floating[0].height);
    CHECK(*found.floating[0].height == Approx(0.35));
    CHECK(found.floating[0].below == "floor");
    CHECK(found.floating[0].lowest.z() == Approx(0.35));
}

TEST_CASE("a prop floats if it is farther than the gap from all that leads to the ground")
{
    const double gap = 0.02;
    for (const double height : {0.0, 0.0199, 0.02, 0.0201}) {
        Scene box, mesh;
        add_floor(box);
        add_floor(mesh);
        add_box(box, "a", {1, 1, 1}, {0, 0, 0.5 + height});
        add_mesh_box(mesh, "a", {1, 1, 1}, {0, 0, 0.5 + height});
        CHECK(findings_in(box, {.gap = gap}).floating.size() == (height > gap ? 1 : 0));
        CHECK(findings_in(mesh, {.gap = gap}).floating.size() == (height > gap ? 1 : 0));
    }
}

TEST_CASE("props that touch float together, and one that touches the ground holds the others")
{
    Scene scene;
    add_floor(scene);
    add_box(scene, "shelf", {1, 1, 0.1}, {0, 0, 2});
    add_box(scene, "vase", {0.2, 0.2, 0.5}, {0, 0, 2.3});
    add_box(scene, "lamp", {0.2, 0.2, 0.2}, {3, 0, 3});
    const PartFindings apart = findings_in(scene);
    REQUIRE(apart.floating.size() == 2);
    CHECK(apart.floating[0].props == std::vector<std::string>{"shelf", "vase"});
    CHECK(*apart.floating[0].height == Approx(1.95));
    CHECK(apart.floating[1].props == std::vector<std::string>{"lamp"});
    add_box(scene, "wall", {0.1, 3, 3}, {0.55, 0, 1.5});  // the shelf touches it with its side
    CHECK(findings_in(scene).floating.size() == 1);
    CHECK(findings_in(scene, {.allow = {"LAMP"}}).floating.empty());
}

TEST_CASE("a prop inside a solid does not float, and one without ground below hangs above nothing")
{
    Scene scene;
    add_floor(scene);
    add_mesh_box(scene, "block", {2, 2, 2}, {0, 0, 1});
    add_box(scene, "core", {0.2, 0.2, 0.2}, {0, 0, 1});
    CHECK(findings_in(scene).floating.empty());
    add_box(scene, "lost", {1, 1, 1}, {20, 0, 1});
    const PartFindings found = findings_in(scene);
    REQUIRE(found.floating.size() == 1);
    CHECK(found.floating[0].props[0] == "lost");
    CHECK(!found.floating[0].height);
}

TEST_CASE("parts with the same name before :: are one prop")
{
    Scene scene;
    add_floor(scene);
    add_box(scene, "table::leg::collision", {0.1, 0.1, 0.5}, {0, 0, 0.25});
    add_box(scene, "table::top::collision", {1, 1, 0.1}, {0, 0, 1});
    const PartFindings found = findings_in(scene);
    CHECK(found.props == 1);
    CHECK(found.floating.empty());
}

TEST_CASE("a box is sunken if more than half of it is below the ground")
{
    for (const double share : {0.2, 0.5, 0.6, 0.9}) {
        Scene solid, sheet;
        add_floor(solid);
        add_mesh(sheet, "floor", Label::Terrain, {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}},
                 {{0, 1, 2}, {0, 2, 3}});
        for (Scene* const scene : {&solid, &sheet}) {
            add_box(*scene, "box", {1, 1, 1}, {0, 0, 0.5 - share});
            const PartFindings found = findings_in(*scene);
            CHECK(found.floating.empty());
            REQUIRE(found.sunken.size() == (share > 0.5 ? 1 : 0));
            if (share <= 0.5) continue;
            CHECK(found.sunken[0].prop == "box");
            CHECK(found.sunken[0].share == Approx(share));
            CHECK(found.sunken[0].top == Approx(1 - share));
            CHECK(found.sunken[0].lines == 256);
        }
    }
}

TEST_CASE("a pillar through two floors and a box below the floor")
{
    Scene scene;
    add_floor(scene);
    add_shape(scene, "upper", Label::Terrain, box_shape({10, 10, 0.2}, {{0, 0, 2.9}}));
    add_box(scene, "pillar", {0.3, 0.3, 6}, {0, 0, 2.95});
    CHECK(findings_in(scene).sunken.empty());
    add_box(scene, "fallen", {1, 1, 1}, {3, 0, -5});
    const PartFindings found = findings_in(scene);
    REQUIRE(found.sunken.size() == 1);
    CHECK(found.sunken[0].prop == "fallen");
    CHECK(found.sunken[0].share == 1);
    CHECK(found.floating.empty());  // it is reported once
}

TEST_CASE("boxes overlap by the depth with which they were placed")
{
    for (const double depth : {-0.1, 0.0, 0.009, 0.011, 0.1, 0.3}) {
        for (const double yaw : {0.0, 0.7}) {
            Scene scene;
            add_floor(scene);
            const Vec3 along(std::cos(yaw), std::sin(yaw), 0);
            add_box(scene, "a", {1, 1, 1}, {0, 0, 0.5}, yaw);
            add_box(scene, "b", {1, 1, 1}, Vec3(0, 0, 0.5) + (1 - depth) * along, yaw);
            const PartFindings found = findings_in(scene);
            REQUIRE(found.overlaps.size() == (depth > 0.01 ? 1 : 0));
            if (depth <= 0.01) continue;
            CHECK(found.overlaps[0].a == "a");
            CHECK(found.overlaps[0].b == "b");
            CHECK(found.overlaps[0].is_exact);
            CHECK(found.overlaps[0].depth == Approx(depth).margin(1e-6));
        }
    }
}

TEST_CASE("spheres, cylinders and capsules overlap by the thickness of what they share")
{
    const Pose side{{0, 0, 1}};
    const std::vector<Shape> shapes{sphere_shape(0.5, side.position), cylinder_shape(0.5, 1, side),
                                    capsule_shape(0.5, 1, side), box_shape({1, 1, 2}, side)};
    for (const Shape& a : shapes)
        for (const Shape& b : shapes) {
            Scene scene;
            add_floor(scene);
            Shape moved = b;
            moved.pose.position.x() = 0.95;
            add_shape(scene, "a", Label::Obstacle, a);
            add_shape(scene, "b", Label::Obstacle, moved);
            const PartFindings found = findings_in(scene);
            REQUIRE(found.overlaps.size() == 1);
            CHECK(found.overlaps[0].depth == Approx(0.05).margin(1e-6));
        }
}

TEST_CASE("overlaps of meshes have at least the depth that is found, and at most the real one")
{
    for (const double depth : {-0.1, 0.0, 0.02, 0.1, 0.3}) {
        for (const bool both : {false, true}) {
            Scene scene;
            add_floor(scene);
            add_mesh_box(scene, "a", {1, 1, 1}, {0, 0, 0.5});
            if (both)
                add_mesh_box(scene, "b", {1, 1, 1}, {1 - depth, 0.2, 0.7});
            else
                add_box(scene, "b", {1, 1, 1}, {1 - depth, 0.2, 0.7});
            const PartFindings found = findings_in(scene);
            CHECK(found.undecided.empty());
            REQUIRE(found.overlaps.size() == (depth > 0.01 ? 1 : 0));
            if (depth <= 0.01) continue;
            CHECK(!found.overlaps[0].is_exact);
            CHECK(found.overlaps[0].depth <= depth + 1e-9);
            CHECK(found.overlaps[0].depth >= 0.9 * depth);
        }
    }
}

TEST_CASE("a small mesh inside a large one overlaps it, but not a sheet")
{
    for (const Solid solid : {Solid::Auto, Solid::No}) {
        Scene scene;
        add_floor(scene);
        add_mesh_box(scene, "block", {2, 2, 2}, {0, 0, 1}, 0.3, solid);
        add_mesh_box(scene, "core", {0.2, 0.2, 0.2}, {0, 0, 1}, 0.1);
        const PartFindings found = findings_in(scene);
        REQUIRE(found.overlaps.size() == (solid == Solid::Auto ? 1 : 0));
        if (solid == Solid::Auto) CHECK(found.overlaps[0].depth == Approx(0.2).epsilon(0.1));
    }
}

TEST_CASE("overlaps with terrain, of one prop and of allowed parts do not count")
{
    Scene scene;
    add_floor(scene);
    add_box(scene, "deep", {1, 1, 1}, {0, 3, 0.2});
    add_box(scene, "desk::a", {1, 1, 1}, {0, 0, 0.5});
    add_box(scene, "desk::b", {1, 1, 1}, {0.3, 0, 0.5});
    CHECK(findings_in(scene).overlaps.empty());
    add_box(scene, "chair", {1, 1, 1}, {0.6, 0, 0.5});
    CHECK(findings_in(scene).overlaps.size() == 2);
    CHECK(findings_in(scene, {.allow = {"a"}}).overlaps.size() == 1);  // a word of the name
    CHECK(findings_in(scene, {.allow = {"chair"}}).overlaps.empty());
}

TEST_CASE("limits of parts that cannot be used are named")
{
    const Map map = make_map([] {
        Scene scene;
        add_floor(scene);
        return scene;
    }());
    CHECK_THROWS_WITH(find_wrong_parts(map, {.gap = -1}), "find_wrong_parts: gap is -1, needs >= 0 m");
    CHECK_THROWS_WITH(find_wrong_parts(map, {.overlap = 0}), "find_wrong_parts: overlap is 0, needs > 0 m");
}

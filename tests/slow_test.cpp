#include "slow.h"

#include "catch.h"
#include "random_scene.h"
#include "worlds/hand_scene.h"

#include <cmath>
#include <limits>

using namespace spawnfield;
using slow::Answer;

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

Pose pose_at(double x, double y, double z, double roll = 0, double pitch = 0, double yaw = 0)
{
    return {{x, y, z}, rotation_of_rpy(roll, pitch, yaw)};
}

Shape box(const Vec3& size, const Pose& pose = {}) { return {ShapeKind::Box, size, pose}; }

Robot robot_of(const Shape& shape)
{
    Robot robot;
    robot.parts.resize(1);
    robot.parts[0].shape = shape;
    return robot;
}

Robot robot_of(const hand::Mesh& hull)
{
    Robot robot;
    robot.parts.resize(1);
    robot.parts[0].shape.kind = ShapeKind::Hull;
    robot.parts[0].hull_vertices = hull.vertices;
    for (const Triangle& t : hull.triangles) robot.parts[0].hull_faces.push_back({int(t[0]), int(t[1]), int(t[2])});
    return robot;
}

/// Returns a unit cube that stands on its origin.
Robot cube() { return robot_of(box({1, 1, 1}, pose_at(0, 0, 0.5))); }

Scene scene_of(const Shape& shape, Label label = Label::Obstacle)
{
    Scene scene;
    hand::add_shape(scene, label, shape);
    return scene;
}

Scene scene_of(const hand::Mesh& mesh, Label label = Label::Obstacle, const hand::MeshOptions& options = {})
{
    Scene scene;
    hand::add_mesh(scene, label, mesh, options);
    return scene;
}

/// Returns a plane at z = 0 of 20 x 20 m.
Scene plane(Label label = Label::Terrain) { return scene_of(hand::rectangle(20, 20), label, {.kind = "plane"}); }

slow::Decision decide(const Scene& scene, const Pose& pose, double max_water_depth = unlimited)
{
    return slow::decide(scene, {{-10, -10, -10}, {10, 10, 10}}, cube(), pose, 1.0, max_water_depth);
}

/// Checks that the two bodies are `distance` apart, by default to 0.1 mm.
void check_distance(const Scene& scene, const Robot& robot, const Pose& pose, double distance, double tolerance = 1e-4)
{
    CHECK(slow::collides(scene, robot, pose, distance + tolerance));
    CHECK_FALSE(slow::collides(scene, robot, pose, distance - tolerance));
}

}  // namespace

// ---- Collisions ----

TEST_CASE("the distance of a box above a plane is its height above the plane")
{
    check_distance(plane(), cube(), pose_at(0.3, 0.2, 0.1), 0.1);
    check_distance(plane(), cube(), pose_at(0.3, 0.2, -0.1), -0.1);
    CHECK(slow::collision(plane(), cube(), pose_at(0.3, 0.2, 0.1)) == Answer::No);
    CHECK(slow::collision(plane(), cube(), pose_at(0.3, 0.2, 0.0)) == Answer::TooClose);
    CHECK(slow::collision(plane(), cube(), pose_at(0.3, 0.2, -0.1)) == Answer::Yes);
    CHECK(slow::collision(plane(), cube(), pose_at(0.3, 0.2, -0.9)) == Answer::Yes);
    CHECK(slow::collision(plane(), cube(), pose_at(0.3, 0.2, -1.1)) == Answer::No);  // a sheet has no inside
}

TEST_CASE("a tilted box reaches down to its lowest edge")
{
    const double edge = std::sqrt(0.5);
    check_distance(plane(), robot_of(box({1, 1, 1})), pose_at(0, 0, 1, M_PI / 4), 1 - edge);
    check_distance(plane(), robot_of(box({1, 1, 1})), pose_at(0, 0, 1, M_PI / 4, 0, 1.1), 1 - edge);
}

TEST_CASE("the distance of a sphere from the corner of a box follows from Pythagoras")
{
    const Robot ball = robot_of({ShapeKind::Sphere, {0.5, 0, 0}, {}});
    const double gap = std::sqrt(3) * 0.4 - 0.5;
    check_distance(scene_of(box({2, 2, 2})), ball, pose_at(1.4, 1.4, 1.4), gap);
    check_distance(scene_of(hand::box({2, 2, 2})), ball, pose_at(1.4, 1.4, 1.4), gap);
    check_distance(scene_of(box({2, 2, 2})), ball, pose_at(0.2, 0.1, 1.7), 0.2);
    check_distance(scene_of({ShapeKind::Sphere, {1, 0, 0}, {}}), ball, pose_at(1, 2, 2), 1.5);
}

TEST_CASE("the distance of a capsule from an edge is that of its axis, minus its radius")
{
    const Robot capsule = robot_of({ShapeKind::Capsule, {0.2, 3, 0}, {}});
    const Pose lying = pose_at(1.3, 0.2, 1.4, M_PI / 2);  // along y, beside the edge that is along y
    check_distance(scene_of(box({2, 2, 2})), capsule, lying, 0.5 - 0.2);
    check_distance(scene_of(hand::box({2, 2, 2})), capsule, lying, 0.5 - 0.2);
    const Pose across = pose_at(1.5, 0, 1.5, 0, -M_PI / 4);  // rises to the left, at right angles over the edge
    check_distance(scene_of(box({2, 2, 2})), capsule, across, std::sqrt(0.5) - 0.2);
    check_distance(scene_of({ShapeKind::Capsule, {0.1, 2, 0}, pose_at(0, 0, 0, 0, M_PI / 2)}), capsule,
                   pose_at(0.4, 0, 0.9, M_PI / 2), 0.9 - 0.3);
}

TEST_CASE("a capsule through a thin sheet collides")
{
    const Robot needle = robot_of({ShapeKind::Capsule, {0.01, 2, 0}, {}});
    CHECK(slow::collision(plane(), needle, pose_at(0.3, 0.4, 0.2)) == Answer::Yes);
    CHECK(slow::collision(plane(), needle, pose_at(11, 0.4, 0.2)) == Answer::No);
}

TEST_CASE("prisms bound cylinders from inside and outside")
{
    const Robot drum = robot_of({ShapeKind::Cylinder, {0.5, 1, 0}, {}});
    for (const double yaw : {0.0, 0.01, 0.02, 0.03}) {
        const Pose pose = pose_at(1.7, 0.3, 0, 0, 0, yaw);
        const double gap = std::hypot(1.7, 0.3) - 1.5;
        const Scene drums = scene_of({ShapeKind::Cylinder, {1, 2, 0}, {}});
        CHECK(slow::collides(drums, drum, pose, gap));
        CHECK_FALSE(slow::collides(drums, drum, pose, gap - 1e-3));
        CHECK(slow::collision(drums, drum, pose_at(1.499, 0, 0, 0, 0, yaw)) == Answer::TooClose);
        CHECK(slow::collision(drums, drum, pose_at(1.49, 0, 0, 0, 0, yaw)) == Answer::Yes);
    }
    check_distance(plane(), drum, pose_at(0, 0, 1, M_PI / 2), 0.5, 5e-4);
    check_distance(plane(), drum, pose_at(0, 0, 1), 0.5);
}

TEST_CASE("a hull box collides like a box")
{
    const Robot hull = robot_of(hand::moved(hand::box({1, 1, 1}), pose_at(0, 0, 0.5)));
    Random random{11};
    const Scene target = scene_of(box({1, 2, 0.5}, pose_at(0, 0, 1, 0.3, 0.2, 0.5)));
    for (int i = 0; i < 200; ++i) {
        const double x = random.between(-2, 2), y = random.between(-2, 2), z = random.between(-0.5, 2);
        const Pose pose = pose_at(x, y, z, random.between(-3, 3));
        CHECK(slow::collision(target, hull, pose) == slow::collision(target, cube(), pose));
    }
}

TEST_CASE("the distance of two edges that cross is the distance of their lines")
{
    const Scene beam = scene_of(box({4, 1, 1}, pose_at(0, 0, 0, M_PI / 4)));       // an edge points up, along x
    const Robot across = robot_of(box({1, 4, 1}, pose_at(0, 0, 0, 0, M_PI / 4)));  // an edge points down, along y
    check_distance(beam, across, pose_at(0.3, 0.2, 2), 2 - 2 * std::sqrt(0.5));
}

TEST_CASE("a robot inside a closed house collides, and is free if a face is missing")
{
    const hand::Mesh house = hand::moved(hand::box({6, 6, 4}), pose_at(0, 0, 2));
    const Pose inside = pose_at(0.5, 0.4, 1);
    CHECK(slow::collision(scene_of(house), cube(), inside) == Answer::Yes);
    CHECK(slow::collision(scene_of(hand::flipped(house)), cube(), inside) == Answer::Yes);
    CHECK(slow::collision(scene_of(house, Label::Obstacle, {.fill = false}), cube(), inside) == Answer::No);
    for (std::size_t face = 0; face < 12; face += 2)
        CHECK(slow::collision(scene_of(hand::without(house, face, 2)), cube(), inside) == Answer::No);
    CHECK(slow::collision(scene_of(hand::without(house, 0, 2)), cube(), pose_at(2.7, 0.4, 1)) == Answer::Yes);
    CHECK(slow::collision(scene_of(house), cube(), pose_at(8, 0.4, 1)) == Answer::No);
}

TEST_CASE("a robot inside a primitive collides, and so does a robot around a thing")
{
    for (const Shape& shape : {box({5, 5, 5}), Shape{ShapeKind::Sphere, {3, 0, 0}, {}},
                               Shape{ShapeKind::Cylinder, {3, 6, 0}, {}}, Shape{ShapeKind::Capsule, {3, 2, 0}, {}}})
        CHECK(slow::collision(scene_of(shape), cube(), pose_at(0.1, 0.2, -0.3)) == Answer::Yes);
    const Vec3 small = Vec3::Constant(0.1);
    CHECK(slow::collision(scene_of(box(small)), cube(), pose_at(0, 0, -0.5)) == Answer::Yes);
    CHECK(slow::collision(scene_of(hand::box(small)), cube(), pose_at(0, 0, -0.5)) == Answer::Yes);
    CHECK(slow::collision(scene_of(hand::rectangle(0.1, 0.1)), cube(), pose_at(0, 0, -0.5)) == Answer::Yes);
}

TEST_CASE("a closed piece within another makes no cavity")
{
    Scene scene = scene_of(hand::box({6, 6, 6}));
    hand::add_piece(scene, hand::flipped(hand::box({5, 5, 5})));
    CHECK(slow::collision(scene, cube(), pose_at(0.1, 0.2, -0.3)) == Answer::Yes);
}

TEST_CASE("the inner corner of an L is free")
{
    const hand::Mesh corner = hand::extruded({{1, 1}, {1, 6}, {0, 6}, {0, 0}, {6, 0}, {6, 1}}, 0, 3);
    CHECK(slow::collision(scene_of(corner), cube(), pose_at(2, 2, 1)) == Answer::No);
    CHECK(slow::collision(scene_of(corner), cube(), pose_at(1.3, 2, 1)) == Answer::Yes);
    CHECK(slow::collision(scene_of(corner), cube(), pose_at(0.5, 2, 4)) == Answer::No);
}

TEST_CASE("water collides with nothing")
{
    CHECK(slow::collision(plane(Label::Water), cube(), pose_at(0, 0, -0.5)) == Answer::No);
    CHECK(slow::collision(scene_of(box({5, 5, 5}), Label::Water), cube(), pose_at(0, 0, 0)) == Answer::No);
}

// ---- Layers ----

TEST_CASE("a bridge has a layer on it and one below it")
{
    Scene scene = plane();
    hand::add_shape(scene, Label::Terrain, box({4, 2, 0.5}, pose_at(0, 0, 3)));
    CHECK(slow::layers(scene, 0.3, 0.2) == std::vector<double>{3.25, 0});
    CHECK(slow::layers(scene, 0.3, 1.2) == std::vector<double>{0});
    CHECK(slow::layers(scene, 11, 0).empty());
}

TEST_CASE("a ramp has a layer only where it is above the floor")
{
    Scene scene = scene_of(box({20, 20, 2}, pose_at(0, 0, -1)), Label::Terrain);
    hand::add_shape(scene, Label::Terrain, box({8, 2, 0.2}, pose_at(0, 0, 0, 0, -0.2)));  // rises along x
    const std::vector<double> high = slow::layers(scene, 0.5, 0), low = slow::layers(scene, -3, 0);
    REQUIRE(high.size() == 1);
    CHECK(high[0] == Approx(0.1 / std::cos(0.2) + 0.5 * std::tan(0.2)));
    CHECK(low == std::vector<double>{0});
    CHECK(slow::layers(scene, 3.5, 0).size() == 2);  // above the floor
}

TEST_CASE("round bodies have the heights of their equations")
{
    CHECK(slow::layers(scene_of({ShapeKind::Sphere, {3, 0, 0}, pose_at(1, 0, 1)}, Label::Terrain), 2, 2) ==
          std::vector<double>{3});
    const Scene lying = scene_of({ShapeKind::Cylinder, {1, 4, 0}, pose_at(0, 0, 0, 0, M_PI / 2)}, Label::Terrain);
    CHECK(slow::layers(lying, 1.9, 0.6)[0] == Approx(0.8));
    CHECK(slow::layers(lying, 2.1, 0.6).empty());
    const Scene capsule = scene_of({ShapeKind::Capsule, {1, 4, 0}, pose_at(0, 0, 0, 0, M_PI / 2)}, Label::Terrain);
    CHECK(slow::layers(capsule, 1.9, 0.6)[0] == Approx(0.8));
    CHECK(slow::layers(capsule, 2.6, 0)[0] == Approx(0.8));
    CHECK(slow::layers(capsule, -2.6, 0)[0] == Approx(0.8));
    CHECK(slow::layers(capsule, 2.7, 0.8).empty());
    const Scene leaning = scene_of({ShapeKind::Cylinder, {1, 10, 0}, pose_at(0, 0, 0, 0, M_PI / 4)}, Label::Terrain);
    CHECK(slow::layers(leaning, 1, 0)[0] == Approx(1 + std::sqrt(2)));
}

TEST_CASE("a mesh and the primitive of its shape have the same columns")
{
    const Pose pose = pose_at(0.3, -0.2, 1, 0.7, 0.4, 2);
    const Scene mesh = scene_of(hand::moved(hand::box({3, 2, 1}), pose), Label::Terrain);
    const Scene primitive = scene_of(box({3, 2, 1}, pose), Label::Terrain);
    Random random{3};
    for (int i = 0; i < 500; ++i) {
        const double x = random.between(-2, 2), y = random.between(-2, 2);
        const slow::Column left = slow::column(mesh, x, y), right = slow::column(primitive, x, y);
        REQUIRE(left.spans.size() == right.spans.size());
        if (left.spans.empty()) continue;
        CHECK(left.spans[0].top == Approx(right.spans[0].top).margin(1e-12));
        CHECK(left.spans[0].bottom == Approx(right.spans[0].bottom).margin(1e-12));
    }
}

TEST_CASE("a line through edges and corners of a mesh crosses it once")
{
    const auto slope = [](double x, double y) { return x + 2 * y; };
    const Scene scene = scene_of(hand::relief(4, 4, slope), Label::Terrain);
    for (double x = -1.5; x <= 1.5; x += 0.5)
        for (double y = -1.5; y <= 1.5; y += 0.5) CHECK(slow::layers(scene, x, y) == std::vector<double>{slope(x, y)});
}

TEST_CASE("the label of the top face decides whether robots may stand on a solid mesh")
{
    const hand::Mesh mesh = hand::box({2, 2, 2});
    std::vector<Label> labels(12, Label::Obstacle);
    const auto layers_with = [&](int face) {
        std::vector<Label> painted = labels;
        painted[8 + face] = painted[10 + face] = Label::Terrain;
        return slow::layers(scene_of(mesh, Label::Obstacle, {.labels = painted}), 0.3, 0.2);
    };
    CHECK(layers_with(0).empty());  // triangles 8 and 10 are the bottom
    CHECK(layers_with(1) == std::vector<double>{1});
}

TEST_CASE("two storeys of one piece that share a face have no gap between them")
{
    hand::Mesh tower = hand::box({2, 2, 2});
    const hand::Mesh upper = hand::moved(hand::box({2, 2, 2}), pose_at(0, 0, 2));
    for (std::uint32_t i = 4; i < 8; ++i) tower.vertices.push_back(upper.vertices[i]);
    for (const Triangle& t : upper.triangles) tower.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
    const Scene scene = scene_of(tower, Label::Terrain);
    REQUIRE(scene.pieces[0].solid);
    const slow::Column column = slow::column(scene, 0.3, 0.2);
    REQUIRE(column.spans.size() == 1);
    CHECK(column.spans[0].bottom == -1);
    CHECK(column.spans[0].top == 3);
    CHECK(decide(scene, pose_at(0.3, 0.2, 2)).verdict == Verdict::Aerial);
}

TEST_CASE("a sheet is a layer from both sides, unless its part has sides: up")
{
    const hand::Mesh sheet = hand::rectangle(4, 4);
    CHECK(slow::layers(scene_of(sheet, Label::Terrain, {.sides_up = true}), 0.5, 0.4).size() == 1);
    CHECK(slow::layers(scene_of(hand::flipped(sheet), Label::Terrain), 0.5, 0.4).size() == 1);
    CHECK(slow::layers(scene_of(hand::flipped(sheet), Label::Terrain, {.sides_up = true}), 0.5, 0.4).empty());
}

// ---- The verdict table ----

TEST_CASE("the first verdict that applies is given")
{
    Scene scene = plane();
    hand::add_shape(scene, Label::Obstacle, box({1, 1, 1}, pose_at(5, 0, 0.5)));
    CHECK(decide(scene, pose_at(11, 0, 0.5)).verdict == Verdict::Outside);
    CHECK(decide(scene, pose_at(0.3, 0.2, 1.1)).verdict == Verdict::Aerial);
    CHECK(decide(scene, pose_at(0.3, 0.2, -0.1)).verdict == Verdict::Aerial);
    CHECK(decide(scene, pose_at(5.3, 0.2, 1.1)).verdict == Verdict::OffTerrain);
    CHECK(decide(scene, pose_at(5.3, 0.2, 0.5)).verdict == Verdict::Collision);  // inside the box, on the floor
    CHECK(decide(scene, pose_at(4.2, 0.2, 0.1)).verdict == Verdict::Collision);
    CHECK(decide(scene, pose_at(3.9, 0.2, 0.1)).verdict == Verdict::Valid);
    CHECK(decide(scene, pose_at(5.3, 0.2, 1.1)).ground == 1.0);
    CHECK_FALSE(decide(scene, pose_at(0.3, 0.2, -0.1)).ground.has_value());
}

TEST_CASE("a pose near a limit gets no verdict")
{
    Scene scene = plane();
    hand::add_shape(scene, Label::Obstacle, box({1, 1, 1}, pose_at(5, 0, 0.5)));
    CHECK_FALSE(decide(scene, pose_at(10, 0, 0.5)).verdict.has_value());
    CHECK_FALSE(decide(scene, pose_at(0.3, 0.2, 1.0005)).verdict.has_value());
    CHECK_FALSE(decide(scene, pose_at(0.3, 0.2, 0.0005)).verdict.has_value());
    CHECK_FALSE(decide(scene, pose_at(4.0005, 0.2, 0.1)).verdict.has_value());  // touches the box
    CHECK_FALSE(decide(scene, pose_at(5.4995, 0.2, 1.1)).verdict.has_value());  // above the edge of the box
    hand::add_shape(scene, Label::Terrain, box({1, 1, 0.01}, pose_at(-5, 0, 0)));
    CHECK_FALSE(decide(scene, pose_at(-4.5005, 0.2, 0.1))
                    .verdict.has_value());  // above a step of 5 mm, so the ground is not certain
    CHECK(decide(scene, pose_at(-4.502, 0.2, 0.1)).ground == 0.005);
}

TEST_CASE("a pose inside a hill has no ground, and one inside a box on the floor has the floor as ground")
{
    const Scene hill = scene_of({ShapeKind::Sphere, {3, 0, 0}, {}}, Label::Terrain);
    CHECK(decide(hill, pose_at(0.5, 0.2, 1)).verdict == Verdict::Aerial);
    CHECK(decide(hill, pose_at(0.5, 0.2, 3.2)).verdict == Verdict::Valid);
    Scene nested = scene_of(box({4, 4, 4}, pose_at(0, 0, 2)), Label::Terrain);
    hand::add_shape(nested, Label::Terrain, box({1, 1, 1}, pose_at(0, 0, 2)));
    CHECK(decide(nested, pose_at(0.2, 0.1, 3)).verdict == Verdict::Collision);  // the ground belongs to a single piece
    CHECK(decide(nested, pose_at(0.2, 0.1, 3)).ground == 2.5);
}

TEST_CASE("if terrain and obstacle are equally high, the ground is terrain")
{
    Scene scene = plane(Label::Obstacle);
    hand::add_mesh(scene, Label::Terrain, hand::rectangle(4, 4), {.kind = "plane"});
    CHECK(decide(scene, pose_at(0.3, 0.2, 0.1)).verdict == Verdict::Valid);
    CHECK(decide(scene, pose_at(5.3, 0.2, 0.1)).verdict == Verdict::OffTerrain);
}

TEST_CASE("the lower side of a sheet with sides: up is not terrain")
{
    const hand::Mesh below = hand::flipped(hand::rectangle(20, 20));
    CHECK(decide(scene_of(below, Label::Terrain, {.sides_up = true}), pose_at(0, 0.2, 0.1)).verdict ==
          Verdict::OffTerrain);
    CHECK(decide(scene_of(below, Label::Terrain), pose_at(0, 0.2, 0.1)).verdict == Verdict::Valid);
}

TEST_CASE("ground under water is submerged up to the maximum water depth")
{
    Scene scene = plane();
    hand::add_mesh(scene, Label::Water, hand::moved(hand::rectangle(4, 4), pose_at(0, 0, 2)), {.kind = "plane"});
    hand::add_shape(scene, Label::Water, box({2, 2, 1}, pose_at(6, 0, -0.5)));
    CHECK(decide(scene, pose_at(0.3, 0.2, 0.1)).verdict == Verdict::Submerged);
    CHECK(decide(scene, pose_at(0.3, 0.2, 0.1), 2.1).verdict == Verdict::Submerged);
    CHECK_FALSE(decide(scene, pose_at(0.3, 0.2, 0.1), 2.0).verdict.has_value());
    CHECK(decide(scene, pose_at(0.3, 0.2, 0.1), 1.9).verdict == Verdict::Valid);
    CHECK(decide(scene, pose_at(4, 0.2, 0.1)).verdict == Verdict::Valid);
    CHECK_FALSE(
        decide(scene, pose_at(6, 0.2, 0.1)).verdict.has_value());  // the surface of the water is level with the ground
}

// ---- Random scenes ----

TEST_CASE("random scenes are the same for the same seed, and contain what their description lists")
{
    const Scene scene = random_scene(5), again = random_scene(5);
    CHECK(scene.vertices == again.vertices);
    CHECK(scene.triangles == again.triangles);
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const Scene one = random_scene(seed);
        REQUIRE(one.triangle_labels.size() == one.triangles.size());
        REQUIRE(one.triangle_pieces.size() == one.triangles.size());
        std::size_t next = 0;
        for (std::size_t i = 0; i < one.pieces.size(); ++i) {
            CHECK(one.pieces[i].first_triangle == next);
            for (std::uint32_t k = 0; k < one.pieces[i].triangle_count; ++k) CHECK(one.triangle_pieces[next++] == i);
        }
        CHECK(next == one.triangles.size());
        std::size_t pieces = 0;
        for (const Part& part : one.parts) pieces += part.solid_pieces + part.sheet_pieces;
        CHECK(pieces == one.pieces.size() + one.primitives.size());
    }
}

TEST_CASE("a grown robot collides everywhere the shrunk one does")
{
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const Scene scene = random_scene(seed);
        const Robot robot = random_robot(seed + 100);
        for (const Pose& pose : random_poses(scene, seed, 15))
            if (slow::collides(scene, robot, pose, -1e-3)) CHECK(slow::collides(scene, robot, pose, 1e-3));
    }
}

TEST_CASE("random poses give every verdict except footings, and few are too close to a limit")
{
    VerdictCounts counts;
    int unclear = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const Scene scene = random_scene(seed);
        const Robot robot = random_robot(seed);
        for (const Pose& pose : random_poses(scene, seed, 30)) {
            const auto decision = slow::decide(scene, rough_bounds(scene), robot, pose, 1.0, unlimited);
            if (decision.verdict)
                ++counts[*decision.verdict];
            else
                ++unclear;
        }
    }
    for (const Verdict verdict : all_verdicts) {
        // The queries of this test have no limit of slopes and no settled robots.
        const bool occurs = verdict != Verdict::Steep && verdict != Verdict::Unstable &&
                            verdict != Verdict::Obstructed && verdict != Verdict::Unreachable;
        INFO(to_string(verdict));
        CHECK((occurs ? counts[verdict] > 5 : counts[verdict] == 0));
    }
    CHECK(unclear < 60);
}

TEST_CASE("footings are valid on a plane, steep on a slope, unstable over an edge, and undecided at a limit")
{
    const std::vector<Vec3> contacts = {{0.5, 0.5, 0}, {-0.5, 0.5, 0}, {-0.5, -0.5, 0}, {0.5, -0.5, 0}};
    const auto footing = [&](const Scene& scene, const Pose& pose, double max_slope) {
        return slow::footing(scene, cube(), contacts, pose, 0, max_slope);
    };
    CHECK(footing(plane(), pose_at(0, 0, 0.1), 0.2) == Verdict::Valid);
    CHECK(footing(plane(), pose_at(9.6, 0, 0.1), 0.2) == Verdict::Unstable);
    CHECK(footing(plane(), pose_at(9.5, 0, 0.1), 0.2) == std::nullopt);
    const Scene slope = scene_of(hand::moved(hand::rectangle(20, 20), pose_at(0, 0, 0, 0, 0.3, 0)), Label::Terrain,
                                 {.kind = "plane"});
    CHECK(footing(slope, pose_at(0, 0, 0.7, 0, 0, 1), 0.31) == Verdict::Valid);
    CHECK(footing(slope, pose_at(0, 0, 0.7, 0, 0, 1), 0.3) == std::nullopt);
    CHECK(footing(slope, pose_at(0, 0, 0.7, 0, 0, 1), 0.1) == Verdict::Steep);
}

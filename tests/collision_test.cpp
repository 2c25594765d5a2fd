#include "catch.h"
#include "collision/pose_checker.h"
#include "geometry/geometry_impl.h"
#include "random_scene.h"
#include "test_map.h"
#include "worlds/hand_scene.h"
#include "worlds/world.h"

#include <array>
#include <numbers>

using namespace spawnfield;

namespace {

constexpr double pi = std::numbers::pi;

bool is_free(const Scene& scene, const std::string& robot, const Vec3& position, double yaw = 0)
{
    const Geometry geometry(scene);
    return CollisionChecker(geometry, load_robot(robot)).is_free({position, rotation_from_rpy(0, 0, yaw)});
}

Robot round_robot(ShapeKind kind, const Vec3& size, const Vec3& centre)
{
    RobotPart part;
    part.shape.kind = kind;
    part.shape.size = size;
    part.shape.pose.position = centre;
    return {"round", {part}, {}, {}};
}

Robot hull_robot()  // a square pyramid with its tip down
{
    RobotPart part;
    part.shape.kind = ShapeKind::Hull;
    part.hull_vertices = {{0, 0, 0}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}, {1, -1, 1}};
    part.hull_faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 4, 3}, {1, 3, 2}};
    return {"hull", {part}, {}, {}};
}

}  // namespace

TEST_CASE("a touching pair collides, and a gap of 1e-5 m is free, for all robots on sheets and boxes of all sizes")
{
    const std::vector<Robot> robots = {load_robot("box:0.99,0.67,0.39"),
                                       round_robot(ShapeKind::Sphere, {0.3, 0, 0}, {0, 0, 0.3}),
                                       round_robot(ShapeKind::Cylinder, {0.3, 0.4, 0}, {0, 0, 0.2}),
                                       round_robot(ShapeKind::Capsule, {0.2, 0.4, 0}, {0, 0, 0.4}), hull_robot()};
    for (const double size : {0.5, 20.0, 500.0})
        for (const bool sheet : {false, true})
            for (const double far : {0.0, 5000.0}) {
                Scene scene;
                const Pose at{{far, -far, 0.25}, Mat3::Identity()};
                if (sheet)
                    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(size, size), at));
                else
                    hand::add_mesh(
                        scene, Label::Terrain,
                        hand::moved(hand::box({size, size, 1}), {at.position - Vec3(0, 0, 0.5), at.rotation}));
                const Geometry geometry(scene);
                for (std::size_t r = 0; r < robots.size(); ++r) {
                    const CollisionChecker checker(geometry, robots[r]);
                    for (const double yaw : {0.0, 0.3, 0.7853981633974483, 1.5707963267948966}) {
                        CAPTURE(size, sheet, far, r, yaw);
                        const auto free_at = [&](double gap) {
                            return checker.is_free({at.position + Vec3(0.01, 0.02, gap), rotation_from_rpy(0, 0, yaw)});
                        };
                        CHECK_FALSE(free_at(0));
                        CHECK_FALSE(free_at(-1e-5));
                        CHECK(free_at(1e-5));
                    }
                }
            }
}

TEST_CASE("a triangle without width acts as a line, in whichever direction rounding turns its normal")
{
    const Vec3 a(-0.62318147753626363, 0.06041809955604549, 0.16091240120913852),
        b(0.15029675587186375, 0.17413353081724381, -0.21990618847556576);
    const std::vector<Robot> robots = {
        round_robot(ShapeKind::Sphere, {0.065, 0, 0}, {0, 0, 0}), round_robot(ShapeKind::Sphere, {1, 0, 0}, {0, 0, 0}),
        round_robot(ShapeKind::Capsule, {0.065, 0.01, 0}, {0, 0, 0}), load_robot("box:0.1,0.1,0.1@0,0,0")};
    for (const double width : {0.0, 1e-17, 1e-15, 1e-12})
        for (const Vec3& along : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.3, -0.2, 1)}) {
            Scene scene;
            hand::add_mesh(scene, Label::Obstacle, {{a, b, b + width * along}, {{0, 1, 2}}});
            hand::add_mesh(scene, Label::Obstacle, {{a, a + width * along, b}, {{0, 1, 2}}});
            const Geometry geometry(scene);
            for (std::size_t r = 0; r < robots.size(); ++r) {
                const CollisionChecker checker(geometry, robots[r]);
                const double reach = r == 1 ? 1.0 : 0.065;  // distance from the line at which the round robots touch
                const Vec3 up = Vec3::UnitZ() - (b - a).normalized().z() * (b - a).normalized();
                for (const double share : {0.1, 0.5, 0.7}) {
                    const Vec3 foot = a + share * (b - a);
                    CAPTURE(width, along.transpose(), r, share);
                    CHECK(checker.is_free({foot + (reach + 0.03) * up.normalized(), Mat3::Identity()}));
                    CHECK_FALSE(checker.is_free({foot, Mat3::Identity()}));
                    if (r > 1) continue;
                    CHECK(checker.is_free({foot + (reach + 1e-5) * up.normalized(), Mat3::Identity()}));
                    CHECK_FALSE(checker.is_free({foot + (reach - 1e-5) * up.normalized(), Mat3::Identity()}));
                }
            }
        }
}

TEST_CASE("a closed house is solid, the same house with a missing face is a shell")
{
    Scene closed, open;
    hand::add_mesh(closed, Label::Obstacle, hand::box({6, 6, 4}));
    hand::add_mesh(open, Label::Obstacle, hand::without(hand::box({6, 6, 4}), 0, 1));
    const std::string robot = "box:0.5,0.5,0.5@0,0,0";
    CHECK(is_free(closed, robot, {3.3, 0, 0}));
    CHECK_FALSE(is_free(closed, robot, {0, 0, 0}));
    CHECK_FALSE(is_free(closed, robot, {1, -1, 1}));
    CHECK(is_free(open, robot, {0, 0, 0}));
    CHECK_FALSE(is_free(open, robot, {0, 0, 1.8}));  // through its roof
}

TEST_CASE("a robot around a small solid collides with it")
{
    Scene scene;
    hand::add_mesh(scene, Label::Obstacle, hand::box({0.1, 0.1, 0.1}));
    CHECK_FALSE(is_free(scene, "box:2,2,2@0,0,0", {0.2, 0.1, 0}));
    CHECK(is_free(scene, "box:2,2,2@0,0,0", {1.06, 0, 0}));
}

TEST_CASE("a checker is the same while FCL is loaded on another of 1, 2 or 8 threads")
{
    Scene scene;
    hand::add_mesh(scene, Label::Obstacle, hand::box({0.1, 0.1, 0.1}));
    for (const int threads : {1, 2, 8}) {
        const CollisionPreload preload(threads);
        CHECK_FALSE(is_free(scene, "box:2,2,2@0,0,0", {1.04, 0, 0}));
        CHECK(is_free(scene, "box:2,2,2@0,0,0", {1.06, 0, 0}));
    }
}

TEST_CASE("each convex part of a robot counts, and the space between them is free")
{
    Scene scene;
    hand::add_mesh(scene, Label::Obstacle, hand::box({0.2, 0.2, 0.2}));
    Robot table = load_robot("box:0.1,0.1,1@1,0,0");
    table.parts.push_back(load_robot("box:0.1,0.1,1@-1,0,0").parts[0]);
    const Geometry geometry(scene);
    const CollisionChecker checker(geometry, table);
    CHECK(checker.is_free({{0, 0, 0}, Mat3::Identity()}));
    CHECK_FALSE(checker.is_free({{1, 0, 0}, Mat3::Identity()}));
    CHECK_FALSE(checker.is_free({{-1, 0, 0}, Mat3::Identity()}));
    CHECK_FALSE(checker.is_free({{0, 1, 0}, rotation_from_rpy(0, 0, std::numbers::pi / 2)}));
}

TEST_CASE("the hit is the first part in the order of the scene, either triangles or a primitive")
{
    Scene scene;
    hand::add_mesh(scene, Label::Water, hand::box({9, 9, 9}));  // collides with nothing
    Shape ball;
    ball.kind = ShapeKind::Sphere;
    ball.size[0] = 1;
    hand::add_shape(scene, Label::Obstacle, ball);
    hand::add_mesh(scene, Label::Terrain, hand::box({8, 8, 0.2}));
    const Geometry geometry(scene);
    const CollisionChecker checker(geometry, load_robot("box:0.5,0.5,0.5@0,0,0"));
    REQUIRE(checker.find_hit({{0, 0, 0}, Mat3::Identity()}));
    CHECK(checker.find_hit({{0, 0, 0}, Mat3::Identity()})->part == 1);
    CHECK(checker.find_hit({{3, 3, 0}, Mat3::Identity()})->part == 2);
    CHECK_FALSE(checker.find_hit({{3, 3, 2}, Mat3::Identity()}));
}

TEST_CASE("with the occupancy tree a pose is free if it meets no occupied voxel")
{
    const TestMap map = training_map();
    const auto tree = std::make_shared<const OccupancyTree>(build_occupancy(map.geometry, map.bounds, 0.1));
    const CollisionChecker voxels(tree, husky());
    const CollisionChecker exact = checker_of(map, husky());
    std::size_t both_free = 0, only_exact = 0;
    for (const Pose& pose : random_poses(map.scene, 5, 3000)) {
        if (!map.bounds.contains_xy(pose.position.x(), pose.position.y(), -1)) continue;
        const bool voxel_free = voxels.is_free(pose), exact_free = exact.is_free(pose);
        CHECK((exact_free || !voxel_free));  // voxels cover everything that is solid
        both_free += voxel_free;
        only_exact += exact_free && !voxel_free;
    }
    CHECK(both_free > 500);
    CHECK(only_exact < both_free / 3);
}

TEST_CASE("a search in a box finds what the rectangle below it has at these heights, in tall tiles, too")
{
    const Geometry geometry(worlds::benchmark_balls(60).scene);
    std::size_t found = 0;
    Random random(7);
    for (int i = 0; i < 200; ++i) {
        const Vec3 low{random.between(-1, 9), random.between(-1, 9), random.between(-2, 60)};
        const Bounds space{low, low + Vec3{random.between(0, 2), random.between(0, 2), random.between(0, 3)}};
        std::vector<std::uint32_t> expected, visited;
        geometry.impl().visit_in({space.min.x(), space.min.y(), space.max.x(), space.max.y()},
                                 [&](const Tile& tile, std::uint32_t element) {
                                     const ElementBox box = tile.box(element);
                                     if (box.min[2] <= space.max.z() && box.max[2] >= space.min.z())
                                         expected.push_back(tile.ids[element]);
                                 });
        geometry.impl().visit_tiles(space, [&](const Tile& tile, const ElementBox&) {
            for_each_bit(tile.near(space), [&](std::uint32_t element) {
                if (overlap(tile.box(element), space)) visited.push_back(tile.ids[element]);
            });
        });
        CHECK(visited == expected);
        found += visited.size();
    }
    CHECK(found > 10000);
}

TEST_CASE("each tile that meets a box is visited once, in a rectangle that was expected and beyond it")
{
    const Geometry geometry(worlds::benchmark_balls(60).scene);
    NearTiles tiles(geometry.impl());
    std::size_t found = 0, within = 0;
    Random random(8);
    Rect area{};
    for (int i = 0; i < 500; ++i) {
        if (i % 50 == 0) {
            area.low_x = random.between(-2, 8);
            area.low_y = random.between(-2, 8);
            area.high_x = area.low_x + random.between(0.1, 6);
            area.high_y = area.low_y + random.between(0.1, 6);
            tiles.expect(area);
        }
        const Vec3 low = i % 2 == 0 ? Vec3(random.between(-1, 9), random.between(-1, 9), random.between(-2, 60))
                                    : Vec3(random.between(area.low_x, area.high_x),
                                           random.between(area.low_y, area.high_y), random.between(-2, 60));
        const Bounds space{low, low + Vec3{random.between(0, 2), random.between(0, 2), random.between(0, 3)}};
        std::vector<const TileHead*> expected, visited;
        geometry.impl().visit_tiles(space, [&](const Tile& tile, const ElementBox& box) {
            if (overlap(box, space)) expected.push_back(tile.head);
        });
        tiles.visit(space, [&](const Tile& tile) {
            visited.push_back(tile.head);
            return true;
        });
        std::sort(expected.begin(), expected.end());
        std::sort(visited.begin(), visited.end());
        CHECK(visited == expected);
        found += visited.size();
        within += space.min.x() >= area.low_x && space.max.x() <= area.high_x && space.min.y() >= area.low_y &&
                  space.max.y() <= area.high_y;
        std::size_t calls = 0;
        tiles.visit(space, [&](const Tile&) { return ++calls < 2; });
        CHECK(calls == std::min<std::size_t>(2, expected.size()));
    }
    CHECK(found > 3000);
    CHECK(within > 50);
}

TEST_CASE("a checker that keeps the tiles around its last pose, and knows the column, gives the same answers")
{
    std::array<std::size_t, 2> free{}, neighbours{};
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const Geometry geometry(random_scene(seed));
        const Robot robot = seed % 3 == 0 ? hull_robot() : random_robot(seed);
        const CollisionChecker checker(geometry, robot);
        PoseChecker kept(checker), with_column(checker), expecting(checker), sharing(checker);
        sharing.share_tiles(expecting);
        const Bounds all = geometry.bounds();
        const Vec3 size = robot.bounds().max - robot.bounds().min;
        Random random(seed);
        const auto anywhere = [&] {
            return Vec3(random.between(all.min.x(), all.max.x()), random.between(all.min.y(), all.max.y()),
                        random.between(all.min.z() - 0.3, all.max.z() + 0.3));
        };
        Vec3 at = anywhere();
        expecting.expect({at.x() - 1, at.y() - 2, at.x() + 2, at.y() + 1});  // other poses follow, too
        for (int step = 0; step < 300; ++step) {  // mostly short steps, and now and then a jump
            const bool is_near = random.between(0, 1) < 0.9;
            at = is_near ? Vec3(at + size.cwiseProduct(
                                         Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-0.3, 0.3))))
                         : anywhere();
            const Pose pose{at, rotation_from_rpy(0, step % 5 == 0 ? 0.2 : 0, random.between(-pi, pi))};
            const std::optional<CollisionHit> expected = checker.find_hit(pose);
            const Column column = column_at(geometry, at.x(), at.y());
            const ColumnView view(column);
            CAPTURE(seed, step, at.transpose());
            REQUIRE(kept.is_free(pose) == !expected);
            REQUIRE(with_column.is_free(pose, &view) == !expected);
            REQUIRE(expecting.is_free(pose) == !expected);
            for (const auto& hit : {kept.find_hit(pose), with_column.find_hit(pose, &view), expecting.find_hit(pose),
                                    sharing.find_hit(pose)}) {
                REQUIRE(hit.has_value() == expected.has_value());
                if (hit) REQUIRE(hit->part == expected->part);
            }
            ++free[expected ? 1 : 0];
            ++neighbours[is_near ? 1 : 0];
        }
    }
    for (const std::size_t count : free) CHECK(count > 1000);
    for (const std::size_t count : neighbours) CHECK(count > 500);
}

#include "catch.h"
#include "slow.h"
#include "temp_folder.h"
#include "test_map.h"
#include "worlds/hand_scene.h"

#include <spawnfield/error.h>

using namespace spawnfield;
using State = OccupancyTree::State;

TEST_CASE("a voxel is occupied if a surface touches it or its centre is inside, else free, and unknown off the bounds")
{
    Scene scene;
    hand::add_mesh(scene, Label::Obstacle,
                   hand::moved(hand::box({2, 2, 2}), {{0.05, 0, 0}, Mat3::Identity()}));  // x from -0.95 to 1.05
    TestMap map = map_of(scene);
    map.bounds = {Vec3(-3, -3, -3), Vec3(3, 3, 3)};
    const OccupancyTree tree = build_occupancy(map.geometry, map.bounds, 0.25);
    CHECK(tree.resolution() == 0.25);
    CHECK(tree.at({0, 0, 0}) == State::Occupied);    // deep inside
    CHECK(tree.at({1.1, 0, 0}) == State::Occupied);  // the surface at 1.05 lies in 1.00 .. 1.25
    CHECK(tree.at({1.3, 0, 0}) == State::Free);
    CHECK(tree.at({0, 1.1, 0}) == State::Occupied);  // the surface touches its lower side
    CHECK(tree.at({0, 1.3, 0}) == State::Free);
    CHECK(tree.at({-1.01, 0, 0}) == State::Free);  // the voxel ends 0.05 before the surface
    CHECK(tree.at({2.9, 2.9, 2.9}) == State::Free);
    CHECK(tree.at({3.1, 0, 0}) == State::Unknown);
    CHECK(tree.at({0, 0, -3.1}) == State::Unknown);
}

TEST_CASE("water is free space")
{
    Scene scene;
    hand::add_mesh(scene, Label::Water, hand::rectangle(2, 2));
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(2, 2), {{0, 0, -1}, Mat3::Identity()}));
    const TestMap map = map_of(scene);
    const OccupancyTree tree = build_occupancy(map.geometry, map.bounds, 0.25);
    CHECK(tree.at({0.1, 0.1, -0.1}) == State::Free);
    CHECK(tree.at({0.1, 0.1, -0.9}) == State::Occupied);
}

TEST_CASE("voxels of random scenes are occupied if a box of their size meets something")
{
    std::size_t occupied = 0, free = 0;
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        Random random(seed);
        const double side = random.between(0.1, 0.5);
        const OccupancyTree tree = build_occupancy(map.geometry, map.bounds, side);
        RobotPart voxel;
        voxel.shape.size = Vec3::Constant(side);
        const Robot robot{"voxel", {voxel}, {}, {}};
        for (int i = 0; i < 300; ++i) {
            Vec3 p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = (std::floor(random.between(map.bounds.min[axis], map.bounds.max[axis]) / side) + 0.5) * side;
            const State state = tree.at(p);
            const slow::Answer answer = slow::collision(map.scene, robot, {p, Mat3::Identity()}, 1e-3);
            CAPTURE(seed, side, p.transpose());
            if (answer == slow::Answer::Yes) CHECK(state == State::Occupied);
            if (answer == slow::Answer::No) CHECK(state == State::Free);
            (answer == slow::Answer::Yes ? occupied : free) += 1;
        }
    }
    CHECK(occupied > 500);
    CHECK(free > 500);
}

TEST_CASE("an occupancy tree has the same leaves with any number of threads and is pruned")
{
    const TestMap map = map_of(random_scene(3));
    const OccupancyTree one = build_occupancy(map.geometry, map.bounds, 0.1, 1);
    const OccupancyTree two = build_occupancy(map.geometry, map.bounds, 0.1, 2);
    CHECK(one.leaves() == two.leaves());
    Scene empty;
    hand::add_mesh(empty, Label::Terrain, hand::moved(hand::rectangle(0.1, 0.1), {{0.3, 0.3, 0.3}, Mat3::Identity()}));
    const Map large = map_of(empty);
    const OccupancyTree tree = build_occupancy(large.geometry, {Vec3(0, 0, 0), Vec3(64, 64, 64)}, 1);
    CHECK(tree.leaves() < 64);  // 262,144 voxels, all but one free
}

TEST_CASE("the file that is written without a tree is equal to that of the tree, with any number of threads")
{
    const TempFolder temp;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const TestMap map = map_of(random_scene(seed));
        Bounds bounds = map.bounds;
        if (seed % 3 == 0)
            bounds = {bounds.min - Vec3(1, 20, 3), bounds.max + Vec3(15, 1, 7)};  // beyond the edges of blocks
        const double voxel = 0.05 + 0.03 * double(seed % 4);
        const OccupancyTree tree = build_occupancy(map.geometry, bounds, voxel);
        tree.write(temp / "tree.bt");
        for (const int threads : {1, 8}) {
            CHECK(write_occupancy(temp / "direct.bt", map.geometry, bounds, voxel, threads) == tree.leaves());
            CHECK((bytes_of(temp / "direct.bt") == bytes_of(temp / "tree.bt")));
        }
        const OccupancyTree read = read_occupancy(temp / "direct.bt");
        CHECK(read.leaves() == tree.leaves());
    }
}

TEST_CASE("bounds beyond the keys of OctoMap are refused, with the resolution that would work")
{
    Scene scene;
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(2, 2), {{5000, 0, 0}, Mat3::Identity()}));
    const TestMap far = map_of(scene);
    CHECK(build_occupancy(far.geometry, far.bounds, 0.1).at({5000.05, 0.05, 0.05}) == OccupancyTree::State::Occupied);
    hand::add_mesh(scene, Label::Terrain, hand::moved(hand::rectangle(2, 2), {{-2000, 0, 0}, Mat3::Identity()}));
    const TestMap map = map_of(scene);
    CHECK_THROWS_WITH(build_occupancy(map.geometry, map.bounds, 0.1),
                      Contains("resolution is 0.1, needs at least 0.107"));
    CHECK_THROWS_WITH(build_occupancy(map.geometry, map.bounds, 0), "build_occupancy: resolution is 0, needs > 0 m");
}

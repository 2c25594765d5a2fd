#include "catch.h"
#include "shared_scenes.h"
#include "slow.h"
#include "temp_folder.h"
#include "test_map.h"

using namespace spawnfield;

namespace {

/// Facts about a scene from its SOURCE.md; extents are in the frame of the scene.
struct RealScene {
    std::string file;
    Vec3 min, max;
    double margin;  ///< m, the rounding of SOURCE.md
    std::size_t triangles;
};

const std::vector<RealScene>& real_scenes()
{
    static const std::vector<RealScene> scenes = {
        {"inspection/scene.yaml", {-66.6, -136.0, -2.72}, {62.3, 63.3, 7.73}, 0.06, 5767 + 2 + 7464},
        {"kaykit_town/scene.yaml", {-43.2, -43.6, 0}, {43.2, 43.2, 14.64}, 0.06, 54985 - 0},
        {"interchange/scene.yaml", {-177.8, -178.0, -0.44}, {177.8, 178.0, 6.30}, 0.06, 1564 - 132},
        {"parking_garage/scene.yaml", {-60, -50, -0.2}, {60, 50, 45.9}, 0.06, 6413},
        {"mine/scene.yaml", {-22, 92.5 - 327.2, 0}, {230.3, 92.5, 2.75}, 0.06, 13834},
        {"octomap/scene.yaml", {-7.96, -7.48, -0.28}, {30.92, 7.40, 2.76}, 0.06, 0},
        {"lunar_pit/scene.yaml", {-257, -257, -110}, {257, 257, 9}, 0.5, 2 * 256 * 256},
        {"dem/river/scene.yaml", {-24.5, -18, 537.36}, {24.5, 18, 543.81}, 0.01, 2 * 49 * 36 + 2},
        {"dem/river/DEM-kootenai_37x50_1x1.asc", {-24.5, -18, 537.36}, {24.5, 18, 543.81}, 0.01, 2 * 49 * 36},
        {"dem/gully/west_bijou_gully.asc", {-54, -114, 1680.8}, {51, 126, 1725.4}, 0.06, 1972},
        {"dem/moon_tif/dem_moon.tif", {-38.83, -38.83, -212.30}, {38.83, 38.83, -205.44}, 0.01, 2 * 32 * 32},
        {"nav_test/scene.yaml", {-28.9, -31.1, -4.87}, {62.5, 46.3, 17.01}, 0.06, 1612},
        {"dungeon/scene.yaml", {-25.0, -8.9, 0}, {49.3, 90.0, 40.2}, 0.06, 10133},
        {"far_terrain/scene.yaml", {4999.1, -5098.8, -4.05}, {5098.0, -4999.6, 6.81}, 0.06, 5202},
        {"nasty/scene.yaml", {-30, -20, -1.02}, {30, 20, 11.47}, 0.06, 2899 + 1632 + 3932 + 256},
    };
    return scenes;
}

struct RealRobot {
    std::string file;
    double offset;  ///< m, leaves some space under the lowest point
};

const std::vector<RealRobot>& real_robots()
{
    static const std::vector<RealRobot> robots = {
        {"robot_husky/husky_description/urdf/husky.urdf", 0.25},
        {"robot_jackal/jackal_description/urdf/jackal.urdf", 0.15},
        {"robot_turtlebot3/turtlebot3_description/urdf/turtlebot3_waffle.urdf", 0.05},
    };
    return robots;
}

bool is_near(const Vec3& a, const Vec3& b, double margin) { return ((a - b).cwiseAbs().array() <= margin).all(); }

}  // namespace

TEST_CASE("every real scene has the extent and the triangles that its source documents")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    for (const RealScene& real : real_scenes()) {
        const Scene scene = load_scene(*folder / real.file);
        const Bounds bounds = scene.bounds();
        CAPTURE(real.file, bounds.min.transpose(), bounds.max.transpose());
        CHECK(is_near(bounds.min, real.min, real.margin));
        CHECK(is_near(bounds.max, real.max, real.margin));
        // Degenerate triangles (two equal corners) and ignored ones are left out.
        CHECK(scene.triangles.size() <= real.triangles);
        CHECK(scene.triangles.size() + 700 >= real.triangles);
    }
}

TEST_CASE("real scenes bake, and real robots' samples in them are valid by check")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    const TempFolder temp;
    for (const RealScene& real : real_scenes()) {
        CAPTURE(real.file);
        BakeOptions options{.resolution = 0.5, .occupancy_resolution = 1};
        bake(load_scene(*folder / real.file), *folder / real.file, temp / "map", options);
        verify_map(temp / "map");
        const Map map = read_map(temp / "map");
        for (const RealRobot& robot : real_robots()) {
            CAPTURE(robot.file);
            const Judge judge(map, load_robot((*folder / robot.file).string()));
            SampleOptions sampling{
                .count = 60, .min_distance = 0.3, .random_yaw = true, .stance = Stance::Level, .offset = robot.offset};
            const SpawnList list = sample(judge, sampling);
            CHECK(list.spawns.size() == 60);
            std::vector<Pose> poses;
            for (const Spawn& spawn : list.spawns)
                poses.push_back({spawn.position, rotation_from_rpy(0, 0, spawn.yaw)});
            for (const Judgement& judged : judge.check(poses)) CHECK(judged.verdict == Verdict::Valid);
        }
    }
}

TEST_CASE("settled spawns of a robot with its origin between its wheels are valid as written, also over crests")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    const TestMap map = map_of(load_scene(*folder / "dungeon/scene.yaml"));
    const Judge judge(map, load_robot(source_folder() + "/maps/robots/husky_wheels.yaml"));
    const SpawnList list = sample(judge, {.count = 1000, .random_yaw = true});
    CHECK(list.spawns.size() == 1000);
    std::vector<Pose> poses;
    for (const Spawn& spawn : list.spawns)
        poses.push_back({spawn.position, rotation_from_rpy(spawn.roll, spawn.pitch, spawn.yaw)});
    const std::vector<Judgement> judged = judge.check(poses);
    std::size_t over_crests = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        CHECK(judged[i].verdict == Verdict::Valid);
        over_crests += judged[i].ground && judged[i].ground->height > poses[i].position.z();
    }
    CHECK(over_crests >= 5);
}

TEST_CASE("check in real scenes agrees with the independent decision", "[slow]")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    std::size_t decided = 0, valid = 0, collision = 0;
    for (const RealScene& real : real_scenes()) {
        const TestMap map = map_of(load_scene(*folder / real.file));
        if (map.scene.triangles.size() > 50000)
            continue;  // the independent decision visits each triangle for each pose
        const Robot robot = load_robot((*folder / real_robots()[1].file).string());
        const Judge judge(map, robot);
        // Random poses and poses of a sample, because half of the random ones miss the ground.
        std::vector<Pose> poses = random_poses(map.scene, 17, 20);
        SampleOptions sampling{.count = 15, .stance = Stance::Level, .offset = 0.15};
        for (const Spawn& spawn : sample(judge, sampling).spawns)
            poses.push_back({spawn.position, rotation_from_rpy(0, 0, spawn.yaw)});
        const std::vector<Judgement> fast = judge.check(poses);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            const slow::Decision slow = slow::decide(map.scene, map.bounds, robot, poses[i], 1.0, 1e9);
            if (!slow.verdict) continue;
            ++decided;
            valid += *slow.verdict == Verdict::Valid;
            collision += *slow.verdict == Verdict::Collision;
            CAPTURE(real.file, poses[i].position.transpose(), poses[i].rotation);
            CHECK(std::string(to_string(fast[i].verdict)) == to_string(*slow.verdict));
        }
    }
    CHECK(decided > 300);
    CHECK(valid > 120);
    CHECK(collision > 20);
}

TEST_CASE("a map of a mesh with doubled faces has layers, but no inside")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    const Scene scene = load_scene(*folder / "mine/scene.yaml");
    CHECK(scene.parts[0].solid_pieces == 0);
    const TestMap map = map_of(scene);
    const Judge judge(map, load_robot("box:0.3,0.3,0.3"));
    SampleOptions sampling{
        .count = 100, .stance = Stance::Level, .offset = 0.2, .layers = {LayerChoice::Kind::Bottom, 0}};
    const SpawnList list = sample(judge, sampling);
    CHECK(list.spawns.size() == 100);
    const auto on_floor = std::count_if(list.spawns.begin(), list.spawns.end(),
                                        [](const Spawn& spawn) { return spawn.position.z() < 0.5; });
    CAPTURE(on_floor);
    CHECK(on_floor > 80);  // under the roof; the others are where there is only a ledge
}

TEST_CASE("the garage has spawns on every deck and none in the slabs")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    const TestMap map = map_of(load_scene(*folder / "parking_garage/scene.yaml"));
    const Judge judge(map, husky());
    SampleOptions sampling{.count = 3000, .stance = Stance::Level, .bounds = {Vec3(-20, -10, 0), Vec3(20, 10, 0)}};
    const std::vector<double> decks = {0.23, 5.79, 11.35, 16.92, 22.48, 28.03, 33.59, 39.14};
    std::vector<int> on_deck(decks.size(), 0);
    for (const Spawn& spawn : sample(judge, sampling).spawns) {
        const double ground = spawn.position.z() - 0.1;
        for (std::size_t deck = 0; deck < decks.size(); ++deck) on_deck[deck] += std::abs(ground - decks[deck]) < 0.02;
        for (const double layer : column_at(map.geometry, spawn.position.x(), spawn.position.y()).layers)
            CHECK(
                (layer <= ground + 0.1 || layer >= ground + 0.49));  // the robot is 0.39 m tall, slabs are 0.21 m thick
    }
    for (const int n : on_deck) CHECK(n > 30);
}

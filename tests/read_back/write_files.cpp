/// Writes robots with all kinds of rotations in every format, and their true poses to truth.json. The Python programs
/// beside this file read them.
#include "worlds/random.h"

#include <spawnfield/output_file.h>
#include <spawnfield/robot_inertia.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/simulators.h>

#include <nlohmann/json.hpp>

#include <iostream>
#include <numbers>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

std::vector<RobotStart> random_robots(std::size_t count)
{
    constexpr double pi = std::numbers::pi;
    const std::vector<std::string> names = numbered_names("--name", "husky_{i:03}", count),
                                   name_spaces = numbered_names("--namespace", "fleet/husky_{i}", count);
    Random random{11};
    std::vector<RobotStart> out;
    for (std::size_t i = 0; i < count; ++i) {
        const Rpy rpy = {random.between(-pi, pi), random.between(-pi / 2, pi / 2), random.between(-pi, pi)};
        out.push_back({names[i],
                       name_spaces[i],
                       {random.between(-500, 500), random.between(-500, 500), random.between(-5, 90)},
                       rpy});
    }
    out[1].rpy = {0, 0, 0};
    out[2].rpy = {1e-7, -2.5e-9, -3e-5};  // numbers whose shortest text has an exponent
    out[3].position = {-1e-5, 1e-17, 12345678.25};
    out[4].rpy = {0.3, pi / 2, -0.4};  // nose down
    out[5].rpy = {-2, -pi / 2, 3};
    return out;
}

nlohmann::json truth_of(const std::vector<RobotStart>& robots)
{
    nlohmann::json out = nlohmann::json::array();
    for (const RobotStart& robot : robots) {
        const Mat3 r = rotation_from(robot.rpy);
        out.push_back(
            {{"name", robot.name},
             {"namespace", robot.name_space},
             {"position", {robot.position.x(), robot.position.y(), robot.position.z()}},
             {"rotation", {{r(0, 0), r(0, 1), r(0, 2)}, {r(1, 0), r(1, 1), r(1, 2)}, {r(2, 0), r(2, 1), r(2, 2)}}}});
    }
    return out;
}

/// Robots of two kinds, with a model each: files of fleets.
void write_fleet(const fs::path& folder, std::vector<RobotStart> robots)
{
    const std::vector<std::string> models{"/opt/a robot's/husky.urdf", "/opt/cart.sdf"};
    const Pose turned{{0.1, -0.2, 0.3}, rotation_from_rpy(0.3, -0.2, 0.9)};
    const std::vector<Vec3> corners{{0, 0, 0}, {0.6, 0, 0}, {0, 0.4, 0}, {0, 0, 0.5}, {0.6, 0.4, 0.5}};
    const std::vector<Robot> kinds{
        make_robot("husky",
                   {shape_part(box_shape({1, 0.6, 0.4}, turned)), shape_part(sphere_shape(0.2, {0, 0, 1})),
                    shape_part(cylinder_shape(0.1, 0.5, turned)), shape_part(capsule_shape(0.1, 0.5, turned))}),
        make_robot("cart", {hull_part(corners)})};
    std::vector<std::size_t> kind_of;
    for (std::size_t i = 0; i < robots.size(); ++i) {
        kind_of.push_back(i % 2);
        robots[i].model = models[i % 2];
    }
    const auto write = [&](const char* name, const std::string& text) { write_file_atomically(folder / name, text); };
    write("fleet.launch", ros1_launch(robots, {}));
    write("fleet.launch.py", ros2_launch_py(robots, {.world = "arena's"}));
    write("fleet.launch.xml", ros2_launch_xml(robots, {.world = "arena's"}));
    write("bodies.xml", mujoco_bodies(robots, kinds, kind_of));
    write("robot.urdf",
          "<robot name='r'><mujoco><compiler fusestatic='false'/></mujoco><link name='a'><inertial><origin xyz='0.1 0 "
          "0.2' rpy='0.3 -0.2 0.9'/><mass value='3'/>"
          "<inertia ixx='0.2' iyy='0.3' izz='0.4' ixy='0.01' ixz='0.02' iyz='-0.03'/></inertial><collision><geometry>"
          "<box size='1 0.6 0.4'/></geometry></collision></link><link name='b'><inertial><mass value='2'/>"
          "<inertia ixx='0.05' iyy='0.06' izz='0.07' ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j' "
          "type='revolute'><parent link='a'/><child link='b'/><origin xyz='-0.4 0.2 0.5' rpy='0 0.5 0'/><axis "
          "xyz='0 0 1'/><limit lower='-2' upper='2' effort='1' velocity='1'/></joint></robot>");
    const std::vector<std::optional<RobotInertia>> inertias{
        robot_inertia((folder / "robot.urdf").string(), {.joints = {{"j", 0.7}}}), std::nullopt};
    write("masses.xml", mujoco_bodies(robots, kinds, kind_of, inertias));
}

void write_all(const fs::path& folder)
{
    const std::vector<RobotStart> robots = random_robots(60);
    fs::create_directories(folder);
    const auto write = [&](const char* name, const std::string& text) { write_file_atomically(folder / name, text); };
    const std::string file = "/opt/a robot's <home> & \"more\"/husky.urdf";
    write("truth.json", truth_of(robots).dump(1));
    write("file.launch", ros1_launch(robots, {.file = file}));
    write("sdf.launch", ros1_launch(robots, {.file = "/opt/a robot's/husky.sdf"}));
    write("topic.launch", ros1_launch(robots, {.topic = "description"}));
    write("find.launch", ros1_launch(robots, {.file = "$(find roslaunch)/husky.urdf"}));
    write("file.launch.py", ros2_launch_py(robots, {.file = file, .world = "arena's"}));
    write("topic.launch.py", ros2_launch_py(robots, {.topic = "robot_description"}));
    write("file.launch.xml", ros2_launch_xml(robots, {.file = file, .world = "arena's"}));
    write("topic.launch.xml", ros2_launch_xml(robots, {.topic = "robot_description"}));
    write("each.xml", mujoco_keyframes(robots, {.joints = {0.25, -1e-9}}));
    write("together.xml", mujoco_keyframes(robots, {.together = true}));
    write("wxyz.npy", root_poses_npy(robots, QuaternionOrder::Wxyz));
    write("xyzw.npy", root_poses_npy(robots, QuaternionOrder::Xyzw));
    write("none.npy", root_poses_npy({}, QuaternionOrder::Wxyz));
    std::vector<Vec3> points;
    for (const RobotStart& robot : robots) points.push_back(robot.position);
    const TerrainPatches patches = terrain_patches(
        points, {.rows = 2, .cols = 3, .bounds = {Vec3(-500, -500, 0), Vec3(500, 500, 0)}});
    write("flat_patches.npy", patches.flat_patches);
    write("terrain_origins.npy", patches.terrain_origins);
    write("carla.json", carla_json(robots, "vehicle.audi.tt"));
    write("objects.json", carla_objects_json(robots, "vehicle.audi.tt"));
    write("unity.csv", unity_csv(robots, Frame::Unity));
    write("unity_gltf.csv", unity_csv(robots, Frame::UnityGltf));
    write("unreal.csv", unreal_csv(robots));
    write_fleet(folder, robots);
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::cerr << "usage: spawnfield_read_back FOLDER\n";
        return 2;
    }
    write_all(argv[1]);
    return 0;
}

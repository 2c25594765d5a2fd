#include "this_build.h"
#include "arena.h"
#include "worlds/random.h"

#include <spawnfield/error.h>
#include <spawnfield/poses.h>
#include <spawnfield/simulators.h>

#include <nlohmann/json.hpp>
#include <sdf/sdf.hh>

#include <numbers>

using namespace spawnfield;
namespace fs = std::filesystem;

namespace {

const std::string urdf_text =
    R"(<robot name="cart"><link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 0.1"/><geometry><box size="0.6 0.4 0.2"/></geometry></collision></link></robot>)";

const std::string world_text = R"(<?xml version="1.0"?>
<!-- </world> in a comment -->
<sdf version="1.6">
  <world name="yard">
    <gravity>0 0 -1.62</gravity>
    <model name="wall"><static>true</static><link name="link"><collision name="c"><geometry><box><size>1 2 3</size></box></geometry></collision></link></model>
  </world>
</sdf>
)";

std::vector<RobotStart> random_robots(std::size_t count)
{
    constexpr double pi = std::numbers::pi;
    const std::vector<std::string> names = numbered_names("--name", "cart_{i}", count);
    Random random{4};
    std::vector<RobotStart> out;
    for (const std::string& name : names)
        out.push_back({name,
                       name,
                       {random.between(-90, 90), random.between(-90, 90), random.between(-9, 9)},
                       {random.between(-pi, pi), random.between(-pi / 2, pi / 2), random.between(-pi, pi)}});
    out.front().rpy.pitch = pi / 2;  // nose down
    return out;
}

/// Returns a file as libsdformat reads it.
sdf::Root sdf_root(const fs::path& file, const fs::path& models = {})
{
    sdf::ParserConfig config;
    config.SetFindCallback([=](const std::string& uri) {
        constexpr std::string_view scheme = "model://";
        return uri.starts_with(scheme) ? (models / uri.substr(scheme.size())).string() : std::string();
    });
    sdf::Root root;
    for (const sdf::Error& error : root.Load(file.string(), config)) FAIL(error.Message());
    REQUIRE(root.WorldCount() == 1);
    return root;
}

void check_models(const sdf::World& world, const std::vector<RobotStart>& robots)
{
    for (const RobotStart& robot : robots) {
        const sdf::Model* const model = world.ModelByName(robot.name);
        REQUIRE(model != nullptr);
        const auto& pose = model->RawPose();
        CHECK((Vec3(pose.X(), pose.Y(), pose.Z()) - robot.position).norm() <= 1e-9);
        const Eigen::Quaterniond q(pose.Rot().W(), pose.Rot().X(), pose.Rot().Y(), pose.Rot().Z());
        CHECK((q.toRotationMatrix() - rotation_from(robot.rpy)).cwiseAbs().maxCoeff() <= 1e-9);
    }
}

std::string message_of(const std::function<void()>& act)
{
    try {
        act();
    } catch (const ArgumentError& error) {
        return error.message();
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("names have the number of the robot, from 1 on, in the place that the pattern gives")
{
    CHECK(numbered_names("--name", "husky_{i}", 3) == std::vector<std::string>{"husky_1", "husky_2", "husky_3"});
    CHECK(numbered_names("--name", "{i:03}_husky", 2) == std::vector<std::string>{"001_husky", "002_husky"});
    CHECK(numbered_names("--name", "r{i:01}", 11).back() == "r11");  // more digits than the pattern requires
    CHECK(numbered_names("--name", "alone", 1) == std::vector<std::string>{"alone"});
    CHECK(numbered_names("--name", "alone", 0).empty());
    CHECK(numbered_names("--name", "r{i}", 120).size() == 120);
}

TEST_CASE("bad patterns and names are refused, and the message names them")
{
    const auto refused = [](const std::string& pattern, std::size_t count) {
        return message_of([&] { numbered_names("--name", pattern, count); });
    };
    CHECK(refused("husky", 2) == "--name \"husky\" gives all 2 robots one name, needs {i} or {i:03}");
    for (const char* const pattern :
         {"r{", "r}", "r}{", "r{}", "r{j}", "r{i:3}", "r{i:00}", "r{i:012}", "r{i:0x}", "r{i", "r{i:03d}"})
        CHECK_THAT(refused(pattern, 2), Contains("has braces that are neither {i} nor {i:03}"));
    CHECK_THAT(refused("r{i}{i}", 2), Contains("has braces twice"));
    CHECK_THAT(refused("", 1), Contains("is empty"));
    CHECK_THAT(refused("a\n{i}", 1), Contains("control character"));
    const std::vector<std::string> twice = {"a", "b", "a"};
    CHECK(message_of([&] { check_names("column name:", twice); }) ==
          "column name: \"a\" is the name of two robots; give each robot a name of its own");
}

TEST_CASE("names for ROS and SDF keep their rules")
{
    const auto ros = [](const std::string& name, int version) {
        const std::vector<std::string> names = {name};
        return message_of([&] { check_ros_names("--namespace", names, version); });
    };
    for (const char* const name : {"a", "a_1", "fleet/a1", "/fleet/a", "A"})
        for (const int version : {1, 2}) CHECK(ros(name, version).empty());
    for (const char* const name : {"", "/", "a-1", "a b", "a.b", "1a", "a/", "a//b", "ä"})
        for (const int version : {1, 2}) CHECK_FALSE(ros(name, version).empty());
    CHECK(ros("_a", 2).empty());
    CHECK_FALSE(ros("_a", 1).empty());
    CHECK(ros("a/1b", 1).empty());
    CHECK_FALSE(ros("a/1b", 2).empty());
    CHECK_FALSE(ros("a__b", 2).empty());
    CHECK_THAT(ros("a-1", 2), Contains("--namespace \"a-1\" has \"-\""));
    const auto model = [](const std::string& name) {
        const std::vector<std::string> names = {name};
        return message_of([&] { check_model_names("--name", names); });
    };
    for (const char* const name : {"a", "a-1", "1.b", "fleet/a", "__a"}) CHECK(model(name).empty());
    for (const char* const name : {"a::b", "a b", "__a__", "a<b", "a'b"}) CHECK_FALSE(model(name).empty());
}

TEST_CASE("in a new world libsdformat reads the robots at their poses, from a URDF and from a model")
{
    const TempFolder folder;
    const std::vector<RobotStart> robots = random_robots(40);
    const fs::path urdf = folder.write("my robots/cart & co.urdf", urdf_text);
    folder.write("new.sdf", sdf_world(robots, {.uri = urdf.string(), .world_name = "a \"new\" one"}));
    const sdf::Root of_urdf = sdf_root(folder / "new.sdf");
    CHECK(of_urdf.WorldByIndex(0)->Name() == "a \"new\" one");
    CHECK(of_urdf.WorldByIndex(0)->ModelCount() == robots.size());
    check_models(*of_urdf.WorldByIndex(0), robots);

    folder.write("models/cart/model.config", "<model><name>cart</name><sdf version=\"1.6\">model.sdf</sdf></model>");
    folder.write(
        "models/cart/model.sdf",
        "<sdf version=\"1.6\"><model name=\"cart\"><pose>9 9 9 0 0 0</pose><link name=\"base\"/></model></sdf>");
    folder.write("model.sdf", sdf_world(robots, {.uri = "model://cart"}));
    const sdf::Root of_model = sdf_root(folder / "model.sdf", folder / "models");
    CHECK(of_model.WorldByIndex(0)->Name() == "spawns");
    check_models(*of_model.WorldByIndex(0), robots);  // the pose of the model itself has no effect
}

TEST_CASE("a world file keeps all its contents, and the robots are added")
{
    const TempFolder folder;
    const std::vector<RobotStart> robots = random_robots(5);
    const fs::path urdf = folder.write("cart.urdf", urdf_text);
    const std::string text = sdf_world(robots,
                                       {.uri = urdf.string(), .world_text = world_text, .world_file = "yard.world"});
    const std::size_t end = world_text.rfind("  </world>");
    CHECK(
        text.starts_with(world_text.substr(0, end) + "    <include>\n      <uri>"));  // the other text does not change
    CHECK(text.ends_with("</include>\n" + world_text.substr(end)));
    folder.write("yard.sdf", text);
    const sdf::Root root = sdf_root(folder / "yard.sdf");
    const sdf::World& world = *root.WorldByIndex(0);
    CHECK(world.Name() == "yard");
    CHECK(world.Gravity().Z() == -1.62);
    CHECK(world.ModelByName("wall") != nullptr);
    CHECK(world.ModelCount() == 6);
    check_models(world, robots);
}

TEST_CASE("robots are added to the right world, for every form of its file")
{
    const TempFolder folder;
    const std::vector<RobotStart> robots = random_robots(2);
    folder.write("cart/model.config", "<model><name>cart</name><sdf version=\"1.6\">model.sdf</sdf></model>");
    folder.write("cart/model.sdf", "<sdf version=\"1.6\"><model name=\"cart\"><link name=\"base\"/></model></sdf>");
    const std::string plugin =
        "<plugin name='p' filename='f'><world>not this one</world><text><![CDATA[</world>]]></text></plugin>";
    for (const std::string& text :
         {std::string("<sdf version='1.6'><world name='a'/></sdf>"),
          "<sdf version='1.6'><world name='a'>" + plugin + "</world></sdf>",
          "<sdf version='1.6'><world name='a > b' >" + plugin + "<!--</world>--></world\n></sdf>\n<!-- <world> -->",
          std::string("<sdf version='1.6'><world name='a>'/></sdf>")}) {
        INFO(text);
        folder.write("new.sdf", sdf_world(robots, {.uri = "model://cart", .world_text = text}));
        const sdf::Root root = sdf_root(folder / "new.sdf", folder.path());
        CHECK(root.WorldByIndex(0)->ModelCount() == 2);
        check_models(*root.WorldByIndex(0), robots);
    }
    const std::string two =
        "<sdf version='1.6'>\n  <world name='a'>\n  </world>\n  <world name='b'>\n  </world>\n</sdf>\n";
    const std::string in_first = sdf_world(robots, {.uri = "model://cart", .world_name = "a", .world_text = two});
    CHECK(in_first.find("cart_2") < in_first.find("<world name='b'>"));
    CHECK(in_first.ends_with("  </world>\n  <world name='b'>\n  </world>\n</sdf>\n"));
    const std::string in_second = sdf_world(robots, {.uri = "model://cart", .world_name = "b", .world_text = two});
    CHECK(in_second.find("cart_1") > in_second.find("<world name='b'>"));
}

TEST_CASE("a file that is not a world, or in which the names are used, is refused with its name and line")
{
    const std::vector<RobotStart> robots = random_robots(1);
    const auto refused = [&](const std::string& text, const std::string& name = "") {
        return message_of([&] {
            sdf_world(robots, {.uri = "model://cart", .world_name = name, .world_text = text, .world_file = "a.world"});
        });
    };
    CHECK_THAT(refused("<sdf version='1.6'>\n<world>\n</sdf>"), Contains("a.world: line 2: is not valid XML"));
    CHECK(refused("<robot name='a'/>") == "a.world: has no <sdf> as its outermost element, needs an SDF world");
    CHECK(refused("<sdf version='1.6'><model name='a'/></sdf>") == "a.world: <sdf> has no <world>, needs one");
    CHECK_THAT(refused("<sdf><world name='a'/><world name='b'/></sdf>"), Contains("has several worlds, \"a\", \"b\""));
    CHECK(refused("<sdf><world name='a'/><world name='b'/></sdf>", "b").empty());
    CHECK_THAT(refused(world_text, "c"), Contains("has no world \"c\", only \"yard\""));
    CHECK(refused("<sdf>\n<world name='a'>\n<model name='cart_1'/></world></sdf>") ==
          "a.world: line 2: <world> has a \"cart_1\" already; give the robots other names");
    CHECK_THAT(refused("<sdf><world name='a'><include><name>cart_1</name><uri>model://x</uri></include></world></sdf>"),
               Contains("has a \"cart_1\" already"));
    const TempFolder folder;
    folder.write("models/cart/model.sdf", "<sdf version='1.6'><model name='cart_1'/></sdf>");
    CHECK_THAT(message_of([&] {
                   sdf_world(
                       robots,
                       {.uri = "model://cart",
                        .world_text = "<sdf><world name='a'><include><uri>model://cart</uri></include></world></sdf>",
                        .model_paths = {folder / "models"}});
               }),
               Contains("has a \"cart_1\" already"));
    CHECK_FALSE(message_of([&] { sdf_world(robots, {}); }).empty());
    for (std::size_t size = 1; size < world_text.size(); ++size)  // if it is cut anywhere, it is refused or complete
        if (const std::string message = refused(world_text.substr(0, size)); message.empty())
            CHECK(size >= world_text.find("</sdf>") + 6);
}

TEST_CASE("launch files need a robot as URDF or SDF")
{
    const std::vector<RobotStart> robots = random_robots(1);
    for (const auto writer : {ros1_launch, ros2_launch_py, ros2_launch_xml}) {
        CHECK_THAT(message_of([&] { writer(robots, {}); }), Contains("neither a file nor a topic"));
        CHECK_THAT(message_of([&] { writer(robots, {.file = "a.urdf.xacro"}); }), Contains("is a template"));
    }
    CHECK_THAT(message_of([&] { ros2_launch_py(robots, {.file = "$(find a)/b.urdf"}); }),
               Contains("is for launch files in XML"));
    CHECK_THAT(ros2_launch_xml(robots, {.file = "$(find-pkg-share a)/b.urdf"}),
               Contains("-file $(find-pkg-share a)/b.urdf "));
}

TEST_CASE("each tile of the terrain has its patches, and the message names an empty tile")
{
    const std::vector<Vec3> points = {{0.5, 0.4, 1}, {-3, 7, 2}, {1.5, 0.4, 3}};
    const TileGrid grid{.rows = 2, .cols = 1, .bounds = {Vec3(0, 0, 0), Vec3(2, 1, 0)}};
    const TerrainPatches patches = terrain_patches(points, grid);
    CHECK(patches.patches_per_tile == 2);  // points outside belong to the nearest tile
    CHECK(patches.flat_patches.size() == 128 + 2 * 1 * 2 * 3 * 4);
    CHECK(message_of([&] { terrain_patches(points, {.rows = 2, .cols = 2, .bounds = grid.bounds}); }) ==
          "tile 1,1 (row, column, from 0) has no spawn, but each tile needs one; ask for more spawns or fewer tiles");
    CHECK_FALSE(message_of([&] { terrain_patches(points, {.rows = 0}); }).empty());
    CHECK(terrain_patches({}, grid).patches_per_tile == 0);
}

TEST_CASE("sample and search write the robots of their CSV file in every format")
{
    const Arena arena;
    arena.write("cart.urdf", urdf_text);
    for (const std::string command : {"sample", "search"}) {
        const std::string query = command +
                                  " map -n 7 --min-distance 1 --yaw random --robot cart.urdf --name 'cart_{i:02}' ";
        REQUIRE(arena(query + "-o spawns.csv").status == 0);
        const PoseTable table = read_poses(arena / "spawns.csv");
        const std::vector<RobotStart> robots = robot_starts(table, column_of(table, "name"), column_of(table, "name"));
        REQUIRE(robots.size() == 7);
        CHECK(robots[6].name == "cart_07");
        const auto output = [&](const std::string& arguments) {
            const ProgramRun run = arena(query + "--quiet --format " + arguments);
            CHECK(run.status == 0);
            CHECK(run.err.empty());
            return run.out;
        };
        const std::string urdf = fs::canonical(arena.path()) / "cart.urdf";
        CHECK(output("ros1-launch") == ros1_launch(robots, {.file = urdf}));
        CHECK(output("ros1-launch --topic description") == ros1_launch(robots, {.topic = "description"}));
        CHECK(output("ros2-launch-py --world-name yard") == ros2_launch_py(robots, {.file = urdf, .world = "yard"}));
        CHECK(output("ros2-launch-xml --topic robot_description") ==
              ros2_launch_xml(robots, {.topic = "robot_description"}));
        CHECK(output("sdf") == sdf_world(robots, {.uri = urdf}));
        CHECK(output("sdf --robot-uri model://cart --world-name yard") ==
              sdf_world(robots, {.uri = "model://cart", .world_name = "yard"}));
        CHECK(output("mujoco --joint-qpos 0.5,-1") == mujoco_keyframes(robots, {.joints = {0.5, -1}}));
        CHECK(output("mujoco --keys together") == mujoco_keyframes(robots, {.together = true}));
        CHECK(output("carla --blueprint walker.a") == carla_json(robots, "walker.a"));
        CHECK(output("carla-ros") == carla_objects_json(robots, "vehicle.tesla.model3"));
        CHECK(output("unity") == unity_csv(robots, Frame::Unity));
        CHECK(output("unity --unity-axes gltf") == unity_csv(robots, Frame::UnityGltf));
        CHECK(output("unreal") == unreal_csv(robots));
        output("isaaclab --quaternion xyzw -o isaac");
        CHECK(names_in(arena / "isaac") ==
              std::set<std::string>{"root_pose.npy", "flat_patches.npy", "terrain_origins.npy", "isaaclab.json"});
        CHECK(bytes_of(arena / "isaac/root_pose.npy") == root_poses_npy(robots, QuaternionOrder::Xyzw));
        CHECK(nlohmann::json::parse(bytes_of(arena / "isaac/isaaclab.json"))["root_pose.npy"]["columns"] ==
              "x y z qx qy qz qw");
        const auto json = nlohmann::json::parse(output("json --namespace 'fleet/{i}'"));
        CHECK(json["poses"][6]["name"] == "cart_07");
        CHECK(json["poses"][6]["namespace"] == "fleet/7");
        CHECK(json["poses"][6]["rpy"][2] == robots[6].rpy.yaw);
    }
}

TEST_CASE("a notice says by how much a model with another origin than --robot starts too high or too low")
{
    const Arena arena;
    fs::create_directories(arena / "models");
    const auto write_box = [&](const std::string& file, const std::string& z) {
        arena.write(file, "<robot name='box'><link name='base'><collision><origin xyz='0 0 " + z +
                              "'/><geometry><box size='0.6 0.4 0.4'/></geometry></collision></link></robot>");
    };
    write_box("centred.urdf", "0");
    write_box("standing.urdf", "0.2");
    write_box("models/centred.urdf", "0");
    arena.write("broken.urdf", "<robot>");
    const auto said = [&](const std::string& options) {
        const ProgramRun run = arena("sample map -n 1 --robot standing.urdf -o out " + options);
        CAPTURE(options, run.err);
        CHECK(run.status == 0);
        return run.err;
    };
    const std::string words =
        "its lowest point is 0.2 m below its origin, but that of --robot standing.urdf is 0 m "
        "below its origin; the simulator puts the model's origin at each pose, so the robots "
        "start 0.2 m too low; give this model as --robot, or make the origins agree";
    CHECK_THAT(said("--format sdf --robot-file centred.urdf"), Contains(words));
    CHECK_THAT(said("--format ros2-launch-xml --robot-file centred.urdf"), Contains(words));
    CHECK_THAT(said("--format sdf --robot-uri file://centred.urdf"), Contains("file://centred.urdf: " + words));
    CHECK_THAT(said("--format sdf --robot-uri model://centred.urdf --model-path models"), Contains(words));
    for (const std::string silent : {"--format sdf --robot-uri model://centred.urdf", "--format sdf",
                                     "--format sdf --robot-uri broken.urdf", "--format csv"})
        CHECK_THAT(said(silent), !Contains("lowest point"));
    CHECK_THAT(arena("sample map -n 1 --robot centred.urdf -o out --format sdf --robot-file standing.urdf").err,
               Contains("start 0.2 m too high"));
    arena.write("poses.csv", "x,y,z\n0,3,0\n");
    const std::string of_poses = "export map --poses poses.csv --format sdf --robot-file centred.urdf -o out";
    CHECK_THAT(arena(of_poses + " --robot standing.urdf").err, Contains(words));
    CHECK_THAT(arena(of_poses).err, !Contains("lowest point"));
}

TEST_CASE("export writes the poses of a CSV file in every format, with roll, pitch and their own names")
{
    const Arena arena;
    arena.write("cart.urdf", urdf_text);
    const std::string rows = "first,1,2,3,0.1,-0.2,0.3\nsecond,-4,5.5,6,0,1.5707963267948966,3\n";
    arena.write("poses.csv", "name,x,y,z,roll,pitch,yaw\n" + rows);
    const PoseTable table = read_poses(arena / "poses.csv");
    const std::vector<RobotStart> robots = robot_starts(table, {"first", "second"}, {"first", "second"});
    const auto output = [&](const std::string& arguments) {
        const ProgramRun run = arena("export map --quiet --poses poses.csv --format " + arguments);
        CHECK(run.status == 0);
        CHECK(run.err.empty());
        return run.out;
    };
    const std::string urdf = fs::canonical(arena.path()) / "cart.urdf";
    CHECK(output("csv") == robots_csv(robots));
    CHECK(output("ros1-launch --robot-file cart.urdf") == ros1_launch(robots, {.file = urdf}));
    CHECK(output("ros2-launch-py --robot cart.urdf") == ros2_launch_py(robots, {.file = urdf}));
    CHECK(output("ros2-launch-py --robot cart.urdf --package-path . --mesh-parts 2") ==
          ros2_launch_py(robots, {.file = urdf}));
    CHECK(output("ros2-launch-xml --topic a") == ros2_launch_xml(robots, {.topic = "a"}));
    CHECK(output("sdf --robot-uri model://cart") == sdf_world(robots, {.uri = "model://cart"}));
    CHECK(output("mujoco --keys together") == mujoco_keyframes(robots, {.together = true}));
    CHECK(output("carla") == carla_json(robots, "vehicle.tesla.model3"));
    CHECK(output("carla-ros --blueprint a") == carla_objects_json(robots, "a"));
    CHECK(output("unity") == unity_csv(robots, Frame::Unity));
    CHECK(output("unreal") == unreal_csv(robots));
    output("isaaclab -o isaac");
    CHECK(bytes_of(arena / "isaac/root_pose.npy") == root_poses_npy(robots, QuaternionOrder::Wxyz));
    const auto json = nlohmann::json::parse(output("json --name 'r{i}'"));
    CHECK(json["poses"][1]["name"] == "r2");  // --name takes precedence over the names in the file
    CHECK(json["poses"][1]["rpy"][1] == Approx(1.5707963267948966).epsilon(1e-15));
    CHECK_FALSE(json.contains("robot"));

    arena.write("twice.csv", "name,x,y,z\na,0,0,1\na,1,0,1\n");
    CHECK_THAT(arena("export map --poses twice.csv --format json").err,
               Contains("column name: \"a\" is the name of two robots"));
    arena.write("buried.csv", "x,y,z\n0,0,-50\n");
    const ProgramRun buried = arena("export map --poses buried.csv --format isaaclab -o new");
    CHECK(buried.status == 2);
    CHECK_THAT(buried.err, Contains("there is no ground below robot robot_1 at 0, 0, -50"));
    CHECK_THAT(arena("export map --format unity").err, Contains("--format unity needs --poses"));
    CHECK_THAT(arena("export map --format unity --poses poses.csv --tiles 1,1").err,
               Contains("--tiles is not for --format unity; it is for isaaclab"));
    CHECK_THAT(arena("export map --format nav2 --robot box:1,1,1 --poses poses.csv -o a.yaml").err,
               Contains("--poses is not for --format nav2"));
    CHECK_FALSE(fs::exists(arena / "new"));
}

TEST_CASE("export of poses that are not valid according to their file gives a notice, and exports them")
{
    const Arena arena;
    const std::string rows = "0,3,0.1\n-2,0,0.1\n0,3,9\n", csv = "x,y,z\n" + rows;
    arena.write("poses.csv", csv);
    REQUIRE(arena("check map --poses poses.csv -o judged.csv" + husky_option).status == 0);
    const auto run = [&](const std::string& file) { return arena("export map --format csv --poses " + file); };
    const ProgramRun judged = run("judged.csv");
    CHECK(judged.status == 0);
    CHECK(
        judged.err.starts_with("notice: judged.csv: 2 of 3 poses are not valid according to the column verdict, but "
                               "all poses are exported; to export only the valid ones, remove the other rows from "
                               "the file (docs/simulators.md has a command for it)\n"));
    CHECK(judged.out == run("poses.csv").out);
    CHECK_THAT(run("poses.csv").err, !Contains("notice"));
    arena.write("valid.csv", "x,y,z,verdict\n0,3,0.1,valid\n");
    CHECK_THAT(run("valid.csv").err, !Contains("notice"));
    arena.write("own.csv", "x,y,z,verdict\n0,3,0.1,good\n");  // a column of the user with this name
    CHECK_THAT(run("own.csv").err, !Contains("notice"));
    CHECK_THAT(run("- <judged.csv").err, Contains("notice: standard input: 2 of 3 poses are not valid"));
}

TEST_CASE("patches are on the ground below the spawns")
{
    const Arena arena;
    CHECK(arena("sample map -n 20 --stance level --offset 0.3 --robot box:0.3,0.3,0.3 --layers top --region 3,-9,9,9 "
                "--format "
                "isaaclab -o isaac")
              .status == 0);
    const std::string bytes = bytes_of(arena / "isaac/flat_patches.npy");
    const Map map = read_map(arena / "map");
    REQUIRE(bytes.size() == 128 + 20 * 12);
    for (std::size_t i = 0; i < 20; ++i) {
        std::array<float, 3> p{};
        std::memcpy(p.data(), bytes.data() + 128 + 12 * i, 12);
        CHECK(column_at(map.geometry, p[0], p[1]).layers.front() == Approx(p[2]).margin(1e-5));
    }
}

TEST_CASE("the commands of the tour, of each simulator's page and of the page on floors work as they are written",
          "[slow]")
{
    const TempFolder folder;  // stands for /tmp and for the source folder
    fs::create_symlink(program_file(), folder / "spawnfield");
    fs::create_symlink(source_folder() + "/maps", folder / "maps");
    std::vector<fs::path> pages{source_folder() + "/docs/floors.md", source_folder() + "/docs/getting-started.md"};
    for (const auto& page : fs::directory_iterator(source_folder() + "/docs/simulators")) pages.push_back(page.path());
    for (const fs::path& page : pages) {
        std::istringstream text(bytes_of(page));
        std::string script;
        bool is_code = false;
        for (std::string line; std::getline(text, line);) {
            if (line.starts_with("```"))
                is_code = line == "```" && !is_code;
            else if (is_code &&
                     (line.starts_with("spawnfield ") || line.starts_with("cp ") || line.starts_with("printf ")))
                script += line + "\n";
        }
        for (std::size_t at = script.find("/tmp"); at != std::string::npos; at = script.find("/tmp"))
            script.replace(at, 4, ".");
        INFO(page.string() + "\n" + script);
        CHECK(std::count(script.begin(), script.end(), '\n') >= 2);
        CHECK(run_program(folder, "--version && set -e && PATH=$PWD:$PATH\n" + script).status == 0);
    }
}

TEST_CASE("things that a simulator would add to a pose, or does not know, are refused or get a notice")
{
    const Arena arena;
    const std::string link =
        "<link name='base'><collision name='c'><geometry><box><size>0.3 0.2 "
        "0.1</size></box></geometry></collision></link>"
        "<link name='arm'><collision name='c'><geometry><box><size>0.1 0.1 "
        "0.1</size></box></geometry></collision></link>"
        "<joint name='hinge' type='revolute'><parent>base</parent><child>arm</child><axis><xyz>0 0 "
        "1</xyz></axis></joint>";
    arena.write("frame.sdf", "<sdf version='1.9'><model name='m' placement_frame='arm'>" + link + "</model></sdf>");
    arena.write("posed.sdf", "<sdf version='1.9'><model name='m'><pose>0 0 7 0 0 0.4</pose>" + link + "</model></sdf>");
    arena.write("plain/model.sdf", "<sdf version='1.9'><model name='m'>" + link + "</model></sdf>");
    arena.write("plain/model.config", "<model><sdf>model.sdf</sdf></model>");
    const auto run = [&](const std::string& arguments) {
        return arena("sample map -n 2 --stance level --offset 1 --max-height 2 " + arguments);
    };
    const ProgramRun frame = run("--robot frame.sdf --format sdf"),
                     posed = run("--robot posed.sdf --format ros1-launch");
    CHECK(frame.status == 2);
    CHECK_THAT(frame.err, Contains("frame.sdf has placement_frame=\"arm\""));
    CHECK(posed.status == 2);
    CHECK_THAT(posed.err, Contains("posed.sdf has a <pose> of its own, which gazebo_ros adds"));
    CHECK(run("--robot posed.sdf --format sdf").status == 0);
    CHECK(run("--robot frame.sdf --format ros2-launch-py").status == 0);
    const ProgramRun folder = run("--robot plain --format ros1-launch --joints hinge=0.25");
    CHECK(folder.status == 0);
    CHECK_THAT(folder.out,
               Contains("-sdf -file " + (arena / "plain/model.sdf").string()) && Contains(" -J hinge 0.25"));
    CHECK(folder.err.find("does not contain joints") == std::string::npos);
    CHECK_THAT(run("--robot plain --format sdf --joints hinge=0.25").err,
               Contains("notice: --format sdf does not contain joints"));
    CHECK(run("--robot plain --format sdf --robot-file 'a/$(x)/b.urdf'").status == 2);
}

TEST_CASE("missing options and options that a format cannot use are reported before all work")
{
    const Arena arena;
    arena.write("yard.world", world_text);
    arena.write("isaac/notes.txt", "mine");
    const std::string query = "sample map -n 3 --robot box:0.5,0.5,0.5 ";
    const auto refused = [&](const std::string& arguments, int status) {
        const ProgramRun run = arena(query + arguments);
        CHECK(run.status == status);
        CHECK(run.out.empty());
        return run.err;
    };
    CHECK_THAT(refused("--format ros1-launch", 2),
               Contains("needs --robot-file FILE") && Contains("box:0.5,0.5,0.5 is not such a file"));
    CHECK_THAT(refused("--format sdf", 2), Contains("needs --robot-uri URI"));
    CHECK_THAT(refused("--format isaaclab", 2), Contains("needs -o FOLDER"));
    CHECK_THAT(refused("--format isaaclab -o isaac", 1), Contains("contains notes.txt"));
    CHECK_THAT(refused("--format isaaclab --tiles 2 -o new", 2), Contains("--tiles is \"2\", needs ROWS,COLS"));
    CHECK_THAT(refused("--format isaaclab --tiles 40,40 -o new", 2), Contains("has no spawn"));
    CHECK_THAT(refused("--format mujoco --joint-qpos 1,a", 2), Contains("--joint-qpos: \"a\" is not a finite number"));
    CHECK_THAT(refused("--format ros2-launch-py --robot-file none.urdf", 4),
               Contains("none.urdf: does not exist (--robot-file)"));
    CHECK_THAT(refused("--format ros2-launch-py --topic a --robot-file none.urdf", 2),
               Contains("--topic and --robot-file"));
    CHECK_THAT(refused("--format ros2-launch-py --topic a --name 'a-{i}'", 2), Contains("\"a-1\" has \"-\""));
    CHECK_THAT(refused("--format sdf --robot-uri model://a --name 'a::{i}'", 2),
               Contains("which is not allowed in a model's name"));
    CHECK_THAT(refused("--format sdf --robot-uri model://a --world none.world", 4),
               Contains("none.world: does not exist"));
    CHECK_THAT(refused("--format sdf --robot-uri model://a --world yard.world --world-name meadow", 4),
               Contains("has no world \"meadow\""));
    CHECK_THAT(refused("--name robot", 2), Contains("gives all 3 robots one name"));
    const ProgramRun idle = arena(query + "--format csv --tiles 1,1 --topic a");
    CHECK(idle.status == 0);
    CHECK_THAT(idle.err, Contains("notice: --tiles has no effect: --format csv does not use it"));
    CHECK_THAT(idle.err, Contains("notice: --topic has no effect"));
    const ProgramRun thesis = arena(query + "--format thesis --name 'a{i}' -o thesis");
    CHECK(thesis.status == 0);
    CHECK_THAT(thesis.err, Contains("notice: --name has no effect: --format thesis does not use it"));
    const auto warns_of_relative_paths = [&](const std::string& world, const std::string& out) {
        const ProgramRun run = arena(query + "--format sdf --robot-uri model://a --world " + world + " -o " + out);
        CHECK(run.status == 0);
        return run.err.find("are relative to this file") != std::string::npos;
    };
    arena.write("near/a.world",
                "<sdf version='1.6'><world name='a'><include><uri>\n  models/b </uri></include></world></sdf>");
    CHECK_FALSE(warns_of_relative_paths("yard.world", "new.sdf"));
    CHECK_FALSE(warns_of_relative_paths("yard.world", "near/new.sdf"));  // the world has no paths
    CHECK_FALSE(warns_of_relative_paths("near/a.world", "near/new.sdf"));
    CHECK(warns_of_relative_paths("near/a.world", "new.sdf"));
    CHECK(arena.names() == std::set<std::string>{"map", "yard.world", "isaac", "thesis", "new.sdf", "near"});
}

TEST_CASE("a notice says if robots are added to another world than the one from which the map was baked")
{
    const Arena arena;
    const std::string world =
        "<sdf version='1.7'><world name='w'><model name='ground'><static>true</static><link name='l'>"
        "<collision name='terrain'><geometry><box><size>9 9 "
        "1</size></box></geometry></collision></link></model></world>"
        "</sdf>";
    arena.write("flat.sdf", world);
    arena.write("other.sdf", world);
    REQUIRE(arena("bake flat.sdf -o flat -q --label '*=terrain'").status == 0);
    const auto notice_with = [&](const std::string& file) {
        const ProgramRun run = arena(
            "sample flat -n 1 --robot box:0.5,0.5,0.5 --format sdf --robot-uri model://a -o new.sdf "
            "--world " +
            file);
        CHECK(run.status == 0);
        return run.err.substr(0, run.err.find('\n'));
    };
    CHECK(notice_with("other.sdf") ==
          "notice: the robots are added to other.sdf, but the map was baked from flat.sdf; are they the same world?");
    CHECK_THAT(notice_with("flat.sdf"), !Contains("the robots are added to"));
}

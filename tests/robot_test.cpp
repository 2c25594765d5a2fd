#include "this_build.h"
#include "catch.h"
#include "check_bounds.h"
#include "mesh_text.h"
#include "robot/hull.h"
#include "shared_scenes.h"
#include "temp_folder.h"

#include <spawnfield/error.h>
#include <spawnfield/robot.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <set>

using namespace spawnfield;

namespace {

Robot load_parts(const TempFolder& folder, const std::string& parts, const std::string& more = "")
{
    return load_robot(
        folder.write("robot.yaml", "format: spawnfield-robot/1\nname: test\nparts:\n" + parts + more).string());
}

std::string urdf(const std::string& inside)
{
    return "<?xml version=\"1.0\"?>\n<robot name=\"test\">\n" + inside + "\n</robot>\n";
}

std::string link_of(const std::string& name, const std::string& geometry, const std::string& origin = "xyz=\"0 0 0\"")
{
    return "<link name=\"" + name + "\"><collision><origin " + origin + "/><geometry>" + geometry +
           "</geometry></collision></link>\n";
}

std::string joint_of(const std::string& parent, const std::string& child, const std::string& origin,
                     const std::string& type = "fixed")
{
    return "<joint name=\"" + parent + "_" + child + "\" type=\"" + type + "\"><origin " + origin +
           "/><parent link=\"" + parent + "\"/><child link=\"" + child +
           "\"/><axis xyz=\"0 0 1\"/><limit lower=\"1\" upper=\"2\" effort=\"1\" velocity=\"1\"/></joint>\n";
}

std::string axis_joint(const std::string& name, const std::string& type, const std::string& parent,
                       const std::string& child, const std::string& origin, const std::string& axis,
                       const std::string& limits = "", const std::string& more = "")
{
    const std::string limit = limits.empty() ? "" : "<limit " + limits + " effort=\"1\" velocity=\"1\"/>";
    return "<joint name=\"" + name + "\" type=\"" + type + "\"><origin " + origin + "/><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/><axis xyz=\"" + axis + "\"/>" + limit + more + "</joint>\n";
}

Robot load_urdf(const TempFolder& folder, const std::string& inside, const RobotOptions& options = {})
{
    return load_robot(folder.write("robot.urdf", urdf(inside)).string(), options);
}

const std::string small_box = "<box size=\"0.2 0.4 0.6\"/>";

}  // namespace

TEST_CASE("box:LX,LY,LZ stands on the origin")
{
    const Robot robot = load_robot("box:0.99,0.67,0.39");
    REQUIRE(robot.parts.size() == 1);
    CHECK(robot.parts[0].shape.kind == ShapeKind::Box);
    CHECK(robot.parts[0].shape.size == Vec3(0.99, 0.67, 0.39));
    check_bounds(robot.bounds(), {-0.495, -0.335, 0}, {0.495, 0.335, 0.39});
    CHECK(robot.name == "box:0.99,0.67,0.39");
    CHECK(robot.contacts.empty());
}

TEST_CASE("box:LX,LY,LZ@x,y,z has its centre there")
{
    check_bounds(load_robot("box:1,2,3@0.5,-1,0").bounds(), {0, -2, -1.5}, {1, 0, 1.5});
    check_bounds(load_robot("box:1,2,3@0,0,1e-1").bounds(), {-0.5, -1, -1.4}, {0.5, 1, 1.6});
}

TEST_CASE("an invalid box robot is wrong usage, with the reason")
{
    const std::pair<std::string, std::string> cases[] = {
        {"box:", "\"\" is not a finite number"},
        {"box:1,2", "has 2 side lengths, needs 3 (box:LX,LY,LZ[@x,y,z])"},
        {"box:1,2,3,4", "has 4 side lengths, needs 3 (box:LX,LY,LZ[@x,y,z])"},
        {"box:1,2,x", "\"x\" is not a finite number"},
        {"box:1,2,3m", "\"3m\" is not a finite number"},
        {"box:1,,3", "\"\" is not a finite number"},
        {"box:1,nan,3", "\"nan\" is not a finite number"},
        {"box:1,2,inf", "\"inf\" is not a finite number"},
        {"box:1,0,3", "side length is 0, needs > 0 m"},
        {"box:1,-2,3", "side length is -2, needs > 0 m"},
        {"box:1,2,3@0,0", "has 2 coordinates after @, needs 3"},
        {"box:1,2,3@0,0,", "\"\" is not a finite number"},
    };
    for (const auto& [robot, wanted] : cases) {
        CHECK_THROWS_AS(load_robot(robot), ArgumentError);
        CHECK_THROWS_WITH(load_robot(robot), "robot \"" + robot + "\": " + wanted);
    }
}

TEST_CASE("robot.yaml can have boxes, spheres, cylinders, capsules and contacts")
{
    const TempFolder folder;
    const Robot robot = load_parts(
        folder,
        "  - {name: base, box: [1, 2, 3], xyz: [0, 0, 1.5]}\n  - {sphere: 0.5, xyz: [2, 0, 0]}\n"
        "  - {cylinder: {radius: 0.1, length: 4}, rpy_deg: [90, 0, 0]}\n"
        "  - {capsule: {radius: 0.25, length: 1}, xyz: [0, 0, 5]}\n",
        "contacts: [[0.5, 1, 0], [-0.5, -1, 0]]\n");
    CHECK(robot.name == "test");
    REQUIRE(robot.parts.size() == 4);
    check_bounds(robot.parts[0].bounds(), {-0.5, -1, 0}, {0.5, 1, 3});
    check_bounds(robot.parts[1].bounds(), {1.5, -0.5, -0.5}, {2.5, 0.5, 0.5});
    check_bounds(robot.parts[2].bounds(), {-0.1, -2, -0.1}, {0.1, 2, 0.1});
    check_bounds(robot.parts[3].bounds(), {-0.25, -0.25, 4.25}, {0.25, 0.25, 5.75});
    check_bounds(robot.bounds(), {-0.5, -2, -0.5}, {2.5, 2, 5.75});
    REQUIRE(robot.contacts.size() == 2);
    CHECK(robot.contacts[1] == Vec3(-0.5, -1, 0));
    CHECK(robot.parts[1].centre() == Vec3(2, 0, 0));
}

TEST_CASE("the Husky of maps/robots is the one of the thesis")
{
    const Robot robot = load_robot((std::filesystem::path(source_folder()) / "maps/robots/husky.yaml").string());
    check_bounds(robot.bounds(), {-0.495, -0.335, 0}, {0.495, 0.335, 0.39});
    CHECK(robot.contacts.size() == 4);
}

TEST_CASE("robot.yaml says how a robot drives")
{
    const TempFolder folder;
    const auto drive_of = [&](const std::string& keys) { return load_parts(folder, "  - {sphere: 1}\n" + keys).drive; };
    CHECK(!drive_of("").kind);
    CHECK(drive_of("drive: omni\n").kind == Drive::Omni);
    CHECK(drive_of("drive: legged\nmax_step: 0.2\n").max_step == 0.2);
    CHECK(drive_of("drive: car\nturning_radius: 5.5\n").turning_radius == 5.5);
    CHECK(drive_of("wheel_radius: 0.165\n").wheel_radius == 0.165);
}

TEST_CASE("the wheel radius of a URDF is that of its smallest wheel")
{
    const TempFolder folder;
    const auto cylinder = [](double radius) {
        return "<cylinder radius=\"" + std::to_string(radius) + "\" length=\"0.1\"/>";
    };
    const std::string lying = "xyz=\"0 0 0\" rpy=\"1.5708 0 0\"";
    std::string text = link_of("base", small_box);
    CHECK(!load_urdf(folder, text).drive.wheel_radius);
    // A sensor that turns about a vertical axis is no wheel, nor is one that turns about another axis than its own.
    text += link_of("lidar", cylinder(0.02)) +
            axis_joint("scan", "continuous", "base", "lidar", "xyz=\"0 0 1\"", "0 0 1");
    text += link_of("camera", cylinder(0.03)) +
            axis_joint("nod", "continuous", "base", "camera", "xyz=\"1 0 1\"", "0 1 0");
    text += link_of("arm", cylinder(0.04), lying) +
            axis_joint("lift", "revolute", "base", "arm", "xyz=\"0 0 1\"", "0 1 0", "lower=\"-1\" upper=\"1\"");
    CHECK(!load_urdf(folder, text).drive.wheel_radius);
    text += link_of("wheel", cylinder(0.3), lying) +
            axis_joint("roll", "continuous", "base", "wheel", "xyz=\"0 1 0\"", "0 1 0");
    CHECK(load_urdf(folder, text).drive.wheel_radius == 0.3);
    text += link_of("ball", "<sphere radius=\"0.1\"/>") +
            axis_joint("ball_joint", "continuous", "base", "ball", "xyz=\"-1 0 0\"", "1 0 0");
    CHECK(load_urdf(folder, text).drive.wheel_radius == 0.1);
}

TEST_CASE("the mesh of a robot becomes its convex hull, with scale, up axis, rotation and position")
{
    const TempFolder folder;
    // An L of two boxes. The hull fills the inner corner.
    folder.write("l.obj", mesh_text::obj({{.name = "a", .mesh = mesh_text::box({0, 0, 0}, {4, 1, 1})},
                                          {.name = "b", .mesh = mesh_text::box({0, 1, 0}, {1, 3, 1})}}));
    const Robot robot = load_parts(folder, "  - {mesh: l.obj, scale: 0.5, xyz: [10, 0, 0], rpy_deg: [0, 0, 90]}\n");
    REQUIRE(robot.parts.size() == 1);
    const RobotPart& hull = robot.parts[0];
    CHECK(hull.shape.kind == ShapeKind::Hull);
    check_bounds(hull.bounds(), {10 - 1.5, 0, 0}, {10, 2, 0.5});
    CHECK(hull.hull_vertices.size() == 10);  // of 16 corners four are inside faces of the hull and two are shared
    double volume = 0;
    for (const auto& f : hull.hull_faces) {
        const Vec3 a = hull.hull_vertices[std::size_t(f[0])] - hull.centre(),
                   b = hull.hull_vertices[std::size_t(f[1])] - hull.centre(),
                   c = hull.hull_vertices[std::size_t(f[2])] - hull.centre();
        CHECK(a.dot(b.cross(c)) >= 0);  // counterclockwise from outside
        volume += a.dot(b.cross(c)) / 6;
    }
    // The area of (0,0) (4,0) (4,1) (1,3) (0,3) is 9.
    CHECK(volume == Approx(9 * 0.125));
    check_bounds(load_parts(folder, "  - {mesh: l.obj, up: y}\n").bounds(), {0, -1, 0}, {4, 0, 3});
}

TEST_CASE("the hull of a cloud of points contains all of them, and its corners are some of them")
{
    std::vector<Vec3> points;
    for (int i = 0; i < 500; ++i) points.emplace_back(std::sin(i * 1.1), std::sin(i * 1.7 + 1), std::sin(i * 2.3 + 2));
    const RobotPart hull = convex_hull(points);
    double farthest = -1;
    for (const auto& f : hull.hull_faces) {
        const Vec3 a = hull.hull_vertices[std::size_t(f[0])];
        const Vec3 normal =
            (hull.hull_vertices[std::size_t(f[1])] - a).cross(hull.hull_vertices[std::size_t(f[2])] - a);
        if (normal.norm() < 1e-12) continue;
        for (const Vec3& point : points) farthest = std::max(farthest, normal.normalized().dot(point - a));
    }
    CHECK(farthest < 1e-9);
    for (const Vec3& vertex : hull.hull_vertices)
        CHECK(std::find(points.begin(), points.end(), vertex) != points.end());
    std::set<std::pair<int, int>> edges;  // a closed hull has each edge once in each direction
    for (const auto& f : hull.hull_faces)
        for (std::size_t i = 0; i < 3; ++i) CHECK(edges.insert({f[i], f[(i + 1) % 3]}).second);
    for (const auto& [from, to] : edges) CHECK(edges.count({to, from}) == 1);
}

TEST_CASE("a grown hull keeps the margin on every side")
{
    const hand::Mesh cube = hand::box({1, 2, 3});
    const RobotPart hull = grown(convex_hull(cube.vertices), 0.1);
    check_bounds(hull.bounds(), {-0.6, -1.1, -1.6}, {0.6, 1.1, 1.6});
}

TEST_CASE("a URDF is the union of the collision shapes of its links with all joints at zero")
{
    const TempFolder folder;
    const Robot robot = load_urdf(folder, link_of("base", small_box, "xyz=\"0 0 1\"") +
                                              "<link name=\"eye\"><visual><geometry><mesh "
                                              "filename=\"package://none/eye.dae\"/></geometry></visual></link>" +
                                              joint_of("base", "eye", "xyz=\"9 9 9\"") +
                                              link_of("ball", "<sphere radius=\"0.5\"/>") +
                                              joint_of("base", "ball", "xyz=\"0 3 0\""));
    CHECK(robot.name == "test");
    REQUIRE(robot.parts.size() == 2);  // visual shapes do not count
    check_bounds(robot.parts[0].bounds(), {-0.1, -0.2, 0.7}, {0.1, 0.2, 1.3});
    check_bounds(robot.parts[1].bounds(), {-0.5, 2.5, -0.5}, {0.5, 3.5, 0.5});
}

TEST_CASE("the centre of mass of a URDF is that of all its links with the joints at their positions")
{
    const TempFolder folder;
    const auto link = [](const std::string& name, const std::string& mass, const std::string& origin) {
        return "<link name=\"" + name + "\"><inertial><origin xyz=\"" + origin + "\"/><mass value=\"" + mass +
               "\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
               "izz=\"1\"/></inertial><collision><geometry>"
               "<box size=\"1 1 1\"/></geometry></collision></link>\n";
    };
    const std::string arm = link("base", "3", "0 0 0.2") + link("arm", "1", "2 0 0") +
                            axis_joint("turn", "continuous", "base", "arm", "xyz=\"1 0 1\"", "0 0 1") +
                            link_of("empty", "<box size=\"9 9 9\"/>") + joint_of("base", "empty", "xyz=\"5 5 5\"");
    const auto centre = [&](const RobotOptions& options) { return mass_center_of(load_urdf(folder, arm, options)); };
    CHECK((centre({}) - Vec3(0.75, 0, 0.4)).norm() < 1e-12);  // (3 * (0, 0, 0.2) + (3, 0, 1)) / 4
    CHECK((centre({.joints = {{"turn", std::numbers::pi / 2}}}) - Vec3(0.25, 0.5, 0.4)).norm() < 1e-12);
    CHECK(!load_urdf(folder, link_of("base", "<box size=\"1 1 1\"/>")).mass_center);
    CHECK_THROWS_WITH(load_urdf(folder, link("base", "-2", "0 0 0")),
                      Catch::Matchers::Contains("link \"base\": <mass> is -2, needs >= 0 kg"));
}

TEST_CASE("without a centre of mass, that of the volume of all parts counts")
{
    const TempFolder folder;
    const std::string parts =
        "  - {box: [1, 1, 2], xyz: [0, 0, 1]}\n  - {sphere: 0.5, xyz: [3, 0, 0]}\n"
        "  - {cylinder: {radius: 0.5, length: 2}, xyz: [0, 3, 0]}\n"
        "  - {capsule: {radius: 0.5, length: 2}, xyz: [0, -3, 1]}\n";
    const double ball = std::numbers::pi / 6, tube = std::numbers::pi / 2, all = 2 + 2 * ball + 2 * tube;
    const Vec3 sum = 2 * Vec3(0, 0, 1) + ball * Vec3(3, 0, 0) + tube * Vec3(0, 3, 0) + (tube + ball) * Vec3(0, -3, 1);
    CHECK((mass_center_of(load_parts(folder, parts)) - sum / all).norm() < 1e-12);
    CHECK(mass_center_of(load_parts(folder, parts, "mass_center: [1, 2, 3]\n")) == Vec3(1, 2, 3));

    folder.write("wedge.obj", "v 0 0 0\nv 3 0 0\nv 0 3 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    const Robot wedge = load_parts(folder, "  - {mesh: wedge.obj, xyz: [1, 0, 0]}\n");
    CHECK((mass_center_of(wedge) - Vec3(1.75, 0.75, 0.75)).norm() < 1e-9);
}

TEST_CASE("several collisions of one link all count")
{
    const TempFolder folder;
    const Robot robot = load_urdf(
        folder,
        "<link name=\"a\"><collision><origin xyz=\"0 0 0\"/><geometry><box size=\"1 1 1\"/></geometry></collision>"
        "<collision><origin xyz=\"5 0 0\"/><geometry><cylinder radius=\"1\" "
        "length=\"2\"/></geometry></collision></link>");
    REQUIRE(robot.parts.size() == 2);
    CHECK(robot.parts[1].shape.kind == ShapeKind::Cylinder);
    check_bounds(robot.bounds(), {-0.5, -1, -1}, {6, 1, 1});
}

TEST_CASE("origins add up along a chain of joints of any type and limits")
{
    const TempFolder folder;
    const std::string type = GENERATE("fixed", "revolute", "continuous", "prismatic");
    const Robot robot = load_urdf(
        folder,
        "<link name=\"base\"/>" + joint_of("base", "arm", "xyz=\"1 0 0\" rpy=\"0 0 1.5707963267948966\"", type) +
            "<link name=\"arm\"/>" + joint_of("arm", "hand", "xyz=\"2 0 0\" rpy=\"1.5707963267948966 0 0\"", type) +
            link_of("hand", small_box, "xyz=\"0 0 3\" rpy=\"0 0 0\""));
    REQUIRE(robot.parts.size() == 1);
    // In the frame of the hand, x is the base's y, y its z, and z its x. Its origin is at (1, 2, 0), and the centre of
    // the box is 3 further along its z.
    const Pose& pose = robot.parts[0].shape.pose;
    const Vec3 centre = Vec3(1, 2, 0) + 3 * Vec3::UnitX();
    CHECK(pose.position.isApprox(centre, 1e-12));
    CHECK((pose.rotation * Vec3::UnitX()).isApprox(Vec3::UnitY(), 1e-12));
    CHECK((pose.rotation * Vec3::UnitY()).isApprox(Vec3::UnitZ(), 1e-12));
    check_bounds(robot.bounds(), {4 - 0.3, 2 - 0.1, -0.2}, {4 + 0.3, 2 + 0.1, 0.2});
}

TEST_CASE("roll, pitch and yaw of a URDF turn about fixed axes")
{
    const TempFolder folder;
    const Robot robot = load_urdf(folder, link_of("a", small_box, "xyz=\"0 0 0\" rpy=\"0.3 -0.4 2.5\""));
    CHECK(robot.parts[0].shape.pose.rotation.isApprox(rotation_from_rpy(0.3, -0.4, 2.5), 1e-12));
}

TEST_CASE("package:// is found by --model-path first, then by looking upward from the file")
{
    const TempFolder folder;
    folder.write("ws/my_robot/meshes/hull.stl", mesh_text::stl(hand::box({1, 1, 1})));
    folder.write("other/my_robot/meshes/hull.stl", mesh_text::stl(hand::box({3, 3, 3})));
    const std::string text = urdf(
        link_of("a", "<mesh filename=\"package://my_robot/meshes/hull.stl\" scale=\"2 1 1\"/>"));
    const auto inside = folder.write("ws/my_robot/urdf/deep/robot.urdf", text),
               outside = folder.write("robot.urdf", text);
    check_bounds(load_robot(inside.string()).bounds(), {-1, -0.5, -0.5}, {1, 0.5, 0.5});
    check_bounds(load_robot(outside.string(), {{folder / "ws"}}).bounds(), {-1, -0.5, -0.5}, {1, 0.5, 0.5});
    check_bounds(load_robot(inside.string(), {{folder / "none", folder / "other"}}).bounds(), {-3, -1.5, -1.5},
                 {3, 1.5, 1.5});
    CHECK_THROWS_WITH(
        load_robot(outside.string()),
        outside.string() +
            ": link \"a\": <mesh> package://my_robot/meshes/hull.stl was not found beside the file, "
            "in --model-path, in GZ_SIM_RESOURCE_PATH, in GAZEBO_MODEL_PATH or in the folders above the file; "
            "add its folder to --model-path or fix the URI");
}

TEST_CASE("file:// and relative mesh names work, too; COLLADA's unit applies, its up axis does not")
{
    const TempFolder folder;
    const auto file = folder.write(
        "meshes/a.dae", mesh_text::dae({{.mesh = mesh_text::box({0, 0, 0}, {1, 2, 3})}}, {.up = "Y_UP", .unit = 0.1}));
    for (const std::string& name : {"file://" + file.string(), std::string("meshes/a.dae")})
        check_bounds(load_urdf(folder, link_of("a", "<mesh filename=\"" + name + "\"/>")).bounds(), {0, 0, 0},
                     {0.1, 0.2, 0.3}, 1e-7);
}

TEST_CASE("a robot that cannot be used is refused by file, place, value and limit")
{
    const TempFolder folder;
    folder.write("flat.obj", mesh_text::obj(hand::rectangle(1, 1)));
    const std::string yaml = (folder / "robot.yaml").string(), xml = (folder / "robot.urdf").string();
    const std::pair<std::string, std::string> parts[] = {
        {"  - {box: [1, 0, 1]}\n", "part 1: box has 0, needs > 0 (line 4)"},
        {"  - {box: [1, 1, 1]}\n  - {sphere: .nan}\n", "part 2: sphere is .nan, needs a finite number (line 5)"},
        {"  - {box: [1, 1, 1], colour: red}\n",
         "part 1: colour is not a known key; known keys: name, xyz, rpy, rpy_deg, box (line 4)"},
        {"  - {name: a}\n", "part 1: has no geometry, needs one of box, sphere, cylinder, capsule, mesh (line 4)"},
        {"  - {box: [1, 1, 1], sphere: 1}\n",
         "part 1: sphere is given together with box, needs one geometry per part (line 4)"},
        {"  []\n", "parts is empty, needs at least one part (line 3)"},
        {"  - {mesh: none.stl}\n", "part 1: mesh cannot be used: " + (folder / "none.stl").string() +
                                       ": does not exist; is the path right? (line 4)"},
        {"  - {mesh: flat.obj, up: x}\n", "part 1: up is \"x\", needs one of y, z (line 4)"},
        {"  - {mesh: flat.obj}\n", "part 1: mesh cannot be used: " + (folder / "flat.obj").string() +
                                       ": its convex hull has no volume: its points lie in a plane (line 4)"},
        {"  - {sphere: 1}\ncontacts: [[1, 2]]\n", "contacts has 2 numbers, needs 3 (line 5)"},
        {"  - {sphere: 1}\ndrive: tank\n", "drive is \"tank\", needs one of differential, omni, legged, car (line 5)"},
        {"  - {sphere: 1}\ndrive: car\n",
         "drive is car, which needs turning_radius: the smallest radius of its curves, m (line 5)"},
        {"  - {sphere: 1}\ndrive: legged\n",
         "drive is legged, which needs max_step: the largest step that it climbs, m (line 5)"},
        {"  - {sphere: 1}\nturning_radius: 2\n", "turning_radius is only for drive: car (line 5)"},
        {"  - {sphere: 1}\nmax_step: -1\n", "max_step is -1, needs >= 0 m (line 5)"},
        {"  - {sphere: 1}\nwheel_radius: 0\n", "wheel_radius is 0, needs > 0 (line 5)"},
    };
    for (const auto& [text, wanted] : parts) CHECK_THROWS_WITH(load_parts(folder, text), yaml + ": " + wanted);

    const std::string tree = "; the links of a robot form a tree: each is the child of one joint, except the root";
    const std::pair<std::string, std::string> links[] = {
        {"<link name=\"a\"/>", "has no <collision>, needs at least one (<visual> elements are not used)"},
        {link_of("a", "<box size=\"1 0 1\"/>"), "link \"a\": <box size> is 0, needs > 0"},
        {link_of("a", "<sphere radius=\"-0.5\"/>"), "link \"a\": <sphere radius> is -0.5, needs > 0"},
        {link_of("a", "<cylinder radius=\"1\" length=\"0\"/>"), "link \"a\": <cylinder> is 0, needs > 0"},
        {link_of("a", "<mesh filename=\"none.stl\"/>"),
         "link \"a\": <mesh> none.stl was not found beside the file, in --model-path, in GZ_SIM_RESOURCE_PATH, "
         "in GAZEBO_MODEL_PATH or in the folders above the file; add its folder to --model-path or fix the URI"},
        {link_of("a", "<mesh filename=\"flat.obj\"/>"),
         "link \"a\": <mesh> cannot be used: " + (folder / "flat.obj").string() +
             ": its convex hull has no volume: its points lie in a plane"},
        {"<link", "line 3: is not valid XML (xml error parsing element): is a tag not closed, or misspelt?"},
        {link_of("a", small_box + "<sphere radius=\"9\"/>"),
         "line 3: <geometry> contains 2 shapes, needs one; give each a <collision> of its own"},
        {link_of("a", small_box) + link_of("b", small_box) +
             "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/><origin xyz=\"0 0 0\" "
             "quat_xyzw=\"0 0 1 0\"/></joint>",
         "line 5: <origin quat_xyzw> cannot be read here; write the rotation as rpy"},
        {link_of("a", small_box) + link_of("b", small_box) + joint_of("a", "b", "xyz=\"0 0 0\"") +
             "<joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>",
         "line 6: joint \"k\": link \"b\" is already the child of joint \"a_b\"" + tree},
        {link_of("a", small_box) + "<joint name=\"k\" type=\"fixed\"><parent link=\"a\"/><child link=\"a\"/></joint>",
         "line 4: joint \"k\": link \"a\" is in a cycle of joints" + tree},
        // Link c is joined to a cycle of a and b beside a tree of one link.
        {link_of("root", small_box) + link_of("a", small_box) + link_of("b", small_box) + link_of("c", small_box) +
             joint_of("a", "b", "xyz=\"0 0 0\"") + joint_of("b", "a", "xyz=\"0 0 0\"") +
             joint_of("a", "c", "xyz=\"0 0 0\""),
         "line 8: joint \"b_a\": link \"a\" is in a cycle of joints" + tree},
        {link_of("a", small_box) + link_of("b", small_box),
         "is not valid URDF: Failed to find root link: Two root links found: [a] and [b]"},
        {link_of("a", "<box size=\"1 x 1\"/>"),
         "is not valid URDF: Unable to parse component [x] to a double (while parsing a vector value)"},
        {link_of("a", "<box size=\"1 nan 1\"/>"),
         "is not valid URDF: Unable to parse component [nan] to a double (while parsing a vector value)"},
        // urdfdom alone would drop the box of the link because of this, and continue.
        {"<link name=\"a\"><inertial><mass value=\"x\"/></inertial><collision><geometry>" + small_box +
             "</geometry></collision></link>" + link_of("b", small_box) + joint_of("a", "b", "xyz=\"0 0 0\""),
         "is not valid URDF: Inertial: mass [x] is not a float"},
    };
    for (const auto& [text, wanted] : links) CHECK_THROWS_WITH(load_urdf(folder, text), xml + ": " + wanted);

    CHECK_THROWS_WITH(load_urdf(folder, "<xacro:property name=\"a\" value=\"1\"/>"),
                      xml + ": contains xacro macros; expand them first: xacro robot.urdf > robot.urdf");
    const auto xacro = folder.write("husky.urdf.xacro", "");
    CHECK_THROWS_WITH(
        load_robot(xacro.string()),
        xacro.string() +
            ": is a xacro file, which cannot be read here; expand it first: xacro husky.urdf.xacro > robot.urdf");

    CHECK_THROWS_WITH(load_robot((folder / "none.yaml").string()),
                      (folder / "none.yaml").string() +
                          ": does not exist; a robot is a robot.yaml, a .urdf, an SDF model (.sdf or its folder) or "
                          "box:LX,LY,LZ[@x,y,z]");
    const auto odd = folder.write("robot.txt", "");
    CHECK_THROWS_WITH(load_robot(odd.string()),
                      odd.string() +
                          ": is not in a known robot format; a robot is a robot.yaml, a .urdf, an SDF "
                          "model (.sdf or its folder) or box:LX,LY,LZ[@x,y,z]");
}

TEST_CASE("joints rotate and move the links behind them, about their own axes")
{
    const TempFolder folder;
    const std::string arm = "<link name=\"base\"/>" +
                            axis_joint("turn", "continuous", "base", "arm", "xyz=\"1 0 0\"", "0 0 2") +
                            "<link name=\"arm\"/>" +
                            axis_joint("slide", "prismatic", "arm", "hand", "xyz=\"1 0 0\"", "1 0 0",
                                       "lower=\"-1\" upper=\"0.5\"") +
                            link_of("hand", small_box);
    // The arm points along y from (1, 0, 0), and the hand slides along it.
    const Robot robot = load_urdf(folder, arm, {.joints = {{"turn", std::numbers::pi / 2}, {"slide", 0.5}}});
    check_bounds(robot.bounds(), {1 - 0.2, 1.5 - 0.1, -0.3}, {1 + 0.2, 1.5 + 0.1, 0.3});
    check_bounds(load_urdf(folder, arm).bounds(), {2 - 0.1, -0.2, -0.3}, {2 + 0.1, 0.2, 0.3});
    CHECK(robot.parts[0].name == "hand");
    CHECK(robot.notices.empty());
}

TEST_CASE("a joint that mimics another follows it, with a notice if that exceeds its limits")
{
    const TempFolder folder;
    const std::string limits = "lower=\"-1\" upper=\"1\"";
    const std::string arm = "<link name=\"base\"/>" +
                            axis_joint("a", "prismatic", "base", "left", "xyz=\"0 0 0\"", "1 0 0", limits) +
                            link_of("left", small_box) +
                            axis_joint("b", "prismatic", "base", "right", "xyz=\"0 0 0\"", "0 1 0", limits,
                                       "<mimic joint=\"a\" multiplier=\"-3\" offset=\"0.5\"/>") +
                            link_of("right", small_box);
    const Robot robot = load_urdf(folder, arm, {.joints = {{"a", 1}}});
    check_bounds(robot.parts[0].bounds(), {0.9, -0.2, -0.3}, {1.1, 0.2, 0.3});
    check_bounds(robot.parts[1].bounds(), {-0.1, -2.7, -0.3}, {0.1, -2.3, 0.3});
    REQUIRE(robot.notices.size() == 1);
    CHECK(robot.notices[0] == (folder / "robot.urdf").string() +
                                  ": joint \"b\" is at -2.5 m, because it mimics \"a\", outside its limits -1 to 1 m");
}

TEST_CASE("impossible joint positions are refused with the allowed values")
{
    const TempFolder folder;
    const std::string limits = "lower=\"0.5\" upper=\"1\"", file = (folder / "robot.urdf").string();
    const std::string robot =
        link_of("base", small_box) + axis_joint("turn", "revolute", "base", "a", "xyz=\"0 0 0\"", "0 0 1", limits) +
        "<link name=\"a\"/>" + axis_joint("glue", "fixed", "base", "b", "xyz=\"0 0 0\"", "0 0 1") +
        "<link name=\"b\"/>" + axis_joint("free", "floating", "base", "c", "xyz=\"0 0 0\"", "0 0 1") +
        "<link name=\"c\"/>" +
        axis_joint("wheel", "continuous", "base", "d", "xyz=\"0 0 0\"", "0 0 1", "", "<mimic joint=\"turn\"/>") +
        "<link name=\"d\"/>";
    const std::pair<JointPosition, std::string> cases[] = {
        {{"tern", 0.7}, "joint \"tern\" is not in " + file + "; joints that can be moved: turn"},
        {{"glue", 0}, "joint \"glue\" is fixed in " + file + "; joints that can be moved: turn"},
        {{"free", 0},
         "joint \"free\" is of type floating, which cannot be moved by one number; joints that can be moved: turn"},
        {{"wheel", 0}, "joint \"wheel\" mimics joint \"turn\"; give that one instead"},
        {{"turn", 1.25}, "joint \"turn\" is 1.25, outside its limits in " + file + ", 0.5 to 1 rad"},
        {{"turn", NAN}, "joint \"turn\" is nan, needs a finite number"},
    };
    for (const auto& [joint, wanted] : cases) {
        CHECK_THROWS_AS(load_urdf(folder, robot, {.joints = {joint}}), ArgumentError);
        CHECK_THROWS_WITH(load_urdf(folder, robot, {.joints = {joint}}), "load_robot: " + wanted);
    }
    CHECK_THROWS_WITH(load_urdf(folder, robot, {.joints = {{"turn", 0.5}, {"turn", 0.6}}}),
                      "load_robot: joint \"turn\" is given twice");
    CHECK_THROWS_WITH(load_robot("box:1,1,1", {.joints = {{"a", 1}}}),
                      "load_robot: joint \"a\" is given, but box:1,1,1 has no joints");
    const Robot at_zero = load_urdf(folder, robot);
    REQUIRE(at_zero.notices.size() == 1);
    CHECK(at_zero.notices[0] == file + ": joint \"turn\" is at 0 rad, outside its limits 0.5 to 1 rad");
}

TEST_CASE("joints that mimic nothing or themselves get a notice")
{
    const TempFolder folder;
    const auto with_mimic = [&](const std::string& of) {
        return link_of("base", small_box) +
               axis_joint("a", "continuous", "base", "x", "xyz=\"0 0 0\"", "0 0 1", "",
                          "<mimic joint=\"" + of + "\"/>") +
               "<link name=\"x\"/>";
    };
    const std::string file = (folder / "robot.urdf").string();
    CHECK_THROWS_WITH(load_urdf(folder, with_mimic("q")), file + ": joint \"a\" mimics \"q\", which is not a joint");
    CHECK_THROWS_WITH(load_urdf(folder, with_mimic("a")), file + ": joint \"a\" mimics itself");
}

TEST_CASE("a long chain of joints that mimic each other is followed once")
{
    const TempFolder folder;
    constexpr int joints = 5000;
    std::string arm = link_of("base", small_box);
    for (int k = 0; k < joints; ++k) {
        const std::string name = "j" + std::to_string(k), link = "l" + std::to_string(k);
        arm += "<link name=\"" + link + "\"/>" +
               axis_joint(name, "continuous", "base", link, "xyz=\"0 0 0\"", "0 0 1", "",
                          k == 0 ? "" : "<mimic joint=\"j" + std::to_string(k - 1) + "\"/>");
    }
    CHECK(load_urdf(folder, arm, {.joints = {{"j0", 1}}}).parts.size() == 1);
}

TEST_CASE("a notice states how much larger the hull is than its mesh, or that this is unknown")
{
    const TempFolder folder;
    hand::Mesh open = mesh_text::box({0, 0, 0}, {1, 1, 1});
    open.triangles.pop_back();
    folder.write("l.obj", mesh_text::obj({{.name = "a", .mesh = mesh_text::box({0, 0, 0}, {4, 1, 1})},
                                          {.name = "b", .mesh = mesh_text::box({0, 1, 0}, {1, 3, 1})}}));
    folder.write("open.obj", mesh_text::obj(open));
    folder.write("box.obj", mesh_text::obj(mesh_text::box({0, 0, 0}, {1, 1, 1})));
    const Robot robot = load_parts(
        folder, "  - {mesh: l.obj, name: bend, scale: 2}\n  - {mesh: open.obj}\n  - {mesh: box.obj}\n");
    REQUIRE(robot.meshes.size() == 3);
    CHECK(*robot.meshes[0].mesh_volume == Approx(6 * 8));
    CHECK(robot.meshes[0].volume == Approx(9 * 8));
    CHECK(*robot.meshes[0].growth() == Approx(0.5));
    CHECK_FALSE(robot.meshes[1].growth());
    CHECK(*robot.meshes[2].growth() == Approx(0).margin(1e-9));
    const std::string file = (folder / "robot.yaml").string() + ": ";
    REQUIRE(robot.notices.size() == 2);
    CHECK(robot.notices[0] == file + "\"bend\": l.obj is replaced by its convex hull, 72 m3, 50 % more than the mesh");
    CHECK(robot.notices[1] == file +
                                  "open.obj is replaced by its convex hull, 1 m3; the mesh's own volume is unknown, "
                                  "because the mesh is not watertight or overlaps itself");
}

TEST_CASE("a far too large robot is refused, a chain longer than the call stack is not")
{
    CHECK_THROWS_WITH(load_robot("box:1e10,1,1"),
                      "box:1e10,1,1: reaches 5e+09 m from its origin, needs at most 1000 "
                      "m; is it in millimetres or centimetres? divide its lengths by 1000 or 100");
    CHECK(load_robot("box:2000,1,1@0,0,0.5").parts.size() == 1);
    const TempFolder folder;
    const std::string box = "<collision><geometry><box size='1 1 1'/></geometry></collision>";
    std::string chain = "<robot name='snake'>\n<link name='l0'>" + box + "</link>";
    constexpr int links = 20000;
    for (int i = 1; i <= links; ++i)
        chain += "<link name='l" + std::to_string(i) + "'/><joint name='j" + std::to_string(i) +
                 "' type='fixed'><origin xyz='0.01 0 0'/><parent link='l" + std::to_string(i - 1) +
                 "'/><child link='l" + std::to_string(i) + "'/></joint>";
    chain += "<link name='tail'>" + box + "</link><joint name='t' type='fixed'><parent link='l" +
             std::to_string(links) + "'/><child link='tail'/></joint></robot>";
    CHECK(load_robot(folder.write("snake.urdf", chain).string()).bounds().max.x() == Approx(200.5));
    CHECK_THROWS_WITH(
        load_robot(folder.write("torn.urdf", "<robot name='a'>\n<link name='b'>\n</robot>").string()),
        (folder / "torn.urdf").string() +
            ": line 2: is not valid XML (xml error mismatched element): is a tag not closed, or misspelt?");
    std::string deep = "<robot name='a'>";
    for (int i = 0; i < 50000; ++i) deep += "<a>";
    CHECK_THROWS_WITH(load_robot(folder.write("deep.urdf", deep).string()),
                      Catch::Contains("elements may be nested at most 500 deep"));
    CHECK(load_robot(folder.write("BIG.URDF", "<robot name='a'><link name='l'>" + box + "</link></robot>").string())
              .parts.size() == 1);
}

TEST_CASE("real robots have the bounds that their sources document", "[real]")
{
    const auto shared = shared_scenes();
    if (!shared) return;
    struct Wanted {
        const char* file;
        Vec3 min, max;
        std::size_t boxes, spheres, cylinders, hulls;
    };
    const Wanted robots[] = {
        {"robot_husky/husky_description/urdf/husky.urdf", {-0.494, -0.343, -0.132}, {0.494, 0.343, 0.251}, 2, 0, 4, 1},
        {"robot_jackal/jackal_description/urdf/jackal.urdf",
         {-0.229, -0.208, -0.064},
         {0.229, 0.208, 0.184},
         1,
         0,
         4,
         0},
        {"robot_turtlebot3/turtlebot3_description/urdf/turtlebot3_burger.urdf",
         {-0.102, -0.089, 0},
         {0.038, 0.089, 0.191},
         2,
         0,
         3,
         0},
        {"robot_turtlebot3/turtlebot3_description/urdf/turtlebot3_waffle.urdf",
         {-0.197, -0.153, 0},
         {0.073, 0.153, 0.141},
         4,
         0,
         3,
         0},
        {"robot_anymal_c/anymal_c_simple_description/urdf/anymal.urdf",
         {-0.525, -0.331, -0.630},
         {0.525, 0.331, 0.194},
         12,
         4,
         29,
         0},
    };
    for (const Wanted& wanted : robots) {
        INFO(wanted.file);
        const Robot robot = load_robot((*shared / wanted.file).string());
        check_bounds(robot.bounds(), wanted.min, wanted.max, 1e-3);
        const auto count = [&](ShapeKind kind) {
            return std::size_t(std::count_if(robot.parts.begin(), robot.parts.end(),
                                             [&](const auto& p) { return p.shape.kind == kind; }));
        };
        CHECK(count(ShapeKind::Box) == wanted.boxes);
        CHECK(count(ShapeKind::Sphere) == wanted.spheres);
        CHECK(count(ShapeKind::Cylinder) == wanted.cylinders);
        CHECK(count(ShapeKind::Hull) == wanted.hulls);
    }
}

#include "catch.h"
#include "check_bounds.h"
#include "mesh_text.h"
#include "robot/convex_split.h"
#include "robot/ellipsoid.h"
#include "shared_scenes.h"
#include "temp_folder.h"

#include <spawnfield/error.h>
#include <spawnfield/robot.h>

#include <Eigen/Geometry>

#include <numbers>
#include <random>

using namespace spawnfield;

namespace {

std::string sdf_of(const std::string& inside)
{
    return "<sdf version=\"1.9\">\n<model name=\"test\">\n" + inside + "\n</model>\n</sdf>\n";
}

std::string collision(const std::string& geometry, const std::string& pose = "0 0 0 0 0 0",
                      const std::string& name = "c")
{
    return "<collision name=\"" + name + "\"><pose>" + pose + "</pose><geometry>" + geometry +
           "</geometry></collision>\n";
}

std::string link_of(const std::string& name, const std::string& inside,
                    const std::string& pose = "<pose>0 0 0 0 0 0</pose>")
{
    return "<link name=\"" + name + "\">" + pose + inside + "</link>\n";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& inside)
{
    return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent>" + parent + "</parent><child>" + child +
           "</child>" + inside + "</joint>\n";
}

Robot load(const TempFolder& folder, const std::string& inside, const RobotOptions& options = {})
{
    return load_robot(folder.write("robot.sdf", sdf_of(inside)).string(), options);
}

const std::string small_box = "<box><size>0.2 0.4 0.6</size></box>";

}  // namespace

TEST_CASE("the centre of mass of an SDF model is that of the links that have an <inertial>")
{
    const TempFolder folder;
    const auto inertial = [](const std::string& mass, const std::string& pose) {
        return "<inertial><pose>" + pose + "</pose><mass>" + mass + "</mass></inertial>";
    };
    const std::string links = link_of("base", inertial("3", "0 0 0.2 0 0 0") + collision(small_box)) +
                              link_of("arm", inertial("1", "2 0 0 0 0 0"), "<pose>1 0 1 0 0 0</pose>") +
                              link_of("plain", collision(small_box), "<pose>9 9 9 0 0 0</pose>") +
                              joint("turn", "revolute", "base", "arm", "<axis><xyz>0 0 1</xyz></axis>");
    REQUIRE(load(folder, links).mass_center.has_value());
    CHECK((*load(folder, links).mass_center - Vec3(0.75, 0, 0.4)).norm() < 1e-12);
    const Robot turned = load(folder, links, {.joints = {{"turn", std::numbers::pi / 2}}});
    CHECK((*turned.mass_center - Vec3(0.25, 0.5, 0.4)).norm() < 1e-12);
    CHECK(!load(folder, link_of("base", collision(small_box))).mass_center);
}

TEST_CASE("an SDF model is the union of the collisions of its links in its own frame, independent of its <pose>")
{
    const TempFolder folder;
    const Robot robot = load(
        folder,
        "<pose>9 9 9 0 0 1</pose>" + link_of("base", collision(small_box, "0 0 1 0 0 0")) +
            link_of("ball", collision("<sphere><radius>0.5</radius></sphere>"), "<pose>0 3 0 0 0 0</pose>") +
            link_of("rod",
                    collision("<cylinder><radius>0.1</radius><length>2</length></cylinder>",
                              "0 0 0 1.5707963267948966 0 0") +
                        collision("<capsule><radius>0.25</radius><length>1</length></capsule>", "5 0 0 0 0 0", "d"),
                    "<pose relative_to='ball'>0 0 3 0 0 0</pose>"));
    CHECK(robot.name == "test");
    REQUIRE(robot.parts.size() == 4);
    check_bounds(robot.parts[0].bounds(), {-0.1, -0.2, 0.7}, {0.1, 0.2, 1.3});
    check_bounds(robot.parts[1].bounds(), {-0.5, 2.5, -0.5}, {0.5, 3.5, 0.5});
    check_bounds(robot.parts[2].bounds(), {-0.1, 2, 2.9}, {0.1, 4, 3.1});
    check_bounds(robot.parts[3].bounds(), {4.75, 2.75, 2.25}, {5.25, 3.25, 3.75});
    CHECK(robot.parts[3].name == "rod");
    REQUIRE(robot.notices.size() == 1);
    CHECK(robot.notices[0] ==
          (folder / "robot.sdf").string() + ": the <pose> of model \"test\" is ignored: poses are in its own frame");
}

TEST_CASE("frames and nested models add up")
{
    const TempFolder folder;
    const Robot robot = load(folder, "<frame name='mount'><pose>1 0 0 0 0 1.5707963267948966</pose></frame>" +
                                         link_of("base", "") +
                                         "<model name='arm'><pose relative_to='mount'>1 0 0 0 0 0</pose>" +
                                         link_of("hand", collision(small_box, "1 0 0 0 0 0")) + "</model>");
    REQUIRE(robot.parts.size() == 1);
    CHECK(robot.parts[0].name == "arm::hand");
    check_bounds(robot.bounds(), {1 - 0.2, 2 - 0.1, -0.3}, {1 + 0.2, 2 + 0.1, 0.3});
}

TEST_CASE("models are included from --model-path, from beside the file, and through one another")
{
    const TempFolder folder;
    const std::string config = "<model><name>x</name><sdf version='1.9'>model.sdf</sdf></model>";
    folder.write("lib/wheel/model.config", config);
    folder.write("lib/wheel/model.sdf", "<sdf version='1.9'><model name='wheel'>" +
                                            link_of("rim", collision("<mesh><uri>model://wheel/rim.obj</uri></mesh>")) +
                                            "</model></sdf>");
    folder.write("lib/wheel/rim.obj", mesh_text::obj(hand::box({1, 1, 1})));
    folder.write("lib/axle/model.config", config);
    folder.write("lib/axle/model.sdf",
                 "<sdf version='1.9'><model name='axle'>" + link_of("rod", "") +
                     "<include><uri>model://wheel</uri><name>w</name><pose>0 2 0 0 0 0</pose></include></model></sdf>");
    const std::string inside = link_of("base", "") +
                               "<include><uri>model://axle</uri><pose>0 0 1 0 0 0</pose></include>";
    const Robot robot = load(folder, inside, {.model_paths = {folder / "lib"}});
    REQUIRE(robot.parts.size() == 1);
    CHECK(robot.parts[0].name == "axle::w::rim");
    check_bounds(robot.bounds(), {-0.5, 1.5, 0.5}, {0.5, 2.5, 1.5});
    // The folder itself is loaded. Its neighbours are found because they are in the same folder above.
    check_bounds(load_robot((folder / "lib/axle").string()).bounds(), {-0.5, 1.5, -0.5}, {0.5, 2.5, 0.5});
    CHECK_THROWS_WITH(
        load(folder, inside),
        Catch::Contains("model://axle") &&
            Catch::Contains(
                "; give the folder of the models with --model-path, GZ_SIM_RESOURCE_PATH or GAZEBO_MODEL_PATH") &&
            Catch::StartsWith((folder / "robot.sdf").string() + ": "));
}

TEST_CASE("models that include each other without end are refused, the same model twice is not")
{
    const TempFolder folder;
    for (const std::string name : {"a", "b"}) {
        folder.write(name + "/model.config", "<model><name>x</name><sdf version='1.9'>model.sdf</sdf></model>");
        const std::string other = name == "a" ? "b" : "a";
        folder.write(name + "/model.sdf", "<sdf version='1.9'><model name='" + name + "'>" +
                                              link_of("l", collision(small_box)) + "<include><uri> model://" + other +
                                              " </uri></include></model></sdf>");
    }
    const auto canonical = [&](const std::string& name) {
        return std::filesystem::canonical(folder / name / "model.sdf").string();
    };
    CHECK_THROWS_WITH(load_robot((folder / "a").string()),
                      Catch::Contains("model://a: includes itself: " + canonical("a") + " includes " + canonical("b") +
                                      " includes " + canonical("a")));
    folder.write("b/model.sdf", "<sdf version='1.9'><model name='b'>" + link_of("l", collision(small_box)) +
                                    "<!-- <include><uri>model://a</uri></include> --></model></sdf>");
    folder.write("a/model.sdf", "<sdf version='1.9'><model name='a'>" + link_of("l", "") +
                                    "<include><uri>model://b</uri></include><include><uri>model://b</uri><name>c</name>"
                                    "<pose>1 0 0 0 0 0</pose></include></model></sdf>");
    CHECK(load_robot((folder / "a").string()).parts.size() == 2);
}

TEST_CASE("SDF joints move the links behind them, and the canonical link does not move")
{
    const TempFolder folder;
    const std::string turn = joint("turn", "revolute", "base", "arm",
                                   "<pose relative_to='base'>1 0 0 0 0 0</pose><axis><xyz>0 0 "
                                   "1</xyz><limit><lower>-2</lower><upper>2</upper></limit></axis>");
    const std::string slide = joint(
        "slide", "prismatic", "arm", "hand",
        "<axis><xyz expressed_in='__model__'>0 0 1</xyz><limit><lower>0</lower><upper>1</upper></limit></axis>");
    const std::string arm = link_of("arm", "", "<pose>2 0 0 0 0 0</pose>"),
                      hand_link = link_of("hand", collision(small_box), "<pose>3 0 0 0.5 0 0</pose>");
    const std::string all = link_of("base", collision("<sphere><radius>0.1</radius></sphere>")) + arm + hand_link +
                            turn + slide;
    const Robot robot = load(folder, all, {.joints = {{"turn", std::numbers::pi / 2}, {"slide", 1}}});
    CHECK(robot.parts[1].centre().isApprox(Vec3(1, 2, 1), 1e-9));
    CHECK(load(folder, all).parts[1].centre().isApprox(Vec3(3, 0, 0), 1e-9));
    // In the frame of the hand, the base moves.
    const Robot seen = load(
        folder, hand_link + arm + link_of("base", collision("<sphere><radius>0.1</radius></sphere>")) + turn + slide,
        {.joints = {{"turn", std::numbers::pi / 2}}});
    CHECK(seen.parts[0].centre().isApprox(Vec3(3, 0, 0), 1e-9));
    CHECK(seen.parts[1].centre().isApprox(Vec3(1, 1, 0), 1e-9));

    const std::string file = (folder / "robot.sdf").string();
    CHECK_THROWS_WITH(load(folder, all, {.joints = {{"turn", 3}}}),
                      "load_robot: joint \"turn\" is 3, outside its limits in " + file + ", -2 to 2 rad");
    CHECK_THROWS_WITH(load(folder, all, {.joints = {{"arm", 3}}}),
                      "load_robot: joint \"arm\" is not in " + file + "; joints that can be moved: turn, slide");
    const std::string loop = joint("loop", "fixed", "base", "hand", "");
    CHECK_THROWS_WITH(load(folder, all + loop, {.joints = {{"turn", 1}}}),
                      file + ": joints cannot be given: link \"hand\" is in a closed chain of joints");
    check_bounds(load(folder, all + loop).bounds(), load(folder, all).bounds().min, load(folder, all).bounds().max);
}

TEST_CASE("meshes of SDF use scale, submesh, centre and COLLADA's unit, but not its up axis")
{
    const TempFolder folder;
    folder.write("two.obj", mesh_text::obj({{.name = "left", .mesh = mesh_text::box({0, 0, 0}, {1, 1, 1})},
                                            {.name = "right", .mesh = mesh_text::box({4, 4, 4}, {5, 6, 7})}}));
    folder.write("cm.dae",
                 mesh_text::dae({{.mesh = mesh_text::box({0, 0, 0}, {1, 2, 3})}}, {.up = "Y_UP", .unit = 0.1}));
    const auto bounds = [&](const std::string& mesh, const std::string& pose = "0 0 0 0 0 0") {
        return load(folder, link_of("a", collision("<mesh>" + mesh + "</mesh>", pose))).bounds();
    };
    check_bounds(bounds("<uri>two.obj</uri><scale>2 1 1</scale>"), {0, 0, 0}, {10, 6, 7});
    check_bounds(bounds("<uri>two.obj</uri><submesh><name>right</name></submesh>"), {4, 4, 4}, {5, 6, 7});
    check_bounds(bounds("<uri>two.obj</uri><submesh><name>right</name><center>true</center></submesh>", "0 0 9 0 0 0"),
                 {-0.5, -1, 7.5}, {0.5, 1, 10.5});
    check_bounds(bounds("<uri>cm.dae</uri>"), {0, 0, 0}, {0.1, 0.2, 0.3}, 1e-7);
    check_bounds(bounds("<uri>file://" + (folder / "two.obj").string() + "</uri>"), {0, 0, 0}, {5, 6, 7});
    CHECK_THROWS_WITH(bounds("<uri>two.obj</uri><submesh><name>up</name></submesh>"),
                      Catch::Contains("two.obj: has no submesh \"up\"; its nodes are left, right"));
}

TEST_CASE("the polyhedron of an ellipsoid contains it, with little extra space")
{
    const Vec3 radii(1, 0.5, 0.25);
    const Pose pose{Vec3(1, 2, 3), rotation_from_rpy(0.3, -0.4, 2)};
    const RobotPart hull = ellipsoid_hull(radii, pose);
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    double farthest = -1;
    for (int k = 0; k < 2000; ++k) {
        const Vec3 point = pose.rotation *
                               Vec3{normal(random), normal(random), normal(random)}.normalized().cwiseProduct(radii) +
                           pose.position;
        for (const auto& f : hull.hull_faces) {
            const Vec3 a = hull.hull_vertices[std::size_t(f[0])];
            const Vec3 outwards = (hull.hull_vertices[std::size_t(f[1])] - a)
                                      .cross(hull.hull_vertices[std::size_t(f[2])] - a)
                                      .normalized();
            farthest = std::max(farthest, outwards.dot(point - a));
        }
    }
    CHECK(farthest < 1e-12);
    CHECK(farthest > -1e-3);
    CHECK(ellipsoid_growth(hull, radii) > 0);
    CHECK(ellipsoid_growth(hull, radii) < 0.025);
    const TempFolder folder;
    const Robot robot = load(folder, link_of("a", collision("<ellipsoid><radii>1 2 3</radii></ellipsoid>")));
    REQUIRE(robot.notices.size() == 1);
    CHECK_THAT(robot.notices[0],
               Catch::Contains("its ellipsoid is replaced by a polyhedron around it, with 2.0 % more volume"));
}

TEST_CASE("an SDF robot that cannot be used is refused by file, link, collision and line")
{
    const TempFolder folder;
    folder.write("flat.obj", mesh_text::obj(hand::rectangle(1, 1)));
    const std::string file = (folder / "robot.sdf").string() + ": ", in_a = file + "link \"a\": collision \"c\": ";
    const std::pair<std::string, std::string> cases[] = {
        {link_of("a", ""), file + "has no <collision>, needs at least one (<visual> elements are not used)"},
        {link_of("a", collision("<box><size>1 0 1</size></box>")),
         file + "\"a::c\": <box> <size> is 0, needs > 0 and at most 1000 km (line 3)"},
        {link_of("a", collision("<sphere><radius>-1</radius></sphere>")),
         file + "\"a::c\": <sphere> <radius> is -1, needs > 0 and at most 1000 km (line 3)"},
        {link_of("a", collision("<plane><normal>0 0 1</normal></plane>")),
         in_a + "is a <plane>, which a robot cannot have because it is infinite; use a <box> (line 3)"},
        {link_of("a",
                 collision(
                     "<polyline><point>0 0</point><point>1 0</point><point>0 1</point><height>1</height></polyline>")),
         in_a + "is a <polyline>, which is not supported in robots; use a <box> or a <mesh> (line 3)"},
        {link_of("a", collision("<mesh><uri>none.stl</uri></mesh>")),
         in_a + "<mesh> none.stl was not found beside the file, in --model-path, in GZ_SIM_RESOURCE_PATH, "
                "in GAZEBO_MODEL_PATH or in the folders above the file; add its folder to --model-path or fix the URI "
                "(line 3)"},
        {link_of("a", collision("<mesh><uri>flat.obj</uri></mesh>")),
         in_a + "<mesh> cannot be used: " + (folder / "flat.obj").string() +
             ": its convex hull has no volume: its points lie in a plane (line 3)"},
    };
    for (const auto& [text, wanted] : cases) {
        CHECK_THROWS_AS(load(folder, text), FileError);
        CHECK_THROWS_WITH(load(folder, text), wanted);
    }
    const auto refused = [&](const std::string& text) {
        try {
            load_robot(folder.write("robot.sdf", text).string());
            return std::string("taken");
        } catch (const FileError& error) {
            return std::string(error.what());
        }
    };
    CHECK(refused("<sdf version='1.9'><world name='w'/></sdf>") ==
          file + "contains a <world>, needs a <model> to be a robot");
    for (const std::string& text :
         {sdf_of(link_of("a", collision(small_box)) + link_of("a", collision(small_box))), sdf_of("<link"),
          std::string(), sdf_of(link_of("a", collision(small_box), "<pose relative_to='q'/>")),
          sdf_of(link_of("a", collision(small_box), "<pose relative_to='b'/>") +
                 link_of("b", "", "<pose relative_to='a'/>"))}) {
        INFO(text);
        CHECK_THAT(refused(text), Catch::StartsWith(file));
    }
    std::filesystem::create_directories(folder / "empty");
    CHECK_THROWS_WITH(load_robot((folder / "empty").string()),
                      (folder / "empty").string() +
                          ": is a folder without model.config and without a .sdf file, so it is not a model; give the "
                          "folder of a model, or an SDF file");
}

TEST_CASE("every prefix of an SDF robot is read or refused")
{
    const TempFolder folder;
    const std::string whole = sdf_of(link_of("a", collision(small_box)) +
                                     link_of("b", collision(small_box), "<pose>1 0 0 0 0 0</pose>") +
                                     joint("j", "revolute", "a", "b", "<axis><xyz>0 0 1</xyz></axis>"));
    for (std::size_t length = 0; length < whole.size(); length += 23) {
        const auto file = folder.write("robot.sdf", whole.substr(0, length));
        CHECK_THROWS_AS(load_robot(file.string()), FileError);
    }
}

TEST_CASE("an SDF model with an impossible inertia is accepted, with a notice")
{
    const TempFolder folder;
    const std::string inertia =
        "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>9</izz></inertia></inertial>";
    const Robot robot = load(folder, link_of("a", inertia + collision(small_box)) + link_of("b", inertia));
    REQUIRE(robot.notices.size() == 1);
    CHECK_THAT(robot.notices[0], Catch::Contains("invalid inertia") && Catch::Contains("and 1 more of this kind"));
}

namespace {

std::vector<Corners> triangles_of(const hand::Mesh& mesh, const Vec3& shift = Vec3::Zero())
{
    std::vector<Corners> out;
    for (const auto& t : mesh.triangles)
        out.push_back({mesh.vertices[t[0]] + shift, mesh.vertices[t[1]] + shift, mesh.vertices[t[2]] + shift});
    return out;
}

double distance_out(const RobotPart& hull, const Vec3& point)
{
    double out = -1e9;
    for (const auto& f : hull.hull_faces) {
        const Vec3 a = hull.hull_vertices[std::size_t(f[0])];
        const Vec3 normal =
            (hull.hull_vertices[std::size_t(f[1])] - a).cross(hull.hull_vertices[std::size_t(f[2])] - a);
        if (normal.norm() > 1e-9) out = std::max(out, normal.normalized().dot(point - a));
    }
    return out;
}

bool is_held(const std::vector<RobotPart>& parts, const Vec3& point)
{
    double least = 1e9;
    for (const RobotPart& part : parts) least = std::min(least, distance_out(part, point));
    if (least >= 1e-9) UNSCOPED_INFO("outside by " << least);
    return least < 1e-9;
}

double volume_of(const std::vector<RobotPart>& parts)
{
    double sum = 0;
    for (const RobotPart& part : parts) sum += hull_volume(part);
    return sum;
}

/// Returns a ring with a square section around z: radii 0.6 and 1, height 0.3.
std::vector<Corners> ring(int segments)
{
    std::vector<Corners> out;
    const auto at = [&](int k, double r, double z) {
        const double angle = 2 * std::numbers::pi * k / segments;
        return Vec3(r * std::cos(angle), r * std::sin(angle), z);
    };
    const std::pair<double, double> section[] = {{0.6, 0}, {1, 0}, {1, 0.3}, {0.6, 0.3}};
    for (int k = 0; k < segments; ++k)
        for (int side = 0; side < 4; ++side) {
            const auto [r, z] = section[side];
            const auto [s, w] = section[(side + 1) % 4];
            out.push_back({at(k, r, z), at(k, s, w), at(k + 1, s, w)});
            out.push_back({at(k, r, z), at(k + 1, s, w), at(k + 1, r, z)});
        }
    return out;
}

}  // namespace

TEST_CASE("an L is split into its two boxes, and no further")
{
    // One closed surface: the extruded outline.
    const std::vector<std::array<double, 2>> outline = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
    std::vector<Corners> l;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const auto &p = outline[k], &q = outline[(k + 1) % outline.size()];
        l.push_back({Vec3(p[0], p[1], 0), Vec3(q[0], q[1], 0), Vec3(q[0], q[1], 1)});
        l.push_back({Vec3(p[0], p[1], 0), Vec3(q[0], q[1], 1), Vec3(p[0], p[1], 1)});
    }
    for (const double z : {0.0, 1.0}) {
        l.push_back({Vec3(0, 0, z), Vec3(4, 0, z), Vec3(4, 1, z)});
        l.push_back({Vec3(0, 0, z), Vec3(4, 1, z), Vec3(1, 1, z)});
        l.push_back({Vec3(0, 0, z), Vec3(1, 1, z), Vec3(1, 3, z)});
        l.push_back({Vec3(0, 0, z), Vec3(1, 3, z), Vec3(0, 3, z)});
    }
    CHECK(convex_split({l}, 1).size() == 1);
    CHECK(volume_of(convex_split({l}, 1)) == Approx(9));
    for (const int most : {2, 3, 16}) {
        const auto parts = convex_split({l}, most);
        CHECK(parts.size() == 2);
        CHECK(volume_of(parts) == Approx(6).epsilon(1e-5));
    }
}

TEST_CASE("a convex mesh stays one part") { CHECK(convex_split({triangles_of(hand::box({1, 2, 3}))}, 8).size() == 1); }

TEST_CASE("the parts of a ring contain its surface and its inside, and more parts fit more closely")
{
    const Mat3 turn = GENERATE(Mat3(Mat3::Identity()), rotation_from_rpy(0.4, 0.7, 1.1));
    auto mesh = ring(24);
    for (Corners& t : mesh)
        for (Vec3& corner : t) corner = turn * corner;
    double before = volume_of(convex_split({mesh}, 1));
    CHECK(before == Approx(std::numbers::pi * 0.3).epsilon(0.02));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const int most : {4, 12}) {
        const auto parts = convex_split({mesh}, most);
        CHECK(int(parts.size()) <= most);
        const double volume = volume_of(parts);
        CHECK(volume < before * 0.98);
        before = volume;
        for (const Corners& t : mesh)
            for (int k = 0; k < 10; ++k) {
                double u = unit(random), v = unit(random);
                if (u + v > 1) u = 1 - u, v = 1 - v;
                CHECK(is_held(parts, t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0])));
            }
        for (int k = 0; k < 500; ++k) {  // between the chords
            const double angle = 2 * std::numbers::pi * unit(random), r = 0.6 + 0.39 * unit(random);
            CHECK(is_held(parts, turn * Vec3(r * std::cos(angle), r * std::sin(angle), 0.3 * unit(random))));
        }
    }
    CHECK(before < 1.4 * std::numbers::pi * (1 - 0.36) * 0.3);
}

TEST_CASE("two separate boxes are split without the space between; a hole in one leaves its surface covered")
{
    const auto one = triangles_of(hand::box({1, 1, 1}));
    auto other = triangles_of(hand::box({1, 1, 1}), {10, 3, 0});
    const auto parts = convex_split({one, other}, 4);
    CHECK(parts.size() == 2);
    CHECK(volume_of(parts) == Approx(2).epsilon(1e-5));
    other.pop_back();
    const auto open = convex_split({one, other}, 8);
    CHECK(volume_of(open) <= 2 + 1e-9);
    for (const Corners& t : other)
        for (const Vec3& point : {t[0], t[1], t[2], Vec3((t[0] + t[1] + t[2]) / 3)}) CHECK(is_held(open, point));
}

TEST_CASE("a solid that is cut along all three axes keeps the place where the planes cross")
{
    // A cross of three beams. Its middle is a corner of eight boxes, and is not on a surface.
    std::vector<SurfacePiece> beams;
    for (const Vec3& size : {Vec3(4, 1, 1), Vec3(1, 4, 1), Vec3(1, 1, 4)})
        beams.push_back(triangles_of(hand::box(size)));
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(-2, 2);
    for (const int most : {3, 7}) {
        const auto parts = convex_split(beams, most);
        int inside = 0;
        for (int k = 0; k < 4000; ++k) {
            const Vec3 p{unit(random), unit(random), unit(random)};
            const Eigen::Array3d a = p.array().abs();
            if ((a <= 0.5).count() < 2) continue;
            ++inside;
            CHECK(is_held(parts, p));
        }
        CHECK(inside > 200);
    }
    CHECK(volume_of(convex_split(beams, 7)) < 10.6);
}

TEST_CASE("mesh parts become robot parts with the name of their link, and their number has limits")
{
    const TempFolder folder;
    folder.write("two.obj", mesh_text::obj({{.name = "left", .mesh = mesh_text::box({0, 0, 0}, {1, 1, 1})},
                                            {.name = "right", .mesh = mesh_text::box({4, 0, 0}, {5, 1, 2})}}));
    const Robot robot = load(folder, link_of("a", collision("<mesh><uri>two.obj</uri></mesh>")), {.mesh_parts = 4});
    REQUIRE(robot.parts.size() == 2);
    CHECK(robot.parts[1].name == "a");
    REQUIRE(robot.meshes.size() == 1);
    CHECK(robot.meshes[0].parts == 2);
    CHECK(*robot.meshes[0].growth() == Approx(0).margin(1e-5));
    CHECK(robot.notices.empty());
    CHECK_THROWS_WITH(load_robot("box:1,1,1", {.mesh_parts = 65}), "load_robot: mesh_parts is 65, needs 1 .. 64");
    CHECK_THROWS_WITH(load_robot("box:1,1,1", {.mesh_parts = 0}), "load_robot: mesh_parts is 0, needs 1 .. 64");
}

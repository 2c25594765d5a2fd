#include "catch.h"
#include "mesh_text.h"
#include "sdf_world.h"
#include "shared_scenes.h"
#include "temp_folder.h"

#include "base/png.h"

#include <spawnfield/column.h>
#include <spawnfield/error.h>
#include <spawnfield/geometry.h>
#include <spawnfield/robot.h>
#include <spawnfield/scene.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdlib>
#include <map>

using namespace spawnfield;

namespace {

namespace fs = std::filesystem;

std::string world_of(const std::string& content)
{
    return "<?xml version='1.0'?>\n<sdf version='1.9'><world name='test'>\n" + content + "\n</world></sdf>\n";
}

std::string collision(const std::string& geometry, const std::string& name = "c", const std::string& pose = "")
{
    return "<collision name='" + name + "'>" + pose + "<geometry>" + geometry + "</geometry></collision>";
}

std::string model_of(const std::string& name, const std::string& geometry, const std::string& pose = "")
{
    return "<model name='" + name + "'>" + pose + "<static>true</static><link name='l'>" + collision(geometry) +
           "</link></model>";
}

const std::string unit_box = "<box><size>1 1 1</size></box>";
const std::string ground = "<model name='ground_plane'><static>1</static><link name='l'>" +
                           collision("<plane><normal>0 0 1</normal><size>40 40</size></plane>") + "</link></model>";

/// Writes a model with this content into the folder `models`.
void write_model(const TempFolder& folder, const std::string& name, const std::string& content)
{
    folder.write(
        "models/" + name + "/model.config",
        "<model><name>" + name + "</name><sdf version='1.4'>old.sdf</sdf><sdf version='1.6'>model.sdf</sdf></model>");
    folder.write("models/" + name + "/model.sdf", "<sdf version='1.6'>" + content + "</sdf>");
}

Scene load_world(const TempFolder& folder, const std::string& content, const SceneOptions& options = {})
{
    return load_scene(folder.write("worlds/test.world", world_of(content)), options);
}

/// Returns the middle of the box around each part.
std::map<std::string, Vec3> places(const Scene& scene)
{
    std::map<std::string, Bounds> boxes;
    for (const Primitive& primitive : scene.primitives) {
        const Bounds box = bounds_of(primitive.shape);
        boxes[scene.parts[primitive.part].name].extend(box.min);
        boxes[scene.parts[primitive.part].name].extend(box.max);
    }
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        for (const std::uint32_t corner : scene.triangles[t])
            boxes[scene.parts[scene.pieces[scene.triangle_pieces[t]].part].name].extend(scene.vertices[corner]);
    std::map<std::string, Vec3> out;
    for (const auto& [name, box] : boxes) out[name] = (box.min + box.max) / 2;
    return out;
}

void check_place(const Scene& scene, const std::string& part, const Vec3& expected)
{
    const auto all = places(scene);
    CAPTURE(part);
    REQUIRE(all.contains(part));
    const Vec3 found = all.at(part);
    CAPTURE(found.transpose(), expected.transpose());
    CHECK((found - expected).norm() < 1e-9);
}

std::string refusal(const fs::path& file, const SceneOptions& options = {})
{
    try {
        load_scene(file, options);
    } catch (const FileError& error) {
        return error.what();
    }
    return "";
}

std::string refusal_of(const TempFolder& folder, const std::string& content, const SceneOptions& options = {})
{
    return refusal(folder.write("worlds/test.world", world_of(content)), options);
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

bool has_notice(const Scene& scene, const std::string& part)
{
    return std::any_of(scene.notices.begin(), scene.notices.end(),
                       [&](const std::string& text) { return has(text, part); });
}

/// Returns the layers at (x, y), from all parts.
std::vector<double> layers_at(const Scene& scene, double x, double y)
{
    return column_at(Geometry(scene), x, y).layers;
}

class Variable {
public:
    Variable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    ~Variable() { unsetenv(name_); }

private:
    const char* name_;
};

}  // namespace

TEST_CASE("collisions are where frames, nested models, includes and placement frames put them")
{
    const TempFolder folder;
    write_model(folder, "cart",
                "<model name='cart'><pose>5 0 0 0 0 0</pose><link name='body'><pose>0 0 1 0 0 0</pose>" +
                    collision(unit_box, "c", "<pose>0.5 0 0 0 0 0</pose>") + "</link></model>");
    folder.write("models/tug/model.config", "<model><name>tug</name><sdf version='1.8'>tug.sdf</sdf></model>");
    folder.write("models/tug/tug.sdf",
                 "<sdf version='1.8'><model name='tug' placement_frame='hook'><link name='body'>" +
                     collision(unit_box) + "</link><frame name='hook'><pose>2 0 0 0 0 0</pose></frame></model></sdf>");
    write_model(folder, "train",
                "<model name='train'><include><uri>model://cart</uri><name>first</name><pose>1 0 0 0 0 "
                "1.5707963267948966</pose></include>"
                "<include><uri>model://cart</uri><name>second</name></include></model>");
    const std::string plain =
        "<include><uri>model://cart</uri></include>"
        "<include><uri>model://cart</uri><name>turned</name><pose>10 20 0 0 0 1.5707963267948966</pose></include>"
        "<include><uri>model://train</uri><pose>0 -30 0 0 0 3.141592653589793</pose></include>"
        "<include><uri>model://tug</uri><pose>0 50 0 0 0 0</pose></include>" +
        model_of("inline", unit_box, "<pose>-7 0 2 0 0 0</pose>");
    const std::string framed =
        plain +
        "<frame name='dock'><pose>100 0 0 0 0 0</pose></frame>"
        "<include><uri>model://cart</uri><name>docked</name><pose relative_to='dock'>0 1 0 0 0 0</pose></include>"
        "<include><uri>model://tug</uri><name>hooked</name><placement_frame>body</placement_frame><pose>0 60 0 0 0 "
        "0</pose></include>" +
        "<model name='beside'><pose relative_to='turned'>0 0 3 0 0 0</pose><link name='l'>" + collision(unit_box) +
        "</link></model>";
    for (const std::string& content :
         {plain, framed}) {  // without frames each include is read once, with frames libsdformat reads all
        const Scene scene = load_world(folder, content);
        CAPTURE(scene.notices);
        check_place(scene, "cart::body::c", {5.5, 0, 1});
        check_place(scene, "turned::body::c", {10, 20.5, 1});
        check_place(scene, "train::first::body::c", {-1, -30.5, 1});
        check_place(scene, "train::second::body::c", {-5.5, -30, 1});
        check_place(scene, "tug::body::c", {-2, 50, 0});
        check_place(scene, "inline::l::c", {-7, 0, 2});
        CHECK(scene.parts.size() == (content == plain ? 6 : 9));
    }
    const Scene scene = load_world(folder, framed);
    check_place(scene, "docked::body::c", {100.5, 1, 1});
    check_place(scene, "hooked::body::c", {0, 60, 0});
    check_place(scene, "beside::l::c", {10, 20, 3});
    // A single model is at its own pose, as if it were included without a pose.
    check_place(load_scene(folder / "models/cart"), "cart::body::c", {5.5, 0, 1});
    check_place(load_scene(folder / "models/tug/tug.sdf"), "tug::body::c", {-2, 0, 0});
}

TEST_CASE("every geometry of SDF has its size")
{
    const TempFolder folder;
    folder.write("worlds/wedge.obj",
                 "o big\nv 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
                 "o small\nv 10 0 0\nv 11 0 0\nv 10 1 0\nv 10 0 1\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n");
    const Scene scene = load_world(
        folder,
        ground + model_of("sphere", "<sphere><radius>2</radius></sphere>", "<pose>0 0 10 0 0 0</pose>") +
            model_of("cylinder", "<cylinder><radius>1</radius><length>3</length></cylinder>",
                     "<pose>0 0 20 0 0 0</pose>") +
            model_of("capsule", "<capsule><radius>1</radius><length>3</length></capsule>",
                     "<pose>0 0 30 0 0 0</pose>") +
            model_of("ellipsoid", "<ellipsoid><radii>3 2 1</radii></ellipsoid>", "<pose>0 0 40 0 0 0</pose>") +
            model_of("mesh", "<mesh><uri>wedge.obj</uri><scale>2 1 0.5</scale></mesh>", "<pose>0 0 50 0 0 0</pose>") +
            model_of("part", "<mesh><uri>wedge.obj</uri><submesh><name>small</name></submesh></mesh>",
                     "<pose>0 0 60 0 0 0</pose>") +
            model_of("centred",
                     "<mesh><uri>wedge.obj</uri><submesh><name>small</name><center>1</center></submesh></mesh>",
                     "<pose>0 0 70 0 0 0</pose>"),
        {.labels = {{"*", Label::Terrain}}});
    CAPTURE(scene.notices);
    std::map<std::string, Bounds> boxes;
    for (const Primitive& primitive : scene.primitives)
        boxes[scene.parts[primitive.part].name] = bounds_of(primitive.shape);
    CHECK((boxes["sphere::l::c"].max - Vec3(2, 2, 12)).norm() < 1e-12);
    CHECK((boxes["cylinder::l::c"].max - Vec3(1, 1, 21.5)).norm() < 1e-12);
    CHECK((boxes["capsule::l::c"].max - Vec3(1, 1, 32.5)).norm() < 1e-12);
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        for (const std::uint32_t corner : scene.triangles[t])
            boxes[scene.parts[scene.pieces[scene.triangle_pieces[t]].part].name].extend(scene.vertices[corner]);
    CHECK((boxes["mesh::l::c"].max - Vec3(22, 2, 51)).norm() < 1e-6);
    CHECK((boxes["part::l::c"].min - Vec3(10, 0, 60)).norm() < 1e-6);
    CHECK((boxes["centred::l::c"].min - Vec3(-0.5, -0.5, 69.5)).norm() < 1e-6);
    // The mesh encloses the ellipsoid, and nowhere exceeds it by more than the stated amount.
    const Vec3 radii(3, 2, 1);
    double most = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        if (scene.parts[scene.pieces[scene.triangle_pieces[t]].part].name != "ellipsoid::l::c") continue;
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 from_middle = scene.vertices[scene.triangles[t][k]] - Vec3(0, 0, 40);
            corners[k] = from_middle.cwiseQuotient(radii);
            most = std::max(most, (from_middle - from_middle / corners[k].norm()).norm());
        }
        // In the frame in which the ellipsoid is a unit sphere, no face may come closer than 1 to the middle.
        const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
        CHECK(std::abs(normal.dot(corners[0])) >= 1 - 1e-12);
    }
    CHECK(most > 0);
    CHECK(has_notice(scene, "1 ellipsoid is replaced by a mesh around it, at most 0.0035 m larger"));
    CHECK(most <= 0.0035);
    CHECK(scene.pieces.size() >= 6);
}

TEST_CASE("a polyline is extruded upwards from its pose, and an outline inside another is a hole")
{
    const TempFolder folder;
    const std::string outer =
        "<polyline><point>0 0</point><point>10 0</point><point>10 10</point><point>5 5</point><point>0 "
        "10</point><point>0 0</point><height>2</height></polyline>";
    const std::string hole =
        "<polyline><point>1 1</point><point>3 1</point><point>3 3</point><point>1 "
        "3</point><height>2</height></polyline>";
    const std::string island =
        "<polyline><point>1.5 1.5</point><point>2.5 1.5</point><point>2.5 2.5</point><point>1.5 "
        "2.5</point><height>2</height></polyline>";
    const Scene scene = load_world(folder, model_of("terrain", outer + hole + island, "<pose>0 0 1 0 0 0</pose>"));
    REQUIRE(scene.parts.size() == 1);
    CHECK(scene.parts[0].open_edges == 0);
    CHECK(scene.parts[0].solid_pieces == 2);
    const auto is_filled = [](double x, double y) {
        const bool in_outer = x > 0 && x < 10 && y > 0 && y < 10 && y < 5 + std::abs(x - 5);
        const bool in_hole = x > 1 && x < 3 && y > 1 && y<3, on_island = x> 1.5 && x < 2.5 && y > 1.5 && y < 2.5;
        return in_outer && (!in_hole || on_island);
    };
    int filled = 0;
    for (double x = -0.95; x < 11; x += 0.31)
        for (double y = -0.97; y < 11; y += 0.29) {
            const std::vector<double> layers = layers_at(scene, x, y);
            CAPTURE(x, y);
            if (std::abs(y - 5 - std::abs(x - 5)) < 1e-9) continue;  // on the rim
            REQUIRE(layers.size() == (is_filled(x, y) ? 1 : 0));
            if (layers.empty()) continue;
            CHECK(std::abs(layers[0] - 3) < 1e-9);
            ++filled;
        }
    CHECK(filled > 500);
    CHECK(has(refusal_of(folder, model_of("a",
                                          "<polyline><point>0 0</point><point>4 2</point><point>4 0</point><point>0 "
                                          "1</point><height>1</height></polyline>")),
              "\"a::l::c\": <polyline>: its outline crosses itself near ("));
    CHECK(has(refusal_of(folder,
                         model_of("a", "<polyline><point>0 0</point><point>2 2</point><height>1</height></polyline>")),
              "outline 1 has 2 points, needs 3 or more"));
}

TEST_CASE("a plane is infinite: it continues beyond the bounds, with any drawn size")
{
    const TempFolder folder;
    const auto plane = [](const std::string& visual) {
        return "<model name='p'><pose>0 0 0.25 0 0 0</pose><static>1</static><link name='l'>" +
               collision("<plane><normal>0 0 1</normal><size>1 1</size></plane>") +
               (visual.empty() ? "" : "<visual name='v'><geometry>" + visual + "</geometry></visual>") +
               "</link></model>";
    };
    const auto drawn = [&](const std::string& side) {
        return plane("<plane><normal>0 0 1</normal><size>" + side + " " + side + "</size></plane>");
    };
    const std::string far = model_of("far", unit_box, "<pose>100 -50 0 0 0 0</pose>") + model_of("near", unit_box);
    const auto has_bounds = [](const Scene& of, const Vec3& min, const Vec3& max) {
        CAPTURE(of.map_bounds.min.transpose(), of.map_bounds.max.transpose());
        CHECK((of.map_bounds.min - min).norm() < 1e-9);
        CHECK((of.map_bounds.max - max).norm() < 1e-9);
    };
    const std::string around = "no <visual> shows it larger than the rest of the world";
    // The <size> of the collision has no effect, nor has a drawn plane that is no larger than the rest.
    for (const std::string& unknown :
         {plane(""), drawn("1"), drawn("50"), plane("<sphere><radius>500</radius></sphere>")}) {
        const Scene scene = load_world(folder, unknown + far);
        has_bounds(scene, {-10.5, -60.5, -0.5}, {110.5, 10.5, 0.5});
        CHECK(has_notice(scene, around));
        for (const auto& [x, y] : {std::pair{0.1, 0.7}, std::pair{90.0, -49.0}, std::pair{-60.4, 60.4}}) {
            const auto layers = layers_at(scene, x, y);
            REQUIRE(layers.size() == 1);
            CHECK(std::abs(layers[0] - 0.25) < 1e-9);
        }
        CHECK(layers_at(scene, -60.6, 0).empty());
    }
    for (const std::string& large : {drawn("300"), plane("<box><size>300 300 0.01</size></box>")}) {
        const Scene scene = load_world(folder, large + far);
        has_bounds(scene, {-150, -150, -0.5}, {150, 150, 0.5});
        CHECK_FALSE(has_notice(scene, around));
    }
    has_bounds(load_world(folder, drawn("4")), {-2, -2, 0.25}, {2, 2, 0.25});
    has_bounds(load_world(folder, plane("")), {-10, -10, 0.25}, {10, 10, 0.25});  // only a plane without a drawing
    // Given bounds are the bounds of the map.
    const Scene given = load_world(folder, drawn("2"), {.bounds = {Vec3(200, 200, 0), Vec3(210, 220, 5)}});
    CHECK(layers_at(given, 205, 210).size() == 1);
    CHECK(given.map_bounds.min.x() == 200);
    CHECK_FALSE(has_notice(load_world(folder, plane("") + far, {.bounds = {Vec3(0, 0, 0), Vec3(9, 9, 5)}}), around));
    // A ramp: with the normal (-1, 0, 1) it rises with x.
    const Scene ramp = load_world(folder, model_of("p", "<plane><normal>-1 0 1</normal><size>20 20</size></plane>"));
    const auto at = layers_at(ramp, 4, 3);
    REQUIRE(at.size() == 1);
    CHECK(std::abs(at[0] - 4) < 1e-9);
}

TEST_CASE("the brightest pixel of a heightmap has the height of its size, and sampling interpolates between pixels")
{
    const TempFolder folder;
    const std::vector<std::uint16_t> pixels = {0, 1000, 2000, 3000, 20000, 5000, 6000, 7000, 8000};
    folder.write("worlds/x", "");
    write_grey_png(folder / "worlds/relief.png", 3, 3, pixels.data());
    const auto heights = [&](int sampling) {
        return load_world(
            folder, model_of("h", "<heightmap><uri>relief.png</uri><size>20 10 40</size><pos>100 0 -5</pos><sampling>" +
                                      std::to_string(sampling) + "</sampling></heightmap>"));
    };
    for (const int sampling : {1, 2, 4}) {
        const Scene scene = heights(sampling);
        CAPTURE(sampling);
        CHECK(scene.triangles.size() == std::size_t(2 * 2 * sampling * 2 * sampling));
        CHECK(std::abs(layers_at(scene, 100, 0)[0] - (40 - 5)) < 1e-9);
        CHECK(std::abs(layers_at(scene, 90, 5)[0] - -5) < 1e-9);
        CHECK(std::abs(layers_at(scene, 110, -5)[0] - (16 - 5)) < 1e-9);
        CHECK(std::abs(layers_at(scene, 95, 5)[0] - (1 - 5)) < 1e-9);
    }
    // Heights between pixels are bilinear: the middle of a cell has the mean of its four pixels.
    CHECK(std::abs(layers_at(heights(2), 95, 2.5)[0] - ((0 + 1000 + 3000 + 20000) / 4.0 / 20000 * 40 - 5)) < 1e-9);
}

TEST_CASE("an elevation model as <heightmap> keeps its lowest height, and is stretched to its size")
{
    const TempFolder folder;
    folder.write(
        "worlds/dem.asc",
        "ncols 5\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n"
        "100 120 140 160 180\n100 120 140 160 180\n100 120 -9 160 180\n100 120 140 160 180\n100 120 140 160 180\n");
    const auto load = [&](const std::string& size_z, const std::string& sampling) {
        return load_world(folder, model_of("h", "<heightmap><uri>dem.asc</uri><size>16 16 " + size_z +
                                                    "</size><sampling>" + sampling + "</sampling></heightmap>"));
    };
    for (const auto& [size_z, share] : {std::pair{"80", 1.0}, std::pair{"20", 0.25}})
        for (const char* const sampling : {"1", "2"}) {
            const Scene scene = load(size_z, sampling);
            CHECK(std::abs(layers_at(scene, -8, 7)[0] - 100) < 1e-9);
            CHECK(std::abs(layers_at(scene, 8, 7)[0] - (100 + 80 * share)) < 1e-9);
            CHECK(std::abs(layers_at(scene, -6, 8)[0] - (100 + 10 * share)) < 1e-9);
            CHECK(layers_at(scene, 0, 0).empty());  // the file has no height here
            CHECK(layers_at(scene, -4, 4).size() == 1);
            CHECK(has_notice(scene, "dem.asc: is read as an elevation model"));
            CHECK_FALSE(has_notice(scene, "2^n + 1"));
        }
    folder.write("worlds/dem.asc",
                 "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4\n1 2 3 4\n1 2 3 4\n");
    CHECK(has_notice(load("3", "1"), "is 4 x 3 pixels large; Gazebo resamples it to a square of 2^n + 1"));
}

TEST_CASE("elements that SDF does not know, or that have no effect, get a notice with their line in the file")
{
    const TempFolder folder;
    write_model(folder, "crate",
                "<model name='crate'>\n<link name='l'>" + collision(unit_box) + "<colision name='d'/></link></model>");
    const std::string world =
        ground + "\n<include>\n<uri>model://crate</uri>\n</include>\n<!-- two\nlines -->\n<modle name='b'/>\n" +
        "<model name='a'>\n<link name='l'>" + collision(unit_box) + "\n" +
        collision(unit_box, "c", "<pose>3 0 0 0 0 0</pose>") +
        "\n<collision name='hollow'><geometry/></collision></link></model>";
    const Scene scene = load_world(folder, world);
    CAPTURE(scene.notices);
    CHECK(has_notice(
        scene,
        "test.world: line 9: /sdf/world[@name=\"test\"]/modle[@name=\"b\"]: is not an SDF element at this place"));
    CHECK(has_notice(scene,
                     "model.sdf: line 2: /sdf/model[@name=\"crate\"]/link[@name=\"l\"]/colision[@name=\"d\"]: is not "
                     "an SDF element"));
    CHECK(has_notice(scene, "collision with name[c] already exists. It is ignored"));
    CHECK(has_notice(scene, "<collision>: 1 ignored, because they have no shape"));
    CHECK(scene.parts.size() == 3);
    CHECK(has(refusal_of(folder, world, {.strict = true}), "already exists"));

    const auto with_surface = [&](const std::string& contact) {
        return load_world(folder, ground + "<model name='zone'><link name='l'><collision name='c'><geometry>" +
                                      unit_box + "</geometry><surface><contact>" + contact +
                                      "</contact></surface></collision></link></model>");
    };
    for (const char* const contact :
         {"<collide_bitmask>0x00</collide_bitmask>", "<collide_without_contact>1</collide_without_contact>"}) {
        const Scene zone = with_surface(contact);
        CHECK(zone.parts.size() == 1);
        CHECK(has_notice(
            zone,
            "<collision>: 1 ignored, because nothing touches them (<collide_bitmask> or <collide_without_contact>)"));
    }
    CHECK(with_surface("<collide_bitmask>0x01</collide_bitmask>").parts.size() == 2);

    const fs::path both = folder.write("worlds/both.sdf", "<sdf version='1.9'><world name='w'>" + ground +
                                                              "</world>\n" + model_of("beside", unit_box) + "</sdf>");
    CHECK(has_notice(load_scene(both), "line 2: <model> is beside <world>: it is ignored"));
    folder.write("worlds/wedge.obj", mesh_text::obj(mesh_text::box(Vec3(0, 0, 0), Vec3(1, 1, 1))));
    const Scene lost = load_world(
        folder, ground + model_of("m", "<mesh><uri>wedge.obj</uri><submesh><name>none</name></submesh></mesh>"));
    CHECK(has_notice(lost, "\"m::l::c\": <submesh> \"none\" is not a node of "));
    CHECK(lost.parts.size() == 1);
}

TEST_CASE("a file with the name of a file of libsdformat is read instead of that one")
{
    const TempFolder folder;
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    for (const char* const name : {"model.sdf", "world.sdf", "frame.sdf"}) {
        folder.write(name, "<sdf version='1.9'>" + model_of("mine", unit_box) + "</sdf>");
        CHECK(places(load_scene(name)).contains("mine::l::c"));
        CHECK(load_robot(name).name == "mine");
    }
    fs::current_path(before);
}

TEST_CASE("COLLADA in SDF has its unit, but keeps its axes")
{
    const TempFolder folder;
    const auto write = [&](const std::string& up) {
        folder.write("worlds/slab.dae", mesh_text::dae({{.mesh = mesh_text::box(Vec3(0, 0, 0), Vec3(400, 200, 100))}},
                                                       {.up = up, .unit = 0.01}));
        return load_world(folder, model_of("m", "<mesh><uri>slab.dae</uri></mesh>"));
    };
    for (const char* const up : {"X_UP", "Y_UP", "Z_UP", ""}) {
        CAPTURE(up);
        CHECK((write(up).bounds().max - Vec3(4, 2, 1)).norm() < 1e-6);
    }
}

TEST_CASE("rules decide what is ground, and --label comes first")
{
    const TempFolder folder;
    const std::string world = ground + model_of("warehouse_GroundB_01", unit_box) + model_of("Sidewalk_7", unit_box) +
                              model_of("background_wall", unit_box) +
                              "<model name='house'><static>1</static><link name='l'>" + collision(unit_box, "floor_1") +
                              collision(unit_box, "wall") + "</link></model>";
    const auto labels = [](const Scene& scene) {
        std::map<std::string, std::string> out;
        for (const Part& part : scene.parts) out[part.name] = to_string(part.label);
        return out;
    };
    const Scene scene = load_world(folder, world);
    const std::map<std::string, std::string> expected = {
        {"ground_plane::l::c", "terrain"}, {"warehouse_GroundB_01::l::c", "terrain"},
        {"Sidewalk_7::l::c", "terrain"},   {"background_wall::l::c", "obstacle"},
        {"house::l::floor_1", "terrain"},  {"house::l::wall", "obstacle"}};
    CHECK(labels(scene) == expected);
    std::map<std::string, std::size_t> counts;
    for (const NameRule& rule : scene.rules) counts[rule.what] = rule.count;
    CHECK(counts["plane"] == 1);
    CHECK(counts["name ground*"] == 1);
    CHECK(counts["name floor*"] == 1);
    CHECK(counts["all else"] == 2);

    const Scene labelled = load_world(folder, world,
                                      {.labels = {{"house", Label::Water},
                                                  {"sidewalk_7::*", Label::Ignore},
                                                  {"wall", Label::Terrain},
                                                  {"nothing*", Label::Terrain}}});
    auto changed = labels(labelled);
    CHECK(changed["house::l::wall"] == "water");  // the first rule that matches
    CHECK(changed["house::l::floor_1"] == "water");
    CHECK(changed["Sidewalk_7::l::c"] == "ignore");
    CHECK(changed["ground_plane::l::c"] == "terrain");
    for (const NameRule& rule : labelled.rules)  // the rules did not decide what the options decided
        if (rule.what == "name sidewalk*" || rule.what == "name floor*") CHECK(rule.count == 0);
    CHECK(has_notice(labelled, "label \"nothing*\" matches no model, link, collision, node or material"));

    const std::string furniture =
        "name of ground that also has ceiling, wall, roof, door, window, stair, lamp, light, sign, block, "
        "barrier, rail, cone, post or pole";
    const Scene street = load_world(folder, ground + model_of("street_light", unit_box) +
                                                model_of("bridgeRailing", unit_box) +
                                                model_of("roadblock_2", unit_box) + model_of("bridge_2", unit_box) +
                                                model_of("road_design", unit_box));
    const std::map<std::string, std::string> on_street = {
        {"ground_plane::l::c", "terrain"}, {"street_light::l::c", "obstacle"}, {"bridgeRailing::l::c", "obstacle"},
        {"roadblock_2::l::c", "obstacle"}, {"bridge_2::l::c", "terrain"},      {"road_design::l::c", "terrain"}};
    CHECK(labels(street) == on_street);
    for (const NameRule& rule : street.rules)
        if (rule.what == furniture) CHECK(rule.count == 3);

    const Scene unnamed = load_world(folder, model_of("rock", unit_box));
    CHECK(labels(unnamed)["rock::l::c"] == "terrain");
    CHECK(has_notice(unnamed, "so everything is terrain"));
}

TEST_CASE("names are split into words, and walls and ceilings are not ground, with any other words in their names")
{
    const TempFolder folder;
    const auto label_of = [&](const std::string& name, const std::string& link = "link",
                              const std::string& collider = "collision") {
        const Scene scene = load_world(folder, ground + "<model name='" + name + "'><link name='" + link + "'>" +
                                                   collision(unit_box, collider) + "</link></model>");
        return std::string(to_string(scene.parts[0].label));
    };
    for (const char* const name :
         {"RetailShopFloor_01", "aws_robomaker_hospital_floor_01_floor", "warehouse_GroundB_01", "HTMLFloor", "floor1",
          "1stFloor", "GROUND", "Sidewalk_7", "downstairs_floor", "outdoor_ground", "FloorTiles", "Roadway",
          "ground_plane_box", "drywall_floor"}) {
        CAPTURE(name);
        CHECK(label_of(name) == "terrain");
    }
    for (const char* const name :
         {"aws_robomaker_hospital_floor_01_ceiling", "aws_robomaker_hospital_floor_01_walls", "FirstFloorWall",
          "FloorDoor2", "GroundFloorStairs", "floor_staircase", "RoofFloor", "floor_window", "floorLamp", "floor_lamp",
          "street_light", "BridgeRailing", "underground", "background_wall", "retailshopfloor", "rock"}) {
        CAPTURE(name);
        CHECK(label_of(name) == "obstacle");
    }
    // The innermost name that matches a rule decides.
    CHECK(label_of("ground_floor", "wall_1") == "obstacle");
    CHECK(label_of("house_wall", "link", "floor") == "terrain");
    CHECK(label_of("bridge", "link", "railing") == "obstacle");
}

TEST_CASE("missing files get a notice with their name, and are refused if the caller is strict")
{
    const TempFolder folder;
    const std::string world =
        ground +
        "<include><uri>model://nowhere</uri></include><include><uri>model://nowhere</uri><name>again</name></include>" +
        model_of("statue", "<mesh><uri>model://statue/lost.dae</uri></mesh>") +
        "<model name='ghost'><static>1</static><link name='l'/></model>"
        "<actor name='walker'><skin><filename>walk.dae</filename></skin></actor><road "
        "name='r'><width>2</width><point>0 0 0</point><point>1 0 0</point></road>";
    const Scene scene = load_world(folder, world, {.allow_missing = true});
    CAPTURE(scene.notices);
    CHECK(has_notice(scene,
                     "test.world: line 3: <include> <uri> model://nowhere is not found (2 includes): it is ignored"));
    CHECK(has_notice(scene, "\"statue::l::c\": model://statue/lost.dae is not found: it is ignored"));
    CHECK(has_notice(scene, "1 model has no collision, so robots pass through it: ghost"));
    CHECK(has_notice(scene, "<actor>: 1 ignored"));
    CHECK(has_notice(scene, "<road>: 1 ignored"));
    CHECK(scene.parts.size() == 1);
    const std::string strict = refusal_of(
        folder, ground + model_of("statue", "<mesh><uri>model://statue/lost.dae</uri></mesh>"), {.strict = true});
    CHECK(has(strict, "model://statue/lost.dae"));
    CHECK(has(strict, "--strict does not allow this"));
}

TEST_CASE("a world with includes that are not found is refused, with a list of all")
{
    const TempFolder folder;
    write_model(folder, "cart",
                "<model name='cart'><include><uri>model://wheel</uri></include><link name='l'>" + collision(unit_box) +
                    "</link></model>");
    const std::string includes =
        "<include><uri>model://desk</uri></include>\n<include><uri>model://desk</uri><name>b</name></include>\n"
        "<include><uri>https://fuel.gazebosim.org/1.0/Somebody/models/Chair</uri></include>\n<include><uri>model://"
        "cart</uri></include>";
    const std::string refused = refusal_of(folder, ground + includes);
    CAPTURE(refused);
    CHECK(has(refused,
              "test.world: 3 models that it includes are not found; give the folder that contains them with "
              "--model-path, download models of Fuel with `gz fuel "
              "download -u URI`, or ignore them with --allow-missing:\n"));
    CHECK(has(refused, "\n  line 3: <include> <uri> model://desk is not found (2 includes)\n"));
    CHECK(has(refused, "line 5: <include> <uri> https://fuel.gazebosim.org/1.0/Somebody/models/Chair is not found\n"));
    CHECK(has(refused, "model.sdf: line 1: <include> <uri> model://wheel is not found"));
    CHECK(has(refusal_of(folder, ground + "<include><uri>model://desk</uri></include>"),
              "1 model that it includes is not found; give the folder that contains it with --model-path, or"));
    CHECK(load_world(folder, ground + includes, {.allow_missing = true}).parts.size() == 2);
    // If all of them are missing, the message lists them.
    const std::string empty = refusal_of(folder, "<include><uri>model://desk</uri></include>", {.allow_missing = true});
    CHECK(has(empty, "has only models that are missing, so robots cannot stand anywhere:\n"));
    CHECK(has(empty, "model://desk is not found: it is ignored"));
}

TEST_CASE("nothing becomes terrain because a file is missing")
{
    const TempFolder folder;
    const std::string desk = model_of("desk", unit_box),
                      lost_mesh = model_of("floor", "<mesh><uri>model://house/floor.dae</uri></mesh>");
    CHECK(load_world(folder, desk).has_terrain());  // nothing is missing, so everything is terrain
    for (const std::string& lost : {lost_mesh, std::string("<include><uri>model://house</uri></include>")}) {
        const Scene scene = load_world(folder, desk + lost, {.allow_missing = true});
        CAPTURE(lost);
        CHECK_FALSE(scene.has_terrain());
        CHECK(has_notice(scene, "none of it becomes terrain"));
        CHECK(load_world(folder, desk + lost, {.labels = {{"desk", Label::Terrain}}, .allow_missing = true})
                  .has_terrain());
    }
}

TEST_CASE("ground_plane and sun are built in, by all of their names, unless they are on disk")
{
    const TempFolder folder;
    const std::string desk = model_of("desk", unit_box, "<pose>3 0 0 0 0 0</pose>");
    const auto include = [](const std::string& uri, const std::string& more = "") {
        return "<include><uri>" + uri + "</uri>" + more + "</include>";
    };
    for (const char* const uri :
         {"model://ground_plane", "model://Ground Plane", "model://GroundPlane/", "ground_plane",
          "model://ground_plane/model.sdf", "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground Plane",
          "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground%20Plane/2",
          "https://fuel.ignitionrobotics.org/1.0/openrobotics/models/Ground_Plane/tip",
          "https://fuel.gazebosim.org/1.0/OpenRobotics/models/ground plane/"}) {
        CAPTURE(uri);
        const Scene scene = load_world(folder, desk + include(uri) + include("model://sun"));
        CAPTURE(scene.notices);
        REQUIRE(scene.parts.size() == 2);
        CHECK(scene.parts[1].name == "ground_plane::link::collision");
        CHECK(scene.parts[1].label == Label::Terrain);
        CHECK(scene.parts[0].label == Label::Obstacle);
        CHECK(scene.map_bounds.max.x() == 50);  // Gazebo draws its plane with 100 x 100 m
        CHECK(layers_at(scene, 99, 0) == std::vector<double>{0});
        CHECK(has_notice(scene, uri + std::string(" is not on disk; the built-in ground plane replaces it")));
    }
    for (const char* const uri :
         {"model://sun", "model://Sun", "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Sun",
          "https://fuel.ignitionrobotics.org/1.0/OpenRobotics/models/Sun/3"})
        CHECK(load_world(folder, desk + include(uri)).parts.size() == 1);
    for (const char* const uri :
         {"model://ground_plane_2", "model://my/ground_plane",
          "https://fuel.gazebosim.org/1.0/Somebody/models/Ground Plane",
          "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Sun Flower", "package://ground_plane"})
        CHECK(has(refusal_of(folder, desk + include(uri)), "is not found"));

    // The built-in plane is at the pose of its include, with its name, in another model, and with frames.
    const Scene high = load_world(folder,
                                  desk + include("model://ground_plane", "<name>deck</name><pose>0 0 2 0 0 0</pose>"));
    CHECK(high.parts[1].name == "deck::link::collision");
    CHECK(layers_at(high, 20, 0) == std::vector<double>{2});
    const Scene nested = load_world(folder, "<frame name='f'/>" + desk +
                                                "<model name='outer'><pose>0 0 1 0 0 0</pose>" +
                                                include("model://ground_plane") + "</model>");
    CHECK(nested.parts[1].name == "outer::ground_plane::link::collision");
    CHECK(layers_at(nested, 20, 0) == std::vector<double>{1});

    write_model(folder, "ground_plane",
                "<model name='mine'><link name='l'>" + collision("<box><size>7 7 1</size></box>") + "</link></model>");
    write_model(folder, "sun", "<light type='directional' name='sun'/>");  // like the file of Gazebo
    const Scene own = load_world(folder, desk + include("model://ground_plane") + include("model://sun"));
    CHECK(places(own).contains("mine::l::c"));
    CHECK_FALSE(has_notice(own, "built-in"));
}

TEST_CASE("models are found by --model-path, by the variables of Gazebo and above the file")
{
    const TempFolder folder, elsewhere;
    elsewhere.write("lib/crate/model.sdf", "<sdf version='1.6'><model name='crate'><link name='l'>" +
                                               collision("<mesh><uri>model://crate/meshes/crate.obj</uri></mesh>") +
                                               "</link></model></sdf>");
    elsewhere.write("lib/crate/meshes/crate.obj", mesh_text::obj(mesh_text::box(Vec3(0, 0, 0), Vec3(1, 1, 1))));
    const std::string world = ground + "<include><uri>model://crate</uri></include>";
    CHECK(load_world(folder, world, {.allow_missing = true}).parts.size() == 1);
    CHECK(load_world(folder, world, {.model_paths = {elsewhere / "lib"}}).parts.size() == 2);
    for (const char* const variable : {"GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "IGN_GAZEBO_RESOURCE_PATH"}) {
        const Variable set(variable, "/nonexistent:" + (elsewhere / "lib").string());
        CHECK(load_world(folder, world).parts.size() == 2);
    }
    const fs::path inside = elsewhere.write("worlds/test.world", world_of(world));
    CHECK(load_scene(inside, {.allow_missing = true}).parts.size() == 1);
    fs::rename(elsewhere / "lib", elsewhere / "models");
    const Scene found = load_scene(inside);
    CHECK(found.parts.size() == 2);
    CHECK(has_notice(found, "folder of models was found above the file"));
}

TEST_CASE("faulty worlds are refused with file, line and element")
{
    const TempFolder folder;
    const auto expect = [&](const std::string& content, const std::vector<std::string>& words) {
        const std::string message = refusal_of(folder, content);
        CAPTURE(content, message);
        CHECK(has(message, "test.world"));
        for (const std::string& word : words) CHECK(has(message, word));
    };
    expect("<model name='a'><link></model>", {"line 3", "is not valid XML"});
    expect(ground + "<include><name>x</name></include>", {"line 3: <include>: has no <uri>"});
    expect(model_of("a", "<box><size>1 x 1</size></box>"), {"line 3: <box> <size>: \"x\" is not a finite number"});
    expect(model_of("a", "<sphere><radius>1,5</radius></sphere>"),
           {"line 3: <sphere> <radius>: \"1,5\" is not a finite number"});
    expect("\n" + model_of("a", "<box><size>1 2 3 4</size></box>"), {"line 4: <box> <size>: has 4 numbers, needs 3"});
    expect(model_of("a", "<cylinder><radius>1</radius></cylinder>"), {"line 3: <cylinder>: has no <length>"});
    expect(model_of("a", "<heightmap><uri>a.png</uri><size>4 4 -1</size></heightmap>"),
           {"\"a::l::c\": <heightmap> <size> is -1, needs > 0 and at most 1000 km (line 3)"});
    expect(model_of("a", unit_box + "\n<sphere><radius>1</radius></sphere>"),
           {"\"a::l::c\": <geometry> contains <box>, <sphere>, needs one shape"});
    expect(model_of("a", "<box><size>1 -1 1</size></box>"), {"\"a::l::c\": <box> <size> is -1, needs > 0"});
    expect(model_of("a", "<sphere><radius>0</radius></sphere>"), {"<sphere> <radius> is 0, needs > 0"});
    expect(model_of("a", "<box><size>1 1e12 1</size></box>"), {"<box> <size> is 1e+12, needs > 0 and at most 1000 km"});
    expect(model_of("a", "<plane><normal>0 0 0</normal></plane>"),
           {"<plane> <normal> is (0, 0, 0), needs a direction"});
    expect(model_of("a", unit_box, "<pose relative_to='nobody'>0 0 0 0 0 0</pose>"), {"nobody"});
    expect(model_of("a", unit_box, "<pose>0 0 0 0 0</pose>"), {"line 3", "pose"});
    expect(model_of("a", unit_box, "<pose>inf 0 0 0 0 0</pose>"),
           {"line 3: <model> <pose>: \"inf\" is not a finite number"});
    expect("<population name='crowd'><model_count>3</model_count></population>",
           {"line 3: <population> \"crowd\" cannot be read here"});
    expect("", {"has no models"});
    CHECK(has(refusal(folder.write("bare.world", "hello")), "is not valid XML"));
    CHECK(has(refusal(folder.write("empty.world", "")), "is empty"));
    CHECK(has(refusal(folder.write("other.sdf", "<mujoco/>")), "line 1: the root element is <mujoco>"));
    CHECK(has(refusal(folder.write("noversion.sdf", "<sdf><world name='w'/></sdf>")), "line 1: <sdf> has no version"));
    CHECK(has(refusal(folder.write("version.sdf", "<sdf version='abc'><world name='w'/></sdf>")),
              "line 1: <sdf> has version \"abc\", needs 1.0 to 2.x, for example version=\"1.6\""));
    const std::string only_lost = refusal(
        folder.write("lost.sdf", world_of(model_of("a", "<mesh><uri>nothere.dae</uri></mesh>"))));
    CHECK(has(only_lost, "has no geometry: all parts are ignored, missing or without collision"));
    CHECK(has(only_lost, "nothere.dae is not found"));
    CHECK(has(refusal(folder.write("two.sdf", "<sdf version='1.9'><world name='a'/><world name='b'/></sdf>")),
              "has 2 worlds, needs one"));
    CHECK(has(refusal(folder / "nowhere"), "does not exist"));
    fs::create_directories(folder / "hollow");
    CHECK(has(refusal(folder / "hollow"), "is a folder without model.config"));
}

TEST_CASE("models that include each other in a circle are refused, with the circle")
{
    const TempFolder folder;
    write_model(folder, "hen", "<model name='hen'><include><uri>model://egg</uri></include></model>");
    write_model(folder, "egg", "<model name='egg'>\n<include><uri>model://hen</uri></include></model>");
    const std::string message = refusal_of(folder, ground + "<include><uri>model://hen</uri></include>");
    CAPTURE(message);
    CHECK(has(message, "egg/model.sdf: line 2: <include> <uri> model://hen"));
    CHECK(has(message, "includes itself"));
    CHECK(has(message, "hen/model.sdf includes "));
}

TEST_CASE("models that include the next one twice, and so on, are refused before they are built")
{
    const TempFolder folder;
    constexpr int doublings = 40;
    for (int i = 0; i < doublings; ++i) {
        const std::string next = std::to_string(i + 1), include = "<include><uri>model://m" + next + "</uri><name>";
        write_model(folder, "m" + std::to_string(i),
                    "<model name='m'>" + include + "a</name></include>" + include + "b</name></include></model>");
    }
    write_model(folder, "m" + std::to_string(doublings),
                "<model name='m'><link name='l'>" + collision(unit_box) + "</link></model>");
    CHECK(has(refusal_of(folder, ground + "<include><uri>model://m0</uri></include>"),
              "makes more than 100000 includes in total"));
}

TEST_CASE("the real worlds contain what an independent reader finds in them", "[real]")
{
    const auto folder = shared_scenes();
    if (!folder) return;
    for (const auto& [world, models, parts] :
         {std::tuple{"city/worlds/simple_city.world", "city/models", 939},
          std::tuple{"warehouse/worlds/small_warehouse.world", "warehouse/models", 26}}) {
        CAPTURE(world);
        const Scene scene = load_scene(*folder / world);
        CHECK(scene.parts.size() == std::size_t(parts));
        const TempFolder temp;
        const Scene other = load_scene(scene_of_world(temp, *folder / world, *folder / models));
        CHECK(other.primitives.size() == scene.primitives.size());
        // In the other reader planes have their drawn size, and the lids of pavements are fans.
        const auto sorted_middles = [](const Scene& of) {
            std::vector<std::array<double, 3>> out;
            for (const Primitive& p : of.primitives)
                out.push_back({p.shape.pose.position.x(), p.shape.pose.position.y(), p.shape.pose.position.z()});
            for (std::size_t t = 0; t < of.triangles.size(); ++t) {
                const std::string &kind = of.parts[of.pieces[of.triangle_pieces[t]].part].kind,
                                  &name = of.parts[of.pieces[of.triangle_pieces[t]].part].name;
                if (kind == "plane" || kind == "polyline") continue;
                Vec3 middle = Vec3::Zero();
                for (const std::uint32_t corner : of.triangles[t]) middle += of.vertices[corner] / 3;
                (void)name;
                out.push_back({middle.x(), middle.y(), middle.z()});
            }
            std::sort(out.begin(), out.end());
            return out;
        };
        const auto here = sorted_middles(scene), there = sorted_middles(other);
        std::size_t matched = 0;
        for (const auto& middle : here) {
            auto near = std::lower_bound(there.begin(), there.end(), std::array{middle[0] - 1e-6, -1e9, -1e9});
            for (; near != there.end() && (*near)[0] <= middle[0] + 1e-6; ++near)
                if (std::abs((*near)[1] - middle[1]) < 1e-6 && std::abs((*near)[2] - middle[2]) < 1e-6) {
                    ++matched;
                    break;
                }
        }
        CHECK(matched == here.size());
        CHECK(there.size() >= here.size());
        const Bounds a = scene.map_bounds.is_empty() ? scene.bounds() : scene.map_bounds, b = other.bounds();
        CHECK((a.min - b.min).norm() < 1e-6);
        CHECK((a.max - b.max).norm() < 1e-6);
    }
}

#include "catch.h"
#include "mesh_text.h"
#include "this_build.h"
#include "program.h"
#include "random_scene.h"
#include "scene_text.h"
#include "worlds/random.h"

#include <spawnfield/collision.h>
#include <spawnfield/column.h>
#include <spawnfield/error.h>
#include <spawnfield/robot_parts.h>
#include <spawnfield/scene_parts.h>

#include <Eigen/Geometry>

#include <cstdio>

using namespace spawnfield;

// A part with a path becomes the space that it sweeps.

namespace {

std::string text(const Vec3& v)
{
    char out[100];
    std::snprintf(out, sizeof out, "[%.17g, %.17g, %.17g]", v.x(), v.y(), v.z());
    return out;
}

struct Waypoint {
    double time;
    Vec3 xyz, rpy = Vec3::Zero();
};

using Waypoints = std::vector<Waypoint>;

std::string moving_part(const std::string& shape, const Waypoints& path)
{
    std::string out = "- {name: thing, " + shape + ", path: [";
    for (const Waypoint& pose : path)
        out += "{time: " + std::to_string(pose.time) + ", xyz: " + text(pose.xyz) + ", rpy: " + text(pose.rpy) + "}, ";
    return out + "]}\n";
}

Mat3 rotation_of(const Waypoint& pose) { return rotation_of_rpy(pose.rpy.x(), pose.rpy.y(), pose.rpy.z()); }

/// Returns the pose of a thing at a time by the definition: straight ways, and turns by spherical interpolation.
Pose pose_of(const Waypoints& path, double time)
{
    if (time <= path.front().time) return {path.front().xyz, rotation_of(path.front())};
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        const Waypoint &a = path[k], &b = path[k + 1];
        if (time > b.time) continue;
        const double share = (time - a.time) / (b.time - a.time);
        const Eigen::Quaterniond turn =
            Eigen::Quaterniond(rotation_of(a)).slerp(share, Eigen::Quaterniond(rotation_of(b)));
        return {(1 - share) * a.xyz + share * b.xyz, turn.toRotationMatrix()};
    }
    return {path.back().xyz, rotation_of(path.back())};
}

/// A folder with a mesh of an L, which is not convex, and an open one.
struct Meshes : TempFolder {
    Meshes()
    {
        const hand::Mesh ell = hand::extruded(
            {{-0.5, -0.5}, {0.5, -0.5}, {0.5, -0.1}, {-0.1, -0.1}, {-0.1, 0.5}, {-0.5, 0.5}}, -0.5, 0.5);
        write("ell.obj", mesh_text::obj(ell));
        write("sheet.obj", "v -0.5 -0.5 0\nv 0.5 -0.5 0\nv 0 0.6 0.2\nf 1 2 3\n");
    }
};

const std::vector<std::string> shapes{"box: [0.8, 0.5, 0.3]",
                                      "sphere: 0.4",
                                      "cylinder: {radius: 0.3, length: 0.7}",
                                      "capsule: {radius: 0.25, length: 0.6}",
                                      "mesh: ell.obj",
                                      "mesh: sheet.obj"};

Waypoints random_path(Random& random, bool turns)
{
    Waypoints out;
    const auto angles = [&]() -> Vec3 {
        const double roll = random.between(-1.2, 1.2), pitch = random.between(-1.2, 1.2);
        return {roll, pitch, random.between(-1.2, 1.2)};
    };
    Vec3 rpy = angles();
    for (int k = 0; k < 3; ++k) {
        const double x = random.between(-2, 2), y = random.between(-2, 2), z = random.between(-1, 1);
        out.push_back({double(2 * k), {x, y, z}, rpy});
        if (turns) rpy = angles();
    }
    return out;
}

Robot cube(double side) { return make_robot("cube", {shape_part(box_shape({side, side, side}))}); }

std::vector<Pose> near_path(Random& random, const Waypoints& path, int count)
{
    std::vector<Pose> out;
    for (int k = 0; k < count; ++k) {
        const Vec3 centre = pose_of(path, random.between(-1, 5)).position;
        const double x = random.between(-0.9, 0.9), y = random.between(-0.9, 0.9), z = random.between(-0.9, 0.9);
        out.push_back({centre + Vec3(x, y, z), rotation_of_rpy(0, 0, random.between(-3, 3))});
    }
    return out;
}

}  // namespace

TEST_CASE("a box that moves along its axis is a longer box, and a ball a capsule")
{
    const TempFolder folder;
    const Scene box = load_parts(folder, moving_part("box: [1, 2, 0.5]", {{0, {0, 0, 1}}, {4, {3, 0, 1}}}));
    const Geometry swept(box), longer(load_parts(folder, "- {name: a, box: [4, 2, 0.5], xyz: [1.5, 0, 1]}\n"));
    CHECK(box.parts.size() == 1);
    CHECK(box.parts[0].kind == "box");
    CHECK(box.has_moving_parts);
    for (double x = -0.99; x < 4; x += 0.07)
        for (double y = -1.49; y < 1.5; y += 0.11) {
            const auto here = column_at(swept, x, y).spans, there = column_at(longer, x, y).spans;
            REQUIRE(here.size() == there.size());
            if (here.empty()) continue;
            CHECK(here[0].bottom == Approx(there[0].bottom).margin(1e-12));
            CHECK(here[0].top == Approx(there[0].top).margin(1e-12));
        }
    const Scene ball = load_parts(folder, moving_part("sphere: 0.5", {{0, {0, 0, 1}}, {1, {0, 0, 4}}}));
    REQUIRE(ball.primitives.size() == 1);
    const Shape& capsule = ball.primitives[0].shape;
    CHECK(capsule.kind == ShapeKind::Capsule);
    CHECK(capsule.size.head<2>() == Eigen::Vector2d(0.5, 3));
    CHECK(capsule.pose.position == Vec3(0, 0, 2.5));
}

TEST_CASE("a box that moves across is the hull that a scene file gives")
{
    const TempFolder folder;
    // A square of side 2 that moves by (2, 2) sweeps a hexagon.
    const Geometry swept(load_parts(folder, moving_part("box: [2, 2, 1]", {{0, {0, 0, 0}}, {1, {2, 2, 0}}})));
    const std::vector<std::array<int, 2>> outline{{-1, -1}, {1, -1}, {3, 1}, {3, 3}, {1, 3}, {-1, 1}};
    std::vector<Vec3> vertices;
    std::vector<Triangle> faces;
    for (const double z : {-0.5, 0.5})
        for (const auto& [x, y] : outline) vertices.push_back({double(x), double(y), z});
    for (std::uint32_t k = 0; k < 6; ++k) {
        const std::uint32_t next = (k + 1) % 6;
        faces.push_back({k, next, next + 6});
        faces.push_back({k, next + 6, k + 6});
        if (k < 1 || k > 4) continue;
        faces.push_back({0, k + 1, k});
        faces.push_back({6, k + 6, k + 7});
    }
    Scene hull;
    add_mesh(hull, "hull", Label::Obstacle, vertices, faces);
    REQUIRE(hull.pieces[0].solid);
    const Geometry expected(hull);
    const CollisionChecker here(swept, cube(0.3)), there(expected, cube(0.3));
    Random random{1};
    int hits = 0;
    for (int k = 0; k < 2000; ++k) {
        const double x = random.between(-2, 4), y = random.between(-2, 4), z = random.between(-0.8, 0.8);
        const Pose pose{{x, y, z}, rotation_of_rpy(0, 0, random.between(0, 3))};
        CHECK(here.is_free(pose) == there.is_free(pose));
        hits += !there.is_free(pose);
    }
    CHECK(hits > 400);
    CHECK(hits < 1600);
}

TEST_CASE("the swept space contains all places of a thing, and hardly more")
{
    const Meshes folder;
    constexpr int instants = 160;
    constexpr double side = 0.1;
    int hits = 0, misses = 0;
    for (std::size_t s = 0; s < shapes.size(); ++s)
        for (const bool turns : {false, true}) {
            CAPTURE(shapes[s], turns);
            Random random{s + (turns ? 100 : 0)};
            const Waypoints path = random_path(random, turns);
            const std::vector<Pose> poses = near_path(random, path, 150);
            const Geometry swept(load_parts(folder, moving_part(shapes[s], path)));
            const CollisionChecker checker(swept, cube(side));
            // The thing stands still at the origin, and the robot moves around it instead.
            const Geometry still(load_parts(folder, "- {name: thing, " + shapes[s] + "}\n"));
            // Room for most_growth at the corners of hulls and of the robot, for the prisms around round bodies, and
            // for the way between two instants.
            const double room = (turns ? 0.01 : 0) + 0.002 + (turns ? 0.07 : 0.05);
            const CollisionChecker at_place(still, cube(side)), near_place(still, cube(side + 2 * room));
            for (const Pose& pose : poses) {
                bool touches = false, is_near = false;
                for (int k = 0; k <= instants && !touches; ++k) {
                    const Pose thing = pose_of(path, 4.0 * k / instants);
                    const Pose relative{thing.rotation.transpose() * (pose.position - thing.position),
                                        thing.rotation.transpose() * pose.rotation};
                    touches = !at_place.is_free(relative);
                    is_near = is_near || !near_place.is_free(relative);
                }
                const bool is_free = checker.is_free(pose);
                if (touches) CHECK_FALSE(is_free);
                if (!is_free) CHECK(is_near);
                ++(is_free ? misses : hits);
            }
        }
    CHECK(hits > 300);
    CHECK(misses > 300);
}

TEST_CASE("a window of time counts only the places in it")
{
    const Meshes folder;
    for (const std::string& shape : shapes) {
        CAPTURE(shape);
        Random random{7};
        const Waypoints path = random_path(random, false);
        const auto checker = [&](double from, double to, double side = 0.2) {
            return CollisionChecker(
                Geometry(load_parts(folder, moving_part(shape, path), {.time = {.from = from, .to = to}})), cube(side));
        };
        const CollisionChecker whole = checker(0.7, 3.1), first = checker(0.7, 1.2), rest = checker(1.2, 3.1),
                               before = checker(-5, -1), at_start = checker(0, 0), after = checker(9, 12),
                               at_end = checker(4, 4), instant = checker(1.2, 1.2);
        int different = 0;
        for (const Pose& pose : near_path(random, path, 200)) {
            CHECK(whole.is_free(pose) == (first.is_free(pose) && rest.is_free(pose)));
            CHECK(before.is_free(pose) == at_start.is_free(pose));
            CHECK(after.is_free(pose) == at_end.is_free(pose));
            if (!instant.is_free(pose)) CHECK_FALSE((first.is_free(pose) || rest.is_free(pose)));
            different += first.is_free(pose) != rest.is_free(pose);
        }
        CHECK(different > 5);
    }
}

TEST_CASE("a wrong path is refused with its place")
{
    const Meshes folder;
    const auto message = [&](const std::string& part) {
        try {
            load_parts(folder, part);
            return std::string("accepted");
        } catch (const FileError& error) {
            return std::string(error.what()).substr(std::string(error.what()).find("part "));
        }
    };
    const std::string path = ", path: [{time: 0}, {time: 2, xyz: [1, 0, 0]}]";
    CHECK(message("- {name: a, box: [1, 1, 1]" + path + "}\n") == "accepted");
    CHECK(message("- {name: a, plane: [1, 1]" + path + "}\n") ==
          "part \"a\": path is given for a plane; only box, sphere, cylinder, capsule and mesh can move (line 4)");
    CHECK(message("- {name: a, label: terrain, box: [1, 1, 1]" + path + "}\n") ==
          "part \"a\": label is terrain, but a part that moves is always an obstacle (line 4)");
    CHECK_THAT(message("- {name: a, box: [1, 1, 1], xyz: [0, 0, 1]" + path + "}\n"), Contains("xyz"));
    CHECK(message("- {name: a, box: [1, 1, 1], path: [{time: 0}]}\n") ==
          "part \"a\": path needs at least 2 poses: [{time: 0, xyz: [0, 0, 0]}, …] (line 4)");
    CHECK(message("- {name: a, box: [1, 1, 1], path: [{time: 3}, {time: 3, xyz: [1, 0, 0]}]}\n") ==
          "part \"a\": path: pose 2: time is 3 s, needs to be later than the pose before (3 s) (line 4)");
    CHECK(message("- {name: a, box: [1, 1, 1], path: [{time: 0}, {time: 3, rpy_deg: [0, 0, 180]}]}\n") ==
          "part \"a\": path: pose 2: is turned by half a turn, so the direction of the turn is not clear; add a pose "
          "between (line 4)");
    CHECK_THAT(message("- {name: a, box: [1, 1, 1], path: [{xyz: [1, 0, 0]}, {time: 1}]}\n"),
               Contains("path: pose 1: time is missing"));
}

TEST_CASE("--time selects the places of moving parts")
{
    const TempFolder folder;
    const std::string head = "format: spawnfield-scene/1\nname: hall\nparts:\n";
    folder.write("hall.yaml", head + "- {name: floor, label: terrain, box: [20, 20, 1], xyz: [0, 0, -0.5]}\n");
    folder.write("truck.yaml",
                 head + moving_part("box: [1, 1, 1]", {{0, {-5, 0, 0.6}}, {5, {0, 0, 0.6}}, {10, {5, 0, 0.6}}}));
    folder.write("still.yaml", head + "- {name: swept, box: [3, 1, 1], xyz: [-4, 0, 0.6]}\n");
    folder.write("poses.csv", "x,y,z\n-5,0,0.1\n-3,0,0.1\n0,0,0.1\n5,0,0.1\n0,3,0.1\n");
    REQUIRE(run_program(folder, "bake hall.yaml -o map --resolution 0.5").status == 0);
    const auto verdicts = [&](const std::string& options) {
        const ProgramRun run = run_program(folder, "check map --robot box:0.2,0.2,0.2 --poses poses.csv " + options);
        if (run.status != 0) return run.err;
        std::string out;
        for (std::size_t at = 0; (at = run.out.find(",0.1,", at)) != std::string::npos; at += 5)
            if (const char first = run.out[at + 5]; first == 'v' || first == 'c') out += first;
        return out;
    };
    CHECK(verdicts("") == "vvvvv");
    CHECK(verdicts("--with truck.yaml") == "ccccv");
    CHECK(verdicts("--with truck.yaml --time 0:2") == "ccvvv");
    CHECK(verdicts("--with truck.yaml --time 5:") == "vvccv");
    CHECK(verdicts("--with truck.yaml --time :0") == "cvvvv");
    const auto raster = [&](const std::string& options) {
        return run_program(folder, "raster map --robot box:0.2,0.2,0.2 --dims 2 --step 0.25 --yaw 0.3 " + options).out;
    };
    CHECK(raster("--with truck.yaml --time 0:2") == raster("--with still.yaml"));
    CHECK_THAT(run_program(folder, "check map --robot box:0.2,0.2,0.2 --poses poses.csv --with truck.yaml").err,
               Contains("notice: truck.yaml: part \"thing\" moves; all places on its path count"));
    CHECK_THAT(verdicts("--time 0:2"), Contains("--time is \"0:2\", but no part of --with has a path"));
    CHECK_THAT(verdicts("--with truck.yaml --time 2"), Contains("--time is \"2\", needs LOW:HIGH in s"));
    CHECK_THAT(verdicts("--with truck.yaml --time 2:1"), Contains("--time is \"2:1\"; give the earlier time first"));
}
